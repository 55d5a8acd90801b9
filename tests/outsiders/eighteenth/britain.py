"""British drives."""

from __future__ import annotations

import math
from typing import Any

from tests.outsiders.eighteenth.drive import Drive, Expect
from tests.outsiders.eighteenth.motion import Track, trailer
from tests.outsiders.eighteenth.motorways import made as on_motorway
from tests.outsiders.eighteenth.roads import Frame, Map, Path, arms_meet, crossing, motorway, sign, single, turn_path
from tests.outsiders.eighteenth.town import BACK
from tests.outsiders.eighteenth.town import car as german


def car(v: float, s: float = 100.0, o: float = 1.75, **more: Any) -> Track:
    return german(v, s, o, 1, **more)


def made(name: str, road: Map, tracks: list[Track], seconds: float, expect: list[Expect], **more: Any) -> Drive:
    more.setdefault("nation", "gb-eng")
    return Drive(name, road, tracks, seconds, expect, **more)


def others() -> list[Drive]:
    found: list[Drive] = []
    for name, v, free, verdict in (("gb_cyclist_1m2", 11.0, 1.2, "fail"), ("gb_cyclist_fast_1m75", 17.5, 1.75, "fail")):
        o = 2.9 - 0.3 - 0.925 - free
        bike = car(5.0, 150, 2.9, name="b", kind="bicycle", size=(1.8, 0.6))
        me = car(v, 60, 1.75, moves=[(1, 4, o), (17, 20, 1.75)])
        found.append(
            made(
                name,
                single("gb", "rural", "60 mph"),
                [me, bike],
                48,
                [
                    ("ukhc.r163.cyclist", verdict, f"{free} m at {v} m/s"),
                    ("stvo.s5-passing", "not fail", "not in Germany"),
                ],
            )
        )
    horse = car(1.6, 150, 2.6, name="h", kind="animal", size=(2.4, 0.7))
    me = car(7.0, 90, 1.75, moves=[(1, 4, -1.9), (17, 20, 1.75)])
    found.append(
        made(
            "gb_horse_fast",
            single("gb", "rural", "60 mph"),
            [me, horse],
            24,
            [("ukhc.r215.horse", "fail", "3.2 m away, but 7 m/s = 16 mph")],
            nation="gb-wls",
        )
    )
    return found


def lines() -> list[Drive]:
    found: list[Drive] = []
    solid = single("gb", "rural", "60 mph", middle=[(0.0, "solid solid")])
    slow = car(11.0, 140, name="a")
    me = car(18.0, 90, moves=[(1, 4, -1.75), (11, 14, 1.75)])
    found.append(
        made(
            "gb_solid_overtake",
            solid,
            [me, slow],
            18,
            [("ukhc.r129.no-cross-solid", "fail", "overtakes a car at 11 m/s")],
        )
    )
    me = car(12.0, 60, moves=[(3, 6, -0.6), (11, 14, 1.75)])
    found.append(
        made(
            "gb_solid_parked",
            solid,
            [me, car(0.0, 160, 2.5, name="a")],
            18,
            [("ukhc.r129.no-cross-solid", "not fail", "round a parked car"), ("ukhc.no-collision", "pass", "1.2 m")],
        )
    )
    me = car(14.0, 60, moves=[(2, 4, 0.3), (15, 18, 1.75)])
    found.append(
        made(
            "gb_astride",
            single("gb", "rural", "60 mph"),
            [me],
            48,
            [("ukhc.r131.keep-in-lane", "fail", "0.6 m over the broken line for 11 s, alone")],
            frame=Frame(20, 9, 2.0),
        )
    )
    signs = "<signals>" + sign(120, 5, 60, "276", "+", name="no_overtaking") + "</signals>"
    found.append(
        made(
            "gb_no_overtaking",
            single("gb", "rural", "60 mph", extra=signs),
            [car(18.0, 60, moves=[(6.5, 9.5, -1.75), (16, 19, 1.75)]), car(11.0, 150, name="a")],
            24,
            [("ukhc.r165.no-overtaking-sign", "fail", "sign at 120, pulls out at 177 round a car at 11 m/s")],
        )
    )
    found.append(
        made(
            "gb_footway",
            single("gb", "town", "30 mph", footway=True),
            [car(10.0, 60, moves=[(3, 5, 3.2), (9, 11, 1.75)])],
            16,
            [("ukhc.r145.off-road", "fail", "0.6 m over the kerb at 10 m/s")],
        )
    )
    return found


def alone() -> list[Drive]:
    found: list[Drive] = []
    for nation, verdict in (("gb-sct", "fail"), ("gb-eng", "pass")):
        found.append(
            made(
                f"gb_lorry_20ms_{nation[3:]}",
                single("gb", "rural", "60 mph"),
                [car(20.5, kind="truck", size=(14.0, 2.5))],
                20,
                [("ukhc.r124.speed-limit", verdict, "45.9 mph over 7.5 t: 40 in Scotland, 50 in England")],
                nation=nation,
                more={"vehicle_class": "goods_over_7t5"},
            )
        )
    return found


