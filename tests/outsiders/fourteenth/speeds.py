"""Speeds, by road and by kind of vehicle."""

from __future__ import annotations

from collections.abc import Iterator

from tests.outsiders.fourteenth.drive import Drive
from tests.outsiders.fourteenth.places import MID, OVER, motorway, street
from tests.outsiders.fourteenth.scenes import alone


def speeds_a() -> Iterator[Drive]:
    at = (1000.0, 50.0, 1.2)
    de = motorway("de", at=at)
    town = street("de", kind="town", speed="50 km/h", at=at)
    rural = street("de", at=at)
    g3 = "stvo.rg3"
    yield alone(
        "de-town-55",
        "55 km/h in town for 3 s",
        town,
        ((0, 13), (8, 13), (10, 15.3), (13, 15.3), (15, 13.5)),
        [(g3, "fail", "15.3 m/s, 13.9 + 0.83")],
        u=1.75,
    )
    yield alone(
        "de-town-52",
        "52 km/h in town",
        town,
        ((0, 14.45),),
        [(g3, "pass", "14.45 m/s within the tolerance")],
        u=1.75,
        hz=20.0,
    )
    yield alone(
        "de-lorry-90",
        "lorry at 88 km/h on a motorway of 130",
        de,
        ((0, 24.5),),
        [(g3, "fail", "24.5, lorries 22.2")],
        kind="truck",
        env=OVER,
    )
    yield alone(
        "de-tow-84",
        "car with a trailer at 84 km/h on a motorway",
        de,
        ((0, 23.4),),
        [(g3, "not pass", "23.4 over 22.2 + 0.83, or up to 100 km/h by exemption")],
        env={"vehicle_class": "car_towing"},
    )
    yield alone(
        "de-bus-rural-95",
        "bus at 92 km/h on a rural road of 100",
        rural,
        ((0, 25.6),),
        [(g3, "fail", "25.6, buses 22.2")],
        u=1.75,
        kind="bus",
        env={"vehicle_class": "bus"},
    )


def speeds_b() -> Iterator[Drive]:
    at = (1000.0, 50.0, 1.2)
    gb = motorway("gb", at=at)
    rural = street("de", at=at)
    gbr = street("gb", at=at)
    g3 = "stvo.rg3"
    r124 = "ukhc.r124.speed-limit"
    yield alone(
        "de-lorry-rural-70",
        "lorry over 7.5 t at 70 km/h on a rural road",
        rural,
        ((0, 19.4),),
        [(g3, "fail", "19.4, 16.7 allowed")],
        u=1.75,
        kind="truck",
        env=OVER,
    )
    yield alone(
        "de-lorry-rural-59",
        "lorry over 7.5 t at 59 km/h on a rural road",
        rural,
        ((0, 16.4),),
        [(g3, "pass", "16.4")],
        u=1.75,
        kind="truck",
        env=OVER,
    )
    yield alone("gb-72", "72.5 mph on a motorway", gb, ((0, 32.4),), [(r124, "fail", "32.4, 31.3 allowed")], u=MID)
    yield alone("gb-69", "69 mph on a motorway", gb, ((0, 30.85),), [(r124, "pass", "30.85")], u=MID)
    yield alone(
        "gb-lorry-63",
        "lorry over 7.5 t at 62 mph on a motorway",
        gb,
        ((0, 27.75),),
        [(r124, "fail", "27.75, 60 mph is 26.8")],
        kind="truck",
        env=OVER,
    )
    yield alone(
        "gb-tow-rural-55",
        "car with a trailer at 54 mph on a single carriageway",
        gbr,
        ((0, 24.2),),
        [(r124, "fail", "24.2, 50 mph is 22.35")],
        u=1.75,
        env={"vehicle_class": "car_towing"},
    )
    yield alone(
        "gb-lorry-sct-47",
        "lorry over 7.5 t at 47 mph on a single carriageway of Scotland",
        street("gb-sct", at=at),
        ((0, 21.0),),
        [(r124, "fail", "21.0, 40 mph is 17.9 in Scotland")],
        u=1.75,
        kind="truck",
        env=OVER,
    )


def speeds_c() -> Iterator[Drive]:
    at = (1000.0, 50.0, 1.2)
    de = motorway("de", at=at)
    r124 = "ukhc.r124.speed-limit"
    town_gb = street("gb", kind="town", speed="30 mph", at=at)
    yield alone(
        "gb-lorry-eng-47",
        "the same in England",
        street("gb-eng", at=at),
        ((0, 21.0),),
        [(r124, "pass", "50 mph in England")],
        u=1.75,
        kind="truck",
        env=OVER,
    )
    yield alone(
        "gb-town-reverse-fast",
        "drives, stops, reverses at 33.5 mph in a street of 30 for 3 s",
        town_gb,
        ((0, 11), (20, 11), (24, 0), (25, 0), (30, -15.0), (33, -15.0), (38, 0)),
        [
            (r124, "fail", "15 m/s backwards is 15 m/s"),
            ("ukhc.r143.direction", "fail", "backwards faster than 10 mph"),
            ("comfort.lateral", "not fail", "straight back"),
            ("comfort.accel-iso15622", "not fail", "at most 3 m/s2"),
        ],
        u=1.75,
        s0=400.0,
        turned=0.0,
        seconds=40.0,
    )
    yield alone(
        "de-slow-18",
        "18 m/s alone on a motorway of 130",
        de,
        ((0, 18.0),),
        [("stvo.rg4", "fail", "18 m/s below by 18, 15 allowed")],
        seconds=24.0,
    )
    yield alone(
        "de-slow-lorry-18",
        "lorry of 18 m/s on the motorway: 4 below its limit",
        de,
        ((0, 18.0),),
        [("stvo.rg4", "pass", "80 km/h at most")],
        kind="truck",
        env=OVER,
    )


def speeds() -> Iterator[Drive]:
    """Return the drives of this chapter."""
    yield from speeds_a()
    yield from speeds_b()
    yield from speeds_c()
