"""Germany: automated driving by UN R157 and R79."""

from __future__ import annotations

from tests.outsiders.sixth.drive import Chapter, Drive
from tests.outsiders.sixth.maps import autobahn, beside


def german_systems() -> list[Drive]:
    chapter = Chapter()

    d = chapter.draw(
        "de_alks_follow_close_h",
        "The system follows a car at 44 km/h, 8 m behind it.",
        "fail alks-r157.follow-gap criticality.thw",
        autobahn(),
        30,
        engaged="yes",
    )
    d.add("ego", s=60, v=12.2, u=beside(4)).add("lead", s=60 + 4.5 + 8.5, v=12.2, u=beside(4))

    d = chapter.draw(
        "de_alks_follow_good_h",
        "The system follows a car at 44 km/h, 23 m behind it.",
        "pass alks-r157.follow-gap | not fail alks-r157.emergency alks-r157.mrm",
        autobahn(),
        30,
        engaged="yes",
    )
    d.add("ego", s=60, v=12.2, u=beside(4)).add("lead", s=60 + 4.5 + 23, v=12.2, u=beside(4))

    d = chapter.draw(
        "de_alks_cut_in_crash_h",
        "A slow car moves in with time to spare; the system does not brake and hits it.",
        "fail no-collision alks-r157.cut-in criticality.ttc | not pass r168.drop-back",
        autobahn(),
        25,
        engaged="yes",
    )
    d.add("ego", s=60, v=16, u=beside(4)).add(
        "cut", s=60 + 4.5 + 9 + 5 * 6.5 + 8, v=9.5, u=[(3, beside(3)), (8.5, beside(4))], ind=[(2, "right"), (8, "off")]
    )

    d = chapter.draw(
        "de_alks_cut_in_handled_h",
        "A slow car moves in with time to spare and the system brakes.",
        "pass alks-r157.cut-in no-collision",
        autobahn(),
        30,
        engaged="yes",
    )
    d.add("ego", s=60, v=[(0, 16), (5, 16), (9, 8.5), (14, 8.5), (20, 9), (30, 9)], u=beside(4))
    d.add("cut", s=60 + 4.5 + 9 + 5 * 6.5 + 8, v=[(0, 9.5), (30, 10.5)], u=[(3, beside(3)), (8.5, beside(4))])

    d = chapter.draw(
        "de_alks_cut_in_gap_left_h",
        "A car moves in 6 m ahead and the system stays there.",
        "fail alks-r157.cut-in-gap alks-r157.follow-gap",
        autobahn(),
        32,
        engaged="yes",
    )
    d.add("ego", s=60, v=13, u=beside(4)).add("cut", s=60 + 4.5 + 6, v=13, u=[(4, beside(3)), (7, beside(4))])

    d = chapter.draw(
        "de_alks_emergency_silent_h",
        "The system brakes fully for a man and does not declare it.",
        "fail alks-r157.emergency | pass no-collision",
        autobahn(),
        15,
        engaged="yes",
    )
    d.add("ego", s=60, v=[(0, 16), (5, 16), (7, 1), (8, 0), (15, 0)], u=beside(4), soft=0.2).walk(
        "p", [(0, 172, -22), (3, 172, -22), (8, 172, -8), (11, 172, 0)]
    )
    d.says(0, "emergency_manoeuvre", "off")

    d = chapter.draw(
        "de_alks_emergency_told_h",
        "The system brakes fully for a man and declares it.",
        "pass alks-r157.emergency | not fail stvo.rg2",
        autobahn(),
        15,
        engaged="yes",
    )
    d.add("ego", s=60, v=[(0, 16), (5, 16), (7, 1), (8, 0), (15, 0)], u=beside(4), soft=0.2).walk(
        "p", [(0, 172, -22), (3, 172, -22), (8, 172, -8), (11, 172, 0)]
    )
    d.says(0, "emergency_manoeuvre", "off").says(4.6, "emergency_manoeuvre", "on").says(9, "emergency_manoeuvre", "off")

    d = chapter.draw(
        "de_alks_mrm_harsh_h",
        "A minimal risk manoeuvre brakes hard, and its hazard lights come late.",
        "fail alks-r157.mrm alks-r157.mrm-hazards",
        autobahn(),
        30,
        engaged="yes",
    )
    d.add("ego", s=60, v=[(0, 24), (8, 24), (12, 1), (13, 0), (30, 0)], u=beside(4), ind=[(7.9, "off"), (16, "hazard")])
    d.says(0, "minimal_risk_manoeuvre", "off").says(8, "minimal_risk_manoeuvre", "on")

    d = chapter.draw(
        "de_alks_mrm_gentle_h",
        "A minimal risk manoeuvre brakes gently, with hazard lights at once.",
        "pass alks-r157.mrm alks-r157.mrm-hazards | not fail stvo.ri1",
        autobahn(),
        30,
        engaged="yes",
    )
    d.add("ego", s=60, v=[(0, 24), (8, 24), (17, 0), (30, 0)], u=beside(4), ind=[(8.1, "hazard")])
    d.says(0, "minimal_risk_manoeuvre", "off").says(8, "minimal_risk_manoeuvre", "on")

    d = chapter.draw(
        "de_r79_short_signal_h",
        "The system changes lane less than two seconds after its signal.",
        "fail alks-r157.r79.lane-change | pass alks-r157.r79.lane-change-done",
        autobahn(),
        20,
        engaged="yes",
    )
    d.add("ego", s=60, v=27, u=[(8, beside(4)), (13, beside(3))], ind=[(8, "left"), (13, "off")])

    d = chapter.draw(
        "de_r79_slow_change_h",
        "The system takes seven seconds to cross the line.",
        "fail alks-r157.r79.lane-change-done | pass alks-r157.r79.lane-change",
        autobahn(),
        35,
        engaged="yes",
    )
    d.add("ego", s=60, v=27, u=[(6, beside(4)), (27, beside(3))], ind=[(9, "left"), (27, "off")])
    return chapter.drives