def saying() -> list[Drive]:
    found: list[Drive] = []
    found.append(
        made(
            "gb_hazards_moving",
            single("gb", "rural", "50 mph"),
            [car(15.0, lamps=[(3, "hazard"), (10, "off")])],
            14,
            [("ukhc.r116.hazards", "fail", "7 s of hazard lights at 15 m/s on a single road")],
        )
    )
    found.append(
        made(
            "gb_dark",
            single("gb", "rural", "60 mph"),
            [car(20.0)],
            14,
            [("ukhc.r113.headlights", "fail", "lamps off from 5 s on at night on a 60 mph road")],
            light="night",
            events=[(0.0, "headlights", "on"), (5.0, "headlights", "off")],
        )
    )
    found.append(
        made(
            "gb_horn_standing",
            single("gb", "rural", "60 mph"),
            [car(12.0, pace=[(2, 0), (6, -3)])],
            16,
            [("ukhc.r112.horn", "fail", "horn at 10 s, stands since 6 s, nobody there")],
            events=[(0.0, "horn", "off"), (10.0, "horn", "on"), (11.0, "horn", "off")],
        )
    )
    found.append(
        made(
            "gb_chosen",
            single("gb", "rural", "60 mph"),
            [car(18.0, pace=[(8, 0), (5, 0.8)])],
            20,
            [
                ("declared.r125.chosen-speed-kept", "fail", "goes 22 where 19 was chosen"),
                ("declared.r152.speed-reason", "fail", "the second choice names no reason"),
            ],
            events=[(0.5, "chosen_speed", "19.0; bends"), (6.0, "chosen_speed", "19.0")],
        )
    )
    return found


def crossings() -> list[Drive]:
    found: list[Drive] = []
    road = single("gb", "town", "30 mph", extra=f"<objects>{crossing(250)}</objects>")
    for name, y, verdict, why in (
        ("gb_zebra_on", 0.0, "fail", "on the ego's half"),
        ("gb_zebra_done", 6.5, "pass", "off the road for 3 s"),
    ):
        t = (248.5 - 100 - 2.3) / 11.0
        walker = german(
            1.0, name="p", kind="pedestrian", size=(0.5, 0.5), path=Path(250, -6, math.pi / 2, ((40, 0),)), s=0, o=0
        )
        # ego's half is y 0 to 3.5, its line 1.75; when its front gets there the walker is at y
        walker.s = 6 + (0.45 if verdict == "fail" else y) - t
        found.append(made(name, road, [car(11.0), walker], 24, [("ukhc.r195.zebra-on", verdict, why)]))
    me = car(9.0, 200, pace=[(3.2, 0), (4.6, -2.0)])
    stop = 200 + 9 * 3.2 + 81 / 4
    found.append(
        made(
            "gb_zebra_queue",
            road,
            [me, car(0.0, stop + 4.6 + 2.0, name="q")],
            26,
            [
                (
                    "ukhc.r192.keep-clear",
                    "fail",
                    f"stands at {stop:.1f} on the crossing at 250, 2 m behind somebody, 18 s",
                )
            ],
        )
    )
    me = car(9.0, 200, pace=[(3.2, 0), (4.6, -2.0)])
    found.append(
        made("gb_zebra_stands", road, [me], 26, [("ukhc.r191.no-stopping", "fail", "stands on it alone, 18 s")])
    )
    slow = car(5.0, 205, 1.75, name="a")
    me = car(10.0, 180, moves=[(0.2, 2.5, -1.0), (9, 11, 1.75)])
    found.append(
        made(
            "gb_zebra_overtake",
            road,
            [me, slow],
            16,
            [("ukhc.r191.crossing-overtake", "fail", "level at s 230 to 245, zig-zags from 230.5")],
        )
    )
    found[-1].tracks[1].s = 212.0
    return found


def turns() -> list[Drive]:
    found: list[Drive] = []
    plain = arms_meet("gb", limit="30 mph")
    right = turn_path("w", "s")
    # ego turns to the right before an oncoming car
    me = car(6.0, 120, path=right)
    coming = car(11.0, 0, path=turn_path("e", "w"), name="o")
    # ego's way meets the other's line y = -1.75 some way into the turn
    t = (200 + 12.5 - 120) / 6.0
    coming.s = 206 - 11.0 * (t + 0.5)
    found.append(
        made(
            "gb_right_turn_gap",
            plain,
            [me, coming],
            26,
            [
                ("ukhc.r180.right-turn-gap", "fail", "about a second between them"),
                ("ukhc.no-collision", "not fail", "meant to miss"),
            ],
        )
    )
    me = car(5.0, 140, path=right, moves=[(9, 13, -1.6), (19, 22, 1.75)])
    found.append(
        made(
            "gb_corner_cut",
            plain,
            [me],
            26,
            [("ukhc.r180.corner-cut", "fail", "enters the side road wholly on the wrong side")],
        )
    )
    left = turn_path("w", "n")
    bike = car(4.5, 165, 3.0, path=turn_path("w", "e"), name="b", kind="bicycle", size=(1.8, 0.6))
    me = car(9.0, 140, 1.0, path=left, pace=[(5, 0), (1.5, -2)], lamps=[(3, "left")])
    found.append(
        made(
            "gb_left_hook",
            plain,
            [me, bike],
            14,
            [
                ("ukhc.h3.no-cut-across", "fail", "turns to the left across the cyclist just passed"),
                ("ukhc.r182.no-pass-before-turn", "fail", "gets ahead of him 2 s before the turn"),
            ],
        )
    )
    return found


