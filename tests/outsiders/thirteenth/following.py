"""Following others, and a road of two lanes to do it on."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from tests.outsiders.log import Size
from tests.outsiders.thirteenth.drive import DE, FAR, GB, TURNED, Drive, Wanted, draw
from tests.outsiders.thirteenth.motion import SIZES, Across, Actor, Lamps, Speeds
from tests.outsiders.thirteenth.street import N, Street, two_way

Other = Callable[[Street], Actor]


def went(name: str, cls: str, s: float, v: Speeds, across: float | Across, **more: Any) -> Other:
    """Somebody who goes along the street."""
    return lambda street: street.go(name, cls, s, v, across, **more)


def came(name: str, cls: str, s: float, v: Speeds, across: float | Across, **more: Any) -> Other:
    """Somebody who comes along the street."""
    return lambda street: street.come(name, cls, s, v, across, **more)


def following(
    name: str,
    v: Speeds,
    wanted: Wanted,
    *,
    gap: float | None = None,
    lead: Speeds = 0,
    lead_cls: str | None = "car",
    seen: Sequence[tuple[float, float]] | None = None,
    cls: str = "car",
    size: Size | None = None,
    u: float | Across = N,
    ind: Lamps = None,
    others: Sequence[Other] = (),
    seconds: float = 14,
    soft: float = 0.4,
    noise: float = 0,
    **more: Any,
) -> Drive:
    """The ego goes along a road; gap: so far behind somebody, from bumper to bumper."""
    road = {key: more.pop(key) for key in ("lht", "frame", "curve", "kind", "limit", "length", "walk") if key in more}
    street = two_way(**road)
    actors = [street.go("ego", cls, 200, v, u, indicator=ind, noise=noise, size=size, soft=soft)]
    if gap is not None:
        middle = 200 + gap + ((size or SIZES[cls])[0] or 0) / 2 + 2.25
        actors.append(street.go("l", lead_cls, middle, lead, N, seen=seen))
    actors += [other(street) for other in others]
    return draw(name, street.map, actors, seconds, wanted, **more)


def cut_in(name: str, v: Speeds, wanted: Wanted, *, seconds: float = 24, **more: Any) -> Drive:
    """A car overtakes the ego and moves in close ahead."""
    street = two_way()
    speeds = [(0, 26), (6.5, 26), (8.5, 20), (99, 20)]
    other = street.go("c", "car", 270, speeds, [(0, N), (0.3, N), (2, -N), (6, -N), (8.5, N)])
    return draw(name, street.map, [street.go("ego", "car", 300, v, N), other], seconds, wanted, **more)


def headways() -> Iterator[Drive]:
    """Headways."""
    yield following(
        "thw_07",
        20,
        [
            ("criticality.thw", "fail", "0.7 s"),
            ("ukhc.r126.thinking-gap", "not fail", "14 m, 13.4 m thinking distance: 0.6 m over"),
        ],
        gap=14,
        lead=20,
        frame=TURNED,
    )
    yield following(
        "thw_trailer",
        18,
        [("criticality.thw", "fail", "13 m to the trailer: 0.72 s")],
        gap=13 + 5.5,
        lead=18,
        others=[went("t", "trailer", 200 + 2.25 + 13 + 2.75, 18, 1.75, size=(5.5, 2.2, 2.4))],
    )
    yield following(
        "thw_lost",
        19,
        [("criticality.thw", "fail", "0.63 s, track lost for two seconds meanwhile")],
        gap=12,
        lead=19,
        seen=[(0, 5), (7, 14)],
        lht=False,
        conditions=DE,
    )
    yield following(
        "thw_noclass",
        19,
        [
            ("criticality.thw", "fail", "0.63 s behind something without a class"),
            ("ukhc.r126.thinking-gap", "fail", "12 m, 12.8 m thinking distance at 19 m/s (42.5 mph)"),
        ],
        gap=12,
        lead=19,
        lead_cls=None,
    )
    yield following(
        "thw_noise",
        20,
        [("criticality.thw", "fail", "0.6 s"), ("ukhc.r126.thinking-gap", "fail", "12 m of 13.4")],
        gap=12,
        lead=20,
        noise=0.05,
        frame=FAR,
    )


def headways_kept() -> Iterator[Drive]:
    """Headways in bends, and kept ones."""
    yield following(
        "thw_bend", 16, [("criticality.thw", "fail", "0.6 s in a bend")], gap=10, lead=16, curve=1 / 150, length=700
    )
    yield following(
        "thw_oncoming_only",
        16,
        [
            ("criticality.thw", "not fail", "nobody ahead in the lane"),
            ("criticality.ttc", "not fail", "oncoming keeps its lane"),
            ("rss.opposite", "not fail", "each in its lane"),
        ],
        curve=1 / 150,
        length=700,
        others=[came("onc", "car", 480, 16, 1.75)],
    )
    yield following(
        "thw_15",
        20,
        [("criticality.thw", "pass", "1.5 s"), ("criticality.ttc", "pass", "equal speed")],
        gap=30,
        lead=20,
    )


def conflicts() -> Iterator[Drive]:
    """Conflicts with somebody ahead or coming."""
    yield following(
        "ttc_close",
        [(0, 22), (5, 22), (7.8, 8), (99, 8)],
        [
            ("criticality.ttc", "fail", "below 1.5 s"),
            ("criticality.drac", "fail", "over 3.4 m/s2 needed"),
            ("criticality.ttb", "fail", "less than one second before full braking"),
        ],
        gap=93,
        lead=8,
        seconds=12,
    )
    yield following(
        "ttc_ped_standing_car",
        [(0, 14), (6.0, 14), (7.8, 0), (99, 0)],
        [("criticality.ttc", "fail", "14 m/s with about 16 m to go"), ("criticality.drac", "fail", "6 m/s2")],
        gap=100,
        lead=0,
        seconds=14,
        frame=FAR,
        hz=20,
    )
    yield following(
        "mttc_accel",
        [(0, 16), (6, 16), (10, 13), (99, 13)],
        [
            ("criticality.mttc", "fail", "lead brakes with 4 m/s2, ego closes"),
            ("ukhc.no-collision", "fail", "runs into it"),
        ],
        gap=18,
        lead=[(0, 16), (5, 16), (7, 8), (9, 8), (12, 13), (99, 13)],
        seconds=15,
    )
    yield following(
        "touch_rear",
        [(0, 12), (6, 12), (8.5, 2), (99, 2)],
        [("ukhc.no-collision", "fail", "drives into the rear"), ("criticality.ttc", "fail", "hits")],
        gap=34,
        lead=[(0, 6), (99, 3)],
        seconds=14,
    )
    yield following(
        "side_scrape",
        14,
        [("ukhc.no-collision", "fail", "oncoming over the line scrapes the ego's side for a metre")],
        gap=30,
        lead=[(0, 14), (99, 14)],
        u=0.95,
        others=[came("onc", "van", 420, 14, [(0, 1.75), (4, 1.75), (7, 0.7), (9, 0.7), (12, 1.75)])],
        hz=5,
    )
    yield following(
        "bump_hidden",
        [(0, 9), (4, 9), (6.4, 3.0), (6.45, 0.2), (6.9, 0), (99, 0)],
        [("ukhc.contact-signature", "fail", "loses 2.8 m/s in 0.05 s, 0.3 m behind a car")],
        others=[
            went("hit", "car", 200 + 50.7 + 4.5, [(0, 0), (6.4, 0), (6.45, 1.5), (7.5, 0), (99, 0)], 1.75, soft=0.01)
        ],
        soft=0.01,
        hz=20,
        seconds=12,
    )


def dropping_back() -> Iterator[Drive]:
    """Dropping back."""
    yield cut_in(
        "r168_stay", 20, [("ukhc.r168.drop-back", "fail", "stays under 1.2 s for 15 s after the other moved in")]
    )
    yield cut_in(
        "r168_drop",
        [(0, 20), (8, 20), (11, 15.5), (16, 15.5), (20, 20), (99, 20)],
        [("ukhc.r168.drop-back", "pass", "drops back to over two seconds within ten")],
        seconds=26,
    )
    yield cut_in(
        "r168_wet",
        [(0, 20), (8, 20), (11, 15.5), (16, 15.5), (20, 20), (99, 20)],
        [("ukhc.r168.drop-back", "fail", "2 to 3 s in the wet, four asked")],
        conditions={**GB, "weather": "wet"},
        seconds=26,
    )
