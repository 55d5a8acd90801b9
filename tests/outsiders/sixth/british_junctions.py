"""Great Britain: crossroads."""

from __future__ import annotations

from tests.outsiders.sixth.crossroads import cross, lit, through, with_stop_sign
from tests.outsiders.sixth.drive import Chapter, Drive
from tests.outsiders.sixth.maps import OWN


def british_junctions() -> list[Drive]:
    chapter = Chapter()

    d = chapter.draw(
        "gb_red_two_heads_h", "The ego drives past two light heads that are both red.", "fail r175.red", lit("gb"), 25
    )
    d.map["1"].signal("tl1b", 2.0, -1, "1000001", out=-3.0)
    d.add("ego", through("s", "n"), s=90, v=12, u=OWN).light("tl1", (0, "amber"), (3, "red")).light(
        "tl1b", (0, "amber"), (3, "red")
    )

    d = chapter.draw(
        "gb_green_clear_h",
        "The ego drives across on green; five steps a second.",
        "pass r175.red r176.green-exit-clear r124.speed-limit",
        lit("gb"),
        25,
        hz=5,
    )
    d.add("ego", through("s", "n"), s=90, v=11.5, u=OWN).light("tl1", (0, "red"), (2, "red_amber"), (4, "green"))

    d = chapter.draw(
        "gb_green_blocked_h",
        "The ego drives into a junction on green and stands in it behind a queue.",
        "fail r176.green-exit-clear | pass no-collision",
        lit("gb"),
        35,
    )
    d.add("ego", through("s", "n"), s=120, v=[(0, 9), (6, 9), (11, 3), (13.2, 0), (26, 0), (35, 8)], u=OWN).light(
        "tl1", (0, "green"), (16, "amber"), (19, "red")
    )
    for i in range(3):
        d.add(f"q{i}", through("s", "n"), s=216.5 + 7 * i, v=[(0, 0), (24, 0), (35, 9)], u=OWN)

    d = chapter.draw(
        "gb_right_turn_forced_h",
        "The ego turns right before an oncoming car, which brakes and is touched.",
        "fail r180.right-turn-gap",
        cross("gb"),
        22,
    )
    d.add("ego", through("s", "e"), s=120, v=[(0, 9), (5, 7), (22, 7)], u=OWN, ind=[(3, "right"), (18, "off")])
    d.add("onc", through("n", "s"), s=196 - 13 * 10.4, v=[(0, 13), (10.4, 13), (12.4, 3.5), (22, 3.5)], u=OWN, soft=0.2)

    d = chapter.draw(
        "gb_right_corner_cut_h", "The ego cuts the corner of a right turn.", "fail r180.corner-cut", cross("gb"), 25
    )
    d.add(
        "ego",
        through("s", "e"),
        s=120,
        v=[(0, 9), (6, 6), (25, 6)],
        u=[(10, OWN), (12.5, -1.6), (17, -1.6), (20, OWN)],
        ind=[(3, "right"), (18, "off")],
    )

    d = chapter.draw(
        "gb_left_wide_h",
        "The ego turns left wide, with 2.5 m to the near edge.",
        "fail r183.keep-in | not fail r180.corner-cut",
        cross("gb", width=4.6),
        25,
    )
    d.add(
        "ego",
        through("s", "w"),
        s=120,
        v=[(0, 9), (6, 6), (25, 6)],
        u=[(8, 2.3), (11, 1.15), (25, 1.15)],
        ind=[(3, "left"), (18, "off")],
    )

    d = chapter.draw(
        "gb_left_hook_h",
        "The ego passes a cyclist and turns left across their way.",
        "fail r182.no-pass-before-turn h3.no-cut-across r163.cyclist",
        cross("gb"),
        20,
        noise=0.02,
    )
    d.add(
        "ego",
        through("s", "w"),
        s=100,
        v=[(0, 12), (5, 12), (8, 6.5), (20, 6.5)],
        u=1.55,
        ind=[(6, "left"), (16, "off")],
    )
    d.add("bike", through("s", "n"), s=142.6, v=5.2, u=3.05, cls="bicycle")

    d = chapter.draw(
        "gb_left_behind_bike_h",
        "The ego stays behind a cyclist and turns left.",
        "pass r182.no-pass-before-turn h3.no-cut-across",
        cross("gb"),
        30,
    )
    d.add(
        "ego", through("s", "w"), s=100, v=[(0, 10), (4, 10), (8, 4.5), (30, 5)], u=OWN, ind=[(6, "left"), (22, "off")]
    )
    d.add("bike", through("s", "n"), s=150, v=5.5, u=2.9, cls="bicycle")

    d = chapter.draw(
        "gb_left_walker_h",
        "The ego turns left just before somebody on foot.",
        "fail h2.turn-pedestrian",
        cross("gb", walk=True),
        20,
    )
    d.add("ego", through("s", "w"), s=140, v=[(0, 9), (6, 9), (7.5, 6), (20, 6)], u=OWN, ind=[(3, "left"), (14, "off")])
    d.walk("w", [(0, -15, 5), (7.3, -15, 5), (15, -15, 5 - 1.4 * 7.7)])

    d = chapter.draw(
        "gb_stop_rolled_h", "The ego rolls past a stop sign at 7 mph.", "fail r171.stop-sign", with_stop_sign("gb"), 25
    )
    d.add(
        "ego",
        through("s", "w"),
        s=120,
        v=[(0, 10), (4, 10), (8, 3), (10, 3), (14, 7), (25, 8)],
        u=OWN,
        ind=[(3, "left"), (15, "off")],
    )

    d = chapter.draw(
        "gb_stop_far_before_h",
        "The ego stops 13 m before a stop line and rolls over it.",
        "not pass r171.stop-sign",
        with_stop_sign("gb"),
        30,
    )
    d.add(
        "ego",
        through("s", "w"),
        s=197.85 - 2.25 - 13 - 56,
        v=[(0, 10), (3, 10), (8.2, 0), (11, 0), (14, 4), (17, 5), (30, 7)],
        u=OWN,
        ind=[(3, "left"), (22, "off")],
    )

    d = chapter.draw(
        "gb_blocks_side_road_h",
        "The ego stands across a side road behind a queue.",
        "fail r151.side-roads-clear",
        cross("gb", "sew", walk=True),
        40,
    )
    d.add("ego", through("w", "e"), s=130, v=[(0, 8), (6, 8), (12, 2), (14, 0), (30, 0), (40, 6)], u=OWN)
    d.add("q", through("w", "e"), s=220.5, v=[(0, 0), (28, 0), (40, 8)], u=OWN).add(
        "q2", through("w", "e"), s=228, v=[(0, 0), (27, 0), (40, 8)], u=OWN
    )
    d.add("side", through("s", "w"), s=190, v=0, u=OWN)

    d = chapter.draw(
        "gb_close_crossing_h",
        "Another car crosses 0.7 s behind the ego.",
        "fail criticality.pet | pass no-collision",
        cross("gb"),
        20,
        hz=20,
    )
    d.add("ego", through("w", "e"), s=100, v=12, u=OWN).add("x", through("s", "n"), s=119.2, v=9, u=OWN)
    return chapter.drives
