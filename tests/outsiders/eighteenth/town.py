"""Drives on other German roads: speeds, cyclists, signs, lights, the opposing lane."""

from __future__ import annotations

from typing import Any

from tests.outsiders.eighteenth.drive import Drive
from tests.outsiders.eighteenth.motion import Track, trailer
from tests.outsiders.eighteenth.roads import Frame, Path, arms_meet, single, turn_path

CAR = (4.6, 1.85)
LINE = Path(0, 0, 0, ((1500.0, 0.0),))
BACK = Path(1500, 0, 3.141592653589793, ((1500.0, 0.0),))


def car(
    v: float,
    s: float = 100.0,
    o: float = 1.75,
    g: int = -1,
    *,
    name: str = "ego",
    kind: str | None = "car",
    size: tuple[float, float] = CAR,
    path: Path = LINE,
    **more: Any,
) -> Track:
    return Track(name, kind, size, path, s, v, o, g, **more)


def speeds() -> list[Drive]:
    town = single("de", "town", "50 km/h")
    found = [
        Drive(
            "rg3_town_15",
            town,
            [car(15.1)],
            20,
            [("stvo.rg3", "fail", "54.4 km/h of 50, 3 taken off")],
            frame=Frame(-3000, 10, 3.0),
        ),
        Drive(
            "rg3_slower_zone",
            single("de", "rural", speeds=[(0.0, "70 km/h"), (400.0, "50 km/h")]),
            [car(17.5, pace=[(20, 0), (4, -1)])],
            30,
            [("stvo.rg3", "fail", "17.5 m/s for 50 m and more inside 50 km/h")],
        ),
        Drive(
            "rg3_heavy_rural",
            single("de", "rural", "100 km/h"),
            [car(19.0, kind="truck", size=(16.5, 2.5))],
            20,
            [("stvo.rg3", "fail", "68 km/h, 60 for over 7.5 t")],
            more={"vehicle_class": "goods_over_7t5"},
        ),
    ]
    me = car(27.0, kind="van", size=(5.8, 2.0))
    found.append(
        Drive(
            "rg3_trailer_unsaid",
            single("de", "rural", "100 km/h"),
            [me, trailer(me, "t", (6.5, 2.2), 0.9)],
            20,
            [("stvo.rg3", "not pass", "97 km/h with a trailer on a rural road: 80")],
        )
    )
    me = car(24.5)
    found.append(
        Drive(
            "rg3_towing_rural",
            single("de", "rural", "100 km/h"),
            [me, trailer(me, "t", (5.0, 2.0), 0.9)],
            20,
            [("stvo.rg3", "fail", "88 km/h towing on a rural road: 80")],
            more={"vehicle_class": "car_towing"},
        )
    )
    return found


def cyclists() -> list[Drive]:
    found: list[Drive] = []
    for name, free, kind, limit, verdict, area in (
        ("s5_town_1m75", 1.75, "town", "50 km/h", "pass", "built_up"),
        ("s5_rural_1m75", 1.75, "rural", "100 km/h", "fail", "open"),
    ):
        line = 2.9  # the cyclist's; half widths 0.3 and 0.925
        o = line - 0.3 - 0.925 - free
        bike = car(5.0, 150, line, name="b", kind="bicycle", size=(1.8, 0.6))
        me = car(
            12.0,
            80,
            1.75,
            moves=[(2, 5, o), (14, 17, 1.75)],
            lamps=[(0.5, "left"), (5, "off"), (13, "right"), (17, "off")],
        )
        found.append(
            Drive(
                name,
                single("de", kind, limit),
                [me, bike],
                44,
                [
                    ("stvo.s5-passing", verdict, f"{free} m between the boxes, {area}"),
                    ("ukhc.r163.cyclist", "not fail", "not in Britain"),
                ],
                more={"area": area},
            )
        )
    # Two abreast: the second comes into the log late
    one = car(5.0, 150, 3.1, name="b1", kind="bicycle", size=(1.8, 0.6))
    two = car(5.0, 151, 2.1, name="b2", kind="bicycle", size=(1.8, 0.6), known=(6.0, 99))
    me = car(12.0, 80, 1.75, moves=[(2, 5, -0.1), (14, 17, 1.75)])
    found.append(
        Drive(
            "s5_second_cyclist",
            single("de", "town", "50 km/h"),
            [me, one, two],
            44,
            [("stvo.s5-passing", "fail", "0.98 m to the second, who is there from 6 s on; level at 10 s")],
            more={"area": "built_up"},
        )
    )
    return found