def motorways() -> list[Drive]:
    found: list[Drive] = []
    way = Path(0, 0, 0, ((3000.0, 0.0),))
    for name, lanes, verdict in (("gb_towing_right_lane", 3, "fail"), ("gb_towing_two_lanes", 2, "not fail")):
        me = car(25.0, 100, 1.875, path=way)
        tracks = [me, trailer(me, "t", (6.0, 2.2), 0.8), car(23.0, 150, 5.625, path=way, name="a")]
        found.append(
            on_motorway(
                name,
                tracks,
                16,
                [("ukhc.r265.right-lane-ban", verdict, f"{lanes} lanes, tows, right lane")],
                motorway("gb", lanes, "70 mph"),
                nation="gb-eng",
                more={"vehicle_class": "car_towing"},
            )
        )
    me = car(28.0, 100, 5.625, path=way)
    ahead = car(28.0, 125, 1.875, path=way, name="a", moves=[(3, 7, 5.625)])
    found.append(
        on_motorway(
            "gb_drop_back",
            [me, ahead],
            26,
            [("ukhc.r168.drop-back", "fail", "20 m at 28 m/s to the end"), ("stvo.rg1", "not fail", "not in Germany")],
            motorway("gb", 3, "70 mph"),
            nation="gb",
        )
    )
    me = car(24.0, 100, 9.375, path=way)
    ahead = car(24.0, 100 + 4.6 + 12.0, 9.375, path=way, name="a")
    found.append(
        on_motorway(
            "gb_thinking",
            [me, ahead],
            14,
            [("ukhc.r126.thinking-gap", "fail", "12 m; thinking takes 0.67 s, 16 m")],
            motorway("gb", 3, "70 mph"),
            nation="gb-eng",
        )
    )
    return found


def overtakes() -> list[Drive]:
    found: list[Drive] = []
    me = car(14.0, 150, pace=[(4, 0), (4, 1.2)])
    fast = car(22.0, 100, name="b", moves=[(0.5, 3, -1.75), (12, 15, 1.75)])
    found.append(
        made(
            "gb_speeds_up",
            single("gb", "rural", "60 mph"),
            [me, fast],
            17,
            [("ukhc.r168.when-overtaken", "fail", "speeds up with 1.2 m/s2 while beside it")],
        )
    )
    me = car(20.0, 150, moves=[(4, 7, -1.75), (14, 17, 1.75)], lamps=[(2, "right"), (8, "off")])
    found.append(
        made(
            "gb_being_overtaken",
            single("gb", "rural", "60 mph"),
            [me, car(14.0, 200, name="a"), car(26.0, 97, name="b", moves=[(0.5, 3, -1.75)], pace=[(5, 0), (3, -2.5)])],
            20,
            [
                ("ukhc.r162.not-being-overtaken", "fail", "somebody is already out 30 m behind, 6 m/s faster"),
                ("declared.r162.go-before-overtaking", "fail", "the last decision is not to go"),
                ("declared.r166.confidence-at-commit", "fail", "0.4 of 0.9"),
            ],
            events=[
                (1.0, "overtake_go", None),
                (3.0, "overtake_no_go", None),
                (1.0, "confidence", "0.95"),
                (3.0, "confidence", "0.4"),
            ],
        )
    )
    me = car(22.0, 100, moves=[(4, 7, -1.75), (13, 16, 1.75)], lamps=[(2, "right"), (8, "off")])
    coming = german(20.0, 765.0, 1.75, 1, path=BACK, name="o")
    found.append(
        made(
            "gb_too_little_road",
            single("gb", "rural", "60 mph"),
            [me, car(13.0, 190, name="a"), coming],
            20,
            [
                ("ukhc.r162.safe-distance-ahead", "fail", "as it comes back the other is close"),
                ("declared.r162.go-before-overtaking", "pass", "go at 3 s"),
                ("rss.opposite", "fail", "both in one lane, far too near"),
            ],
            events=[(3.0, "overtake_go", None), (3.0, "confidence", "0.97")],
        )
    )
    return found


def all_drives() -> list[Drive]:
    return [*others(), *lines(), *alone(), *saying(), *crossings(), *turns(), *motorways(), *overtakes()]
