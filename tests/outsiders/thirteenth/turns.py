"""Turning: the oncoming, corners, people on foot and cyclists."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.thirteenth.crossroads import halt, junction, on, walker
from tests.outsiders.thirteenth.drive import DE, FAR, TURNED, Drive


def across_the_oncoming() -> Iterator[Drive]:
    """Turns across the oncoming traffic."""
    yield junction(
        "right_gap_bad",
        "WS",
        [(0, 8), (4, 8), (6, 5), (99, 5)],
        [("ukhc.r180.right-turn-gap", "fail", "oncoming crosses the turn's ground 0.3 s after the ego")],
        on("onc", "car", "EW", 116, 12),
        back=50,
        seconds=20,
        ind=[(0, "off"), (2, "right"), (12, "off")],
    )
    yield junction(
        "right_gap_forced_brake",
        "WS",
        [(0, 8), (4, 8), (6, 5), (99, 5)],
        [("ukhc.r180.right-turn-gap", "fail", "oncoming brakes with 5 m/s2 for the ego")],
        on("onc", "car", "EW", 104, [(0, 13), (6.6, 13), (8.8, 1.5), (12, 1.5), (15, 8), (99, 8)]),
        back=50,
        seconds=20,
        frame=TURNED,
    )
    yield junction(
        "right_gap_good",
        "WS",
        halt(8, 50, 0.5, 4, 5),
        [
            ("ukhc.r180.right-turn-gap", "not fail", "oncoming is gone"),
            ("ukhc.r180.corner-cut", "pass", "lane centre kept"),
        ],
        on("onc", "car", "EW", 60, 12),
        back=50,
        seconds=24,
    )
    yield junction(
        "right_gap_moto",
        "WS",
        [(0, 8), (4, 8), (6, 5), (99, 5)],
        [("ukhc.r180.right-turn-gap", "fail", "motorcycle 0.3 s after the ego")],
        on("m", "motorcycle", "EW", 124, 13),
        back=50,
        seconds=20,
        hz=20,
    )
    yield junction(
        "left_gap_de_bad",
        "WN",
        [(0, 8), (4, 8), (6, 5), (99, 5)],
        [("ukhc.r180.right-turn-gap", "fail", "left turn in Germany across the oncoming, which comes 0.3 s later")],
        on("onc", "car", "EW", 116, 12),
        lht=False,
        conditions=DE,
        back=50,
        seconds=20,
    )


def corners() -> Iterator[Drive]:
    """Corners cut, and wide ones."""
    yield junction(
        "right_corner_cut",
        "WS",
        [(0, 8), (4, 8), (6, 5), (99, 5)],
        [("ukhc.r180.corner-cut", "fail", "enters the new road 1 m on its wrong side, back in its own 2.5 s later")],
        back=50,
        seconds=20,
        off=[(0, 0), (5, 0), (8, -3.2), (10.4, -3.2), (14, 0)],
    )
    yield junction(
        "right_corner_cut_mild",
        "WS",
        [(0, 8), (4, 8), (6, 5), (99, 5)],
        [("ukhc.r180.corner-cut", "fail", "0.65 m over the middle of the road entered")],
        back=50,
        seconds=20,
        frame=FAR,
        off=[(0, 0), (5, 0), (8, -1.5), (12.5, -1.5), (15, 0)],
    )
    yield junction(
        "left_wide",
        "WN",
        [(0, 8), (4, 8), (6, 4.5), (99, 4.5)],
        [("ukhc.r183.keep-in", "fail", "3.1 m left at the near edge of a lane of 5 m")],
        back=50,
        seconds=20,
        width=5.0,
        off=[(0, 0), (5.5, 0), (8.5, -1.5), (15, -1.5), (19, 0)],
    )
    yield junction(
        "left_tight",
        "WN",
        [(0, 8), (4, 8), (6, 4.5), (99, 4.5)],
        [("ukhc.r183.keep-in", "pass", "0.85 m to the edge")],
        back=50,
        seconds=20,
        frame=FAR,
    )
    yield junction(
        "wrong_side_turn",
        "WS",
        [(0, 8), (15.25, 8), (17.25, 5), (99, 5)],
        [
            ("ukhc.r180.corner-cut", "fail", "ends on the wrong side of the new road"),
            ("ukhc.r143.direction", "fail", "drives some 10 s at 5 m/s against the lane"),
        ],
        back=140,
        seconds=33,
        off=[(0, 0), (16.25, 0), (19.25, -3.4), (60, -3.4)],
    )


def people_on_foot() -> Iterator[Drive]:
    """Somebody walks over the road that is entered or left."""
    yield junction(
        "h2_left_bad",
        "WN",
        [(0, 8), (4, 8), (6, 4.5), (99, 4.5)],
        [
            (
                "ukhc.h2.turn-pedestrian",
                "fail",
                "on foot crossing the side road, reaches the ego's way less than 2 s after it",
            )
        ],
        walker(5.0, 17, -5.5, 17, 9.7),
        back=50,
        seconds=20,
    )
    yield junction(
        "h2_right_bad",
        "WS",
        [(0, 8), (4, 8), (6, 5), (99, 5)],
        [("ukhc.h2.turn-pedestrian", "fail", "walker comes into the ego's half a second after the ego")],
        walker(-5.5, -18, 6, -18, 9.95),
        back=50,
        seconds=20,
    )
    yield junction(
        "h2_wait",
        "WN",
        halt(8, 50, -3, 5, 4.5),
        [
            ("ukhc.h2.turn-pedestrian", "not fail", "waits until the walker has crossed"),
            ("ukhc.no-collision", "pass", "apart"),
        ],
        walker(-6, 17, 6, 17, 4.0),
        back=50,
        seconds=26,
    )
    yield junction(
        "h2_other_side",
        "WN",
        [(0, 8), (4, 8), (6, 4.5), (99, 4.5)],
        [("ukhc.h2.turn-pedestrian", "not fail", "walks along the footway, never in the road")],
        walker(-7, 14, -7, 40, 0),
        back=50,
        seconds=20,
    )
    yield junction(
        "x_h2_out_of",
        "NW",
        [(0, 8), (4, 8), (6, 5), (99, 5)],
        [
            (
                "ukhc.h2.turn-pedestrian",
                "fail",
                "walker is crossing the road that the ego comes out of, about a second behind it",
            )
        ],
        walker(-5.5, 16, 6, 16, 3.8),
        back=50,
        seconds=20,
    )


def cyclists() -> Iterator[Drive]:
    """Cyclists cut across."""
    yield junction(
        "h3_left_hook",
        "WN",
        [(0, 9), (5, 9), (6.5, 5), (99, 5)],
        [
            ("ukhc.h3.no-cut-across", "fail", "cyclist going ahead on the inside is cut across"),
            ("ukhc.no-collision", "fail", "hit"),
            ("ukhc.r182.no-pass-before-turn", "fail", "got past the cyclist within 5 s of the turn"),
        ],
        on("b", "bicycle", "WE", 46, 6, off=1.45),
        off=((0, -0.6),),
        back=55,
        seconds=20,
    )
    yield junction(
        "h3_left_hook_brake",
        "WN",
        [(0, 9), (5, 9), (6.5, 5), (99, 5)],
        [("ukhc.h3.no-cut-across", "fail", "cyclist brakes with 2.9 m/s2")],
        on("b", "bicycle", "WE", 46, [(0, 6), (6.3, 6), (8.0, 0.8), (11, 0.8), (14, 5), (99, 5)], off=1.45),
        off=((0, -0.6),),
        back=55,
        seconds=20,
        frame=TURNED,
    )
    yield junction(
        "h3_right_oncoming_bike",
        "WS",
        [(0, 8), (4, 8), (6, 5), (99, 5)],
        [("ukhc.h3.no-cut-across", "fail", "oncoming cyclist reaches the ground half a second after the ego")],
        on("b", "bicycle", "EW", 64, 7, off=0.9),
        back=50,
        seconds=20,
    )
    yield junction(
        "h3_behind_ok",
        "WN",
        [(0, 9), (5, 9), (6.5, 5), (99, 5)],
        [
            ("ukhc.h3.no-cut-across", "not fail", "cyclist is 60 m back"),
            ("ukhc.r182.no-pass-before-turn", "not fail", "never passed it"),
        ],
        on("b", "bicycle", "WE", 110, 5, off=1.1),
        back=55,
        seconds=20,
    )
    yield junction(
        "h3_wait_behind",
        "WN",
        [(0, 8), (4, 5), (9, 5), (11, 4), (99, 4)],
        [
            ("ukhc.h3.no-cut-across", "not fail", "stays 20 m behind the cyclist"),
            ("ukhc.r182.no-pass-before-turn", "not fail", "stays behind"),
        ],
        on("b", "bicycle", "WE", 25, 6, off=1.1),
        back=50,
        seconds=24,
    )


def passed_before_a_turn() -> Iterator[Drive]:
    """Somebody got past just before a turn."""
    yield junction(
        "h3_right_hook_de",
        "WS",
        [(0, 9), (5, 9), (6.5, 5), (99, 5)],
        [
            ("ukhc.r182.no-pass-before-turn", "fail", "the same to the right in Germany"),
            ("ukhc.h3.no-cut-across", "fail", "same"),
        ],
        on("b", "bicycle", "WE", 46, 6, off=1.45),
        off=((0, -0.6),),
        lht=False,
        conditions=DE,
        back=55,
        seconds=20,
    )
    yield junction(
        "r182_moto",
        "WN",
        [(0, 12), (3.6, 12), (6, 5), (99, 5)],
        [("ukhc.r182.no-pass-before-turn", "fail", "got past a moving motorcycle on the near side just before")],
        on("m", "motorcycle", "WN", 40, [(0, 6), (5, 6), (8, 4), (99, 4)], off=1.2),
        off=((0, -0.6),),
        back=55,
        seconds=20,
    )
    yield junction(
        "x_r182_standing",
        "WN",
        [(0, 9), (4, 9), (6.2, 5), (99, 5)],
        [
            ("ukhc.r182.no-pass-before-turn", "not fail", "the cyclist stood"),
            ("ukhc.h3.no-cut-across", "not fail", "the cyclist stood"),
        ],
        on("b", "bicycle", "WE", 25, 0, off=1.45),
        off=((0, -0.6),),
        back=55,
        seconds=20,
    )