def signs() -> list[Drive]:
    found: list[Drive] = []
    stop = arms_meet("de", "wens", {"s": "stop", "n": "stop"})
    way = turn_path("s", "n")
    for name, stands, before, low, expect in (
        (
            "stop_rolls",
            0.0,
            0.3,
            1.5,
            [("stvo.rin1", "fail", "never slower than 1.5"), ("ukhc.r171.stop-sign", "fail", "rolls")],
        ),
        (
            "stop_short",
            0.4,
            0.25,
            0.0,
            [("stvo.rin1", "fail", "stands 0.4 s"), ("ukhc.r171.stop-sign", "pass", "stands")],
        ),
        (
            "stop_good",
            3.0,
            0.25,
            0.0,
            [
                ("stvo.rin1", "pass", "3 s"),
                ("ukhc.r171.stop-sign", "pass", "3 s"),
                ("performance.precise-stop", "pass", "0.25 m before"),
            ],
        ),
        (
            "stop_over",
            3.0,
            -1.2,
            0.0,
            [
                ("ukhc.r171.stop-sign", "fail", "stands 1.2 m over the line"),
                ("stvo.rin1", "fail", "never stood before it"),
                ("performance.precise-stop", "fail", "over it"),
            ],
        ),
    ):
        v = 10.0
        slow = (v * v - low * low) / (2 * 2.0)
        # the stop line's centre is at 199; its near edge 0.15 before that
        front = 199.0 - 0.15 - before
        s = front - 2.3 - slow - v * 3.0
        me = car(v, s, path=way, pace=[(3, 0), ((v - low) / 2.0, -2.0), (stands + (0.5 if low else 0), 0), (5, 1.6)])
        found.append(Drive(name, stop, [me], 3 + 5 + stands + 9, expect, frame=Frame(10, 20, 0.9)))
    return found


def lights() -> list[Drive]:
    found: list[Drive] = []
    lights = arms_meet("de", "wens", dict.fromkeys("wens", "light"))
    way = turn_path("w", "e")
    me = car(12.0, 199 - 2.3 - 12.0 * 9.3, path=way)
    states = [("73", 0.0, "red"), ("73", 8.6, "red_amber"), ("73", 10.6, "green"), ("74", 0.0, "green")]
    found.append(
        Drive("red_amber", lights, [me], 15, [("ukhc.r175.red", "fail", "over the line at 9.3 s")], signals=states)
    )
    queue = car(0.0, 200 + 28 + 1.0 + 2.3, path=way, name="q", pace=[(22, 0), (8, 1.2)])
    me = car(8.0, 141, path=way, pace=[(8.6, 0), (4, -2.6), (11.4, 0), (8, 1.2)])
    found.append(
        Drive(
            "green_no_exit",
            lights,
            [me, queue],
            36,
            [
                ("ukhc.r176.green-exit-clear", "fail", "stands inside the junction behind a queue, 15 s"),
                ("ukhc.r175.red", "pass", "green"),
            ],
            signals=[("73", 0.0, "green")],
        )
    )
    return found


def crossing_ways() -> list[Drive]:
    found: list[Drive] = []
    way = turn_path("w", "e")
    plain = arms_meet("de")
    across = car(11.0, 0, path=turn_path("s", "n"), name="a")
    me = car(11.0, 60, path=way)
    # meeting point of both ways: ego at s 214 + 1.75, other at 214 - 1.75
    t_me = (214 + 1.75 - 60) / 11.0
    across.s = 214 - 1.75 - 11.0 * (t_me + 1.3)
    found.append(
        Drive(
            "pet_near",
            plain,
            [me, across],
            24,
            [
                ("criticality.pet", "fail", "1.3 s between the centres, some 0.7 s between the boxes"),
                ("ukhc.no-collision", "pass", "apart"),
            ],
        )
    )
    return found


def opposing() -> list[Drive]:
    found: list[Drive] = []
    slow = car(16.0, 150, name="t", kind="truck", size=(12.0, 2.5))
    me = car(
        25.0, 80, moves=[(1, 4, -1.75), (10.5, 13.5, 1.75)], lamps=[(0, "left"), (4, "off"), (10, "right"), (14, "off")]
    )
    coming = car(22.0, 1500 - 710.0, path=BACK, name="o")
    found.append(
        Drive(
            "opposite_near",
            single("de", "rural", "100 km/h"),
            [me, slow, coming],
            20,
            [
                ("rss.opposite", "fail", "ego is out until 13 s"),
                ("ukhc.no-collision", "not fail", "back before they meet"),
                ("ukhc.overtake-zone", "fail", "hardly anything left"),
            ],
        )
    )
    return found


def all_drives() -> list[Drive]:
    return [*speeds(), *cyclists(), *signs(), *lights(), *crossing_ways(), *opposing()]
