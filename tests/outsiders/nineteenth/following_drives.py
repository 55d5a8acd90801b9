"""Behind others, in bends too."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from tests.outsiders.nineteenth.cast import OWN
from tests.outsiders.nineteenth.drive import SIZES, Actor, Drive, Knots, Wanted, draw, gaining
from tests.outsiders.nineteenth.maps import (
    KMH_100,
    LONG,
    MPH_60,
    country,
    two_lanes,
)
from tests.outsiders.nineteenth.path import Path, bend, line
from tests.outsiders.nineteenth.road import Map

WIDE_BEND = bend(150, 120, 1.5, 400)


def cut_in(  # noqa: PLR0917
    name: str,
    nation: str,
    gap: float,
    gains: Sequence[tuple[float, float]],
    wanted: Sequence[Wanted],
    weather: str = "dry",
) -> Drive:
    """Somebody who has overtaken moves in ahead of the ego."""
    return draw(
        name,
        nation,
        country(),
        [
            Actor("ego", "car", LONG, 300, gaining(22.0, gains), OWN),
            Actor("f", "car", LONG, 300.0 + 4.5 + gap, 22.0, [(3, 1.75), (6, OWN)]),
        ],
        26,
        wanted,
        cond={"weather": weather},
    )


def following(  # noqa: PLR0917
    name: str,
    nation: str,
    path: Path,
    gap: float,
    speed: Knots,
    wanted: Sequence[Wanted],
    *,
    lead: str = "car",
    lead_speed: float | None = None,
    lead_across: float = 0.0,
    extra: Sequence[Callable[[Path], Actor]] = (),
    seconds: float = 18,
    noise: float = 0.0,
    hz: float = 10,
) -> Drive:
    """The ego behind somebody, at first with such a gap."""
    lane = path.offset(OWN)
    ahead = 30 + 2.25 + gap + SIZES[lead][0] / 2
    return draw(
        name,
        nation,
        Map([two_lanes(path, "broken", "rural", MPH_60 if nation != "de" else KMH_100)]),
        [
            Actor("ego", "car", lane, 30, speed, 0, noise=noise),
            Actor("l", lead, lane, ahead, lead_speed or speed, lead_across, noise=noise),
            *(make(lane) for make in extra),
        ],
        seconds,
        wanted,
        hz=hz,
    )


def cut_in_on() -> Iterator[Drive]:
    """Somebody moves in ahead."""
    yield cut_in(
        "cutin_drops",
        "gb-eng",
        20,
        [(0, 0), (6, 0), (7, -0.9), (12, -0.9), (13, 0)],
        [
            ("ukhc.r168.drop-back", "pass", "at 44 m and more well before 10 s are over"),
            ("ukhc.no-collision", "pass", "far"),
        ],
    )
    yield cut_in(
        "cutin_wet",
        "gb-eng",
        20,
        [(0, 0), (5, 0), (6, -1.0), (10, -1.0), (11, 0)],
        [("ukhc.r168.drop-back", "fail", "wet asks for four seconds, it makes about 3")],
        weather="wet",
    )
    yield cut_in(
        "cutin_almost",
        "gb-eng",
        20,
        [(0, 0), (5, 0), (6, -0.4), (9, -0.4), (10, 0)],
        [("ukhc.r168.drop-back", "fail", "only about 1.5 s when ten seconds are over")],
    )


def close_behind() -> Iterator[Drive]:
    """Headways."""
    yield following(
        "fol_bend_close",
        "gb-eng",
        WIDE_BEND,
        8.0,
        18.0,
        [("ukhc.r126.thinking-gap", "fail", "8 m at 18 m/s, thinking 12 m"), ("criticality.thw", "fail", "0.44 s")],
    )
    yield following(
        "fol_trailer",
        "gb-eng",
        line(900),
        25.0,
        20.0,
        [
            ("ukhc.r126.thinking-gap", "fail", "the trailer is 6 m ahead"),
            ("criticality.thw", "fail", "0.3 s to the trailer"),
        ],
        extra=[lambda p: Actor("tr", "trailer", p, 30 + 2.25 + 25 - 1 - 9, 20.0, 0, size=(18.0, 2.5, 3.5))],
    )
    yield following(
        "fol_moto_edge",
        "gb-eng",
        line(900),
        9.0,
        20.0,
        [
            ("ukhc.r126.thinking-gap", "fail", "a motorcycle near the lane's edge is in the lane"),
            ("criticality.thw", "fail", "0.45 s"),
        ],
        lead="motorcycle",
        noise=0.01,
        lead_across=-1.25,
    )
    yield following(
        "fol_thw_08",
        "de",
        line(900),
        0.82 * 20,
        20.0,
        [("criticality.thw", "fail", "0.82 s"), ("ukhc.r126.thinking-gap", "pass", "16.4 m, thinking 13.4")],
        hz=20,
    )


def closing_in() -> Iterator[Drive]:
    """Times to collision."""
    yield following(
        "fol_lead_slow",
        "gb-eng",
        line(900),
        90.0,
        [(0, 22), (6.2, 22), (8.2, 10), (20, 10)],
        [
            ("criticality.ttc", "fail", "15.6 m with 12 m/s more: 1.3 s"),
            ("criticality.drac", "fail", "144/31 = 4.6"),
            ("criticality.ttb", "fail", "full braking would be needed already"),
        ],
        lead_speed=10.0,
        seconds=17,
    )
    yield draw(
        "fol_mttc",
        "de",
        country(limit=KMH_100),
        [
            Actor("ego", "car", LONG, 60, gaining(20, [(0, 0), (5.5, 0), (5.9, -6.5), (7.6, -6.5), (8, 0)]), OWN),
            Actor(
                "l",
                "car",
                LONG,
                60 + 4.5 + 19.5,
                gaining(20, [(0, 0), (4, 0), (4.3, -5.5), (6.0, -5.5), (6.3, 0)]),
                OWN,
            ),
        ],
        12,
        [("criticality.mttc", "fail", "14 m, 7.7 m/s and 5.5 m/s2 more at 5.6 s: 1.3 s")],
        hz=20,
    )


def odd_ones_ahead() -> Iterator[Drive]:
    """A lost track; oncoming traffic in a bend."""
    yield draw(
        "fol_late_ghost",
        "gb-eng",
        country(),
        [
            Actor("ego", "car", LONG, 60, 20, OWN),
            Actor("l", None, LONG, 60 + 4.5 + 7, 20, OWN, size=(4.2, 1.8, 1.5), seen=lambda q: q < 4 or q > 9),
        ],
        16,
        [
            ("ukhc.r126.thinking-gap", "fail", "7 m at 20 m/s, though the track is lost for 5 s and has no class"),
            ("criticality.thw", "fail", "0.35 s"),
        ],
    )
    yield draw(
        "fol_parallel_bend",
        "gb-eng",
        Map([two_lanes(WIDE_BEND, "broken", "rural", MPH_60)]),
        [
            Actor("ego", "car", WIDE_BEND.offset(OWN), 120, 15, 0),
            Actor("o", "car", WIDE_BEND.offset(1.75).reverse(), 250, 15, 0),
            Actor("o2", "truck", WIDE_BEND.offset(1.75).reverse(), 200, 15, 0),
        ],
        20,
        [
            ("ukhc.r126.thinking-gap", "not fail", "those ahead in the bend are in the other lane, coming towards it"),
            ("criticality.ttc", "not fail", "oncoming in the other lane"),
            ("ukhc.r143.direction", "pass", "in its lane"),
            ("ukhc.no-collision", "pass", "over a metre"),
        ],
    )
