"""Who drives a one-way street the wrong way for the whole clip is told by the map, unless somebody else contradicts it."""

from __future__ import annotations

from functools import cache

import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.formats.opendrive import xodr
from tests.scenes import LANE, Road, drive, judged, limited, linked, moving, plan, times

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])
DIRECTION = "ukhc.r143.direction"


@cache
def street(hand: str, *, two_way: bool = False, stated: bool = True) -> Road:
    """Return a street of two lanes of one direction, or of one each way; `stated`: the map says on which side is driven."""
    side = 1 if hand == "lht" else -1
    numbers = sorted([side, -side] if two_way else [side, 2 * side], reverse=True)
    text = xodr.xodr(
        xodr.road(
            geometry=plan(((600.0, 0.0),)),
            lanes=xodr.section(0, *(linked(n) for n in numbers)),
            length=600.0,
            attributes=f'rule="{hand.upper()}"' if stated else "",
            more=limited(30),
        )
    )
    return Road(load_map(MapSource(f"street-{hand}-{two_way}-{stated}.xodr", text.encode())), ((600.0, 0.0),))


def verdict(
    hand: str, *, seconds: float = 12.0, other: str | None = None, two_way: bool = False, stated: bool = True
) -> str:
    """Return the verdict on an ego against the direction at 10 m/s; `other`: with or against the direction in the lane beside."""
    way = street(hand, two_way=two_way, stated=stated)
    side = 1 if hand == "lht" else -1
    t = times(seconds)
    actors = [moving("ego", way, t, 500 - 10 * t, side * LANE / 2)]
    if other:
        actors.append(moving("other", way, t, 100 + 9 * t if other == "with" else 560 - 9 * t, side * LANE * 1.5))
    rows = judged([drive(actors, way.environment)], rules=[DIRECTION])
    return next(v for v in ("fail", "unknown", "pass", "not_applicable") if v in {row["verdict"] for row in rows})


@pytest.mark.ci
@HANDS
def test_against_a_one_way_street(hand: str) -> None:
    assert verdict(hand) == "fail"
    assert verdict(hand, other="with") == "fail"
    assert verdict(hand, other="against") == "unknown"


@pytest.mark.ci
@HANDS
def test_what_does_not_tell(hand: str) -> None:
    """The hand is not stated, the road is two-way, or the ego was there for a moment."""
    assert verdict(hand, stated=False) != "fail"
    assert verdict(hand, two_way=True) == "unknown"
    assert verdict(hand, seconds=4.0) == "unknown"
