"""Great Britain: lines, and the side of the road."""

from __future__ import annotations

from tests.outsiders.ninth.cast import FASTER, INDICATED, out_and_back
from tests.outsiders.ninth.drive import Drive, draw
from tests.outsiders.ninth.maps import MOTORWAY_M, country, dual_carriageway, lane, own
from tests.outsiders.ninth.movement import ego, oncoming, who


def british_lines() -> list[Drive]:
    """Return its drives."""
    return [
        draw(
            "gb_overtake_double_white_k",
            "The ego overtakes a car at 29 mph over a double white line.",
            "fail r129.no-cross-solid",
            country(middle=[(0, "solid solid")]),
            [ego(own, 60, FASTER, out_and_back(), indicator=INDICATED), who("slow", "car", own, 100, 13)],
            22,
            rate=20,
        ),
        draw(
            "gb_overtake_into_solid_k",
            "The ego overtakes far into a stretch where the line has become solid on its side.",
            "fail r128.back-before-solid r129.no-cross-solid",
            country(middle=[(0, "broken"), (230, "broken solid")]),
            [ego(own, 60, FASTER, out_and_back(), indicator=INDICATED), who("slow", "car", own, 100, 13)],
            22,
        ),
        draw(
            "gb_overtake_back_in_time_k",
            "The ego overtakes over a line broken on its side and is back before that becomes solid.",
            "pass r128.back-before-solid | not fail r129.no-cross-solid",
            country(middle=[(0, "solid broken"), (480, "solid solid")]),
            [ego(own, 60, FASTER, out_and_back(), indicator=INDICATED), who("slow", "car", own, 100, 13)],
            22,
        ),
        draw(
            "gb_solid_line_slow_cyclist_k",
            "The ego crosses a double white line to pass a cyclist at 7.6 mph.",
            "pass r129.no-cross-solid r163.cyclist",
            country(middle=[(0, "solid solid")]),
            [
                ego(own, 60, [(3, 11), (6, 8)], [(6, 0), (9, 1.8), (15, 1.8), (18, 0)], indicator=INDICATED),
                who("cyc", "bicycle", own, 125, 3.4, -1.2),
            ],
            24,
        ),
        draw(
            "gb_solid_line_quick_cyclist_k",
            "The ego crosses a double white line to pass a cyclist at 18 mph.",
            "fail r129.no-cross-solid | pass r163.cyclist",
            country(middle=[(0, "solid solid")]),
            [
                ego(own, 60, [(3, 15), (6, 15)], [(4, 0), (7, 2.6), (13, 2.6), (16, 0)], indicator=INDICATED),
                who("cyc", "bicycle", own, 125, 8, -1.2),
            ],
            24,
        ),
        draw(
            "gb_solid_on_my_side_k",
            "The ego overtakes over a line that is solid on its side.",
            "fail r129.no-cross-solid",
            country(middle=[(0, "broken solid")]),
            [ego(own, 60, FASTER, out_and_back(), indicator=INDICATED), who("slow", "car", own, 100, 13)],
            22,
            rate=5,
        ),
        draw(
            "gb_broken_on_my_side_k",
            "The ego overtakes over a line that is broken on its side.",
            "not fail r129.no-cross-solid r162.safe-distance-ahead",
            country(middle=[(0, "solid broken")]),
            [ego(own, 60, FASTER, out_and_back(), indicator=INDICATED), who("slow", "car", own, 100, 13)],
            22,
            rate=5,
        ),
        draw(
            "gb_astride_two_lanes_k",
            "The ego rides on the line between two lanes for fourteen seconds.",
            "fail r131.keep-in-lane",
            dual_carriageway(),
            [ego(lane(0, 2, MOTORWAY_M), 60, 24, [(3, 0), (5, 1.8), (19, 1.8), (21, 0)])],
            44,
        ),
        draw(
            "gb_forgot_which_side_k",
            "The ego drifts into the oncoming lane and stays there; an oncoming car swerves out of its way.",
            "fail r143.direction rss.opposite",
            country(),
            [
                ego(own, 40, 15, [(16, 0), (19, 3.6)]),
                oncoming("onc", "car", 650, 40, 14, [(36, 0), (39, 3.4), (42, 3.4)]),
            ],
            44,
        ),
    ]
