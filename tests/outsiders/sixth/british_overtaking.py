"""Great Britain: overtaking, and the lines of country roads."""

from __future__ import annotations

from tests.outsiders.sixth.cast import overtaker
from tests.outsiders.sixth.drive import Chapter, Drive
from tests.outsiders.sixth.maps import OPP, OWN, country_road


def british_overtaking() -> list[Drive]:
    chapter = Chapter()

    d = chapter.draw(
        "gb_ov_ample_h",
        "The ego overtakes with ample room.",
        "pass r163.pull-out-separation r129.no-cross-solid r143.direction | not fail r162.safe-distance-ahead",
        country_road(),
        25,
    )
    overtaker(d, 20, 23, 4, 15)
    d.add("slow", s=20 + 4.5 + 72 + 4 * 9, v=14, u=OWN)

    d = chapter.draw(
        "gb_ov_squeeze_h",
        "The ego is back in its lane a second before an oncoming car.",
        "fail r162.safe-distance-ahead r126.ds-disjoint rss.opposite | pass no-collision",
        country_road(),
        25,
        hz=20,
    )
    overtaker(d, 20, 23, 3, 9.5)
    d.add("slow", s=20 + 85, v=14, u=OWN).add("onc", s=20 + 23 * 13 + 26 * 13 + 12, v=26, u=OPP, against=True)

    d = chapter.draw(
        "gb_ov_from_bumper_h",
        "The ego tails a van and pulls out from 6 m behind it.",
        "fail r163.pull-out-separation r126.thinking-gap criticality.thw",
        country_road(),
        25,
    )
    d.add("ego", s=30, v=[(0, 17), (8, 17), (11, 23), (25, 23)], u=[(8, OWN), (10.5, OPP), (15, OPP), (18, OWN)])
    d.add("slow", s=30 + 4.5 + 6.5, v=17, u=OWN, cls="van", size=(4.5, 1.9, 2.2))

    d = chapter.draw(
        "gb_ov_while_overtaken_h",
        "The ego pulls out to overtake while a faster car does so already.",
        "fail r162.not-being-overtaken",
        country_road(),
        25,
    )
    overtaker(d, 120, 20, 6, 13)
    d.add("slow", s=120 + 4.5 + 60 + 36, v=14, u=OWN)
    d.add("fast", s=120 - 24 - 6 * 14, v=[(0, 34), (6.8, 34), (9.5, 20), (25, 20)], u=[(2, OWN), (4, OPP)])

    d = chapter.draw(
        "gb_ov_into_no_gap_h",
        "The ego overtakes into a convoy that has no gap.",
        "fail r162.return-gap",
        country_road(),
        25,
    )
    overtaker(d, 20, 22, 5, 13)
    d.add("a", s=20 + 4.5 + 60 + 40, v=14, u=OWN).add("b", s=20 + 4.5 + 60 + 40 + 4.5 + 9, v=14, u=OWN, cls="van").add(
        "c", s=20 + 4.5 + 60 + 40 + 4.5 + 9 + 13, v=14, u=OWN
    )

    d = chapter.draw(
        "gb_ov_forbidden_h",
        "The ego overtakes after a no-overtaking sign.",
        "fail r165.no-overtaking-sign | not fail r163.pull-out-separation",
        country_road(),
        25,
    )
    d.map["1"].signal("no1", 60, 1, "632", "gb", "no_overtaking")
    overtaker(d, 30, 22, 5, 14)
    d.add("slow", s=30 + 4.5 + 65 + 40, v=14, u=OWN)

    d = chapter.draw(
        "gb_ov_solid_moving_h",
        "The ego overtakes a lorry over double solid lines, recorded with noise.",
        "fail r129.no-cross-solid",
        country_road(centre="solid solid"),
        25,
        noise=0.03,
    )
    overtaker(d, 30, 22, 5, 14)
    d.add("slow", s=30 + 4.5 + 65 + 40, v=14, u=OWN, cls="truck")

    d = chapter.draw(
        "gb_solid_round_van_h",
        "The ego crosses double solid lines to pass a standing van.",
        "pass no-collision | not fail r129.no-cross-solid r143.direction",
        country_road(centre="solid solid"),
        22,
    )
    d.add("ego", s=40, v=[(0, 14), (6, 9), (14, 9), (18, 14)], u=[(5, OWN), (8, -0.9), (13, -0.9), (16, OWN)])
    d.add("van", s=155, v=0, u=2.3, cls="van")

    d = chapter.draw(
        "gb_solid_round_fast_cyclist_h",
        "The ego crosses double solid lines to pass a cyclist who does 19 mph.",
        "fail r129.no-cross-solid | pass r163.cyclist",
        country_road(centre="solid solid"),
        20,
    )
    d.add("ego", s=40, v=17, u=[(3, OWN), (6, -1.2), (12, -1.2), (15, OWN)]).add(
        "bike", s=115, v=8.4, u=2.9, cls="bicycle"
    )

    d = chapter.draw(
        "gb_back_after_solid_h",
        "The ego overtakes over a broken line and comes back after it has become solid.",
        "fail r128.back-before-solid r129.no-cross-solid",
        country_road(marks=((330, "solid solid"),), centre="broken solid"),
        25,
    )
    overtaker(d, 20, 23, 4, 15)
    d.add("slow", s=20 + 4.5 + 72 + 36, v=14, u=OWN)

    d = chapter.draw(
        "gb_races_overtaker_h",
        "The ego speeds up while it is overtaken.",
        "fail r168.when-overtaken",
        country_road(),
        25,
    )
    d.add("ego", s=80, v=[(0, 19), (6, 19), (12, 25), (25, 25)], u=OWN)
    d.add("ov", s=40, v=[(0, 21), (4, 25), (14, 29), (25, 29)], u=[(3, OWN), (6, OPP), (17, OPP), (20, OWN)])

    d = chapter.draw(
        "gb_declared_bad_h",
        "The ego overtakes after a decision not to, in doubt and without looking.",
        "fail declared.r162.go-before-overtaking declared.r166.confidence-at-commit declared.r163.checks-before-pull-out",
        country_road(),
        25,
    )
    overtaker(d, 20, 23, 5, 15)
    d.add("slow", s=20 + 4.5 + 72 + 45, v=14, u=OWN)
    d.says(0.2, "mirror_check", "right").says(1, "confidence", "0.55").says(1, "overtake_go").says(
        3.5, "overtake_no_go"
    ).says(0, "blind_spot_check", "left")

    d = chapter.draw(
        "gb_declared_good_h",
        "The ego overtakes after everything that it has to declare.",
        (
            "pass declared.r162.go-before-overtaking declared.r166.confidence-at-commit "
            "declared.r163.checks-before-pull-out declared.r125.chosen-speed-kept declared.r152.speed-reason"
        ),
        country_road(),
        25,
    )
    overtaker(d, 20, 23, 5, 15)
    d.add("slow", s=20 + 4.5 + 72 + 45, v=14, u=OWN)
    d.says(0, "chosen_speed", "24.5; dry open road").says(1, "mirror_check", "right").says(
        2, "confidence", "0.97"
    ).says(3.2, "overtake_go")
    d.says(4, "mirror_check", "right").says(4.7, "blind_spot_check", "right").says(12, "mirror_check", "left").says(
        14.5, "mirror_check", "left"
    ).says(14.8, "blind_spot_check", "left")
    return chapter.drives
