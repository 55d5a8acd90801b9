"""Who drives on restricted ground, which the map draws as a lane, is not out of reach of the rules."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from drivelint.formats import load_map
from drivelint.road.map_reader import MapSource
from tests.derive.marked import mark
from tests.formats.opendrive import xodr
from tests.scenes import LANE, Road, drive, judged, linked, moving, plan, times

HANDS = pytest.mark.parametrize("hand", ["rht", "lht"])


@cache
def roadway(hand: str, outer: str, kind: str) -> Road:
    """Return a road with two lanes and one of the type `outer` beside them in one direction, and one lane in the other."""
    side = 1 if hand == "lht" else -1
    lanes = [
        linked(side * n, kind=outer if n == 3 else "driving").replace("</lane>", mark("broken") + "</lane>")
        for n in (1, 2, 3)
    ]
    others = [linked(-side)]
    section = xodr.section(0, *(lanes[::-1] + others if side > 0 else others + lanes))
    text = xodr.xodr(
        xodr.road(
            geometry=plan(((1500.0, 0.0),)),
            lanes=section,
            length=1500.0,
            attributes=f'rule="{hand.upper()}"',
            more=f'<type s="0" type="{kind}"/>',
        )
    )
    return Road(load_map(MapSource(f"restricted-{hand}-{outer}-{kind}.xodr", text.encode())), ((1500.0, 0.0),))


def verdict(
    hand: str, rule: str, kind: str, *, outer: str = "restricted", back: bool = False, reverse: bool = False
) -> str:
    """Return the verdict on an ego that drives at 25 m/s on the outer lane, from 8 s on (until 20 s with `back`)."""
    way = roadway(hand, outer, kind)
    side = 1 if hand == "lht" else -1
    t = times(30.0)
    d = side * LANE * (1.5 + np.clip((t - 8) / 3, 0, 1) - (np.clip((t - 20) / 3, 0, 1) if back else 0.0))
    place = 1400 - 25 * t if reverse else 50 + 25 * t
    ego = moving("ego", way, t, place, d if not reverse else side * LANE * 2.5)
    other = moving("other", way, t, 40 + 25 * t, side * LANE * 1.5)
    rows = judged([drive([ego, other], way.environment)], rules=[rule])
    return next(v for v in ("fail", "unknown", "pass", "not_applicable") if v in {row["verdict"] for row in rows})


@pytest.mark.ci
@HANDS
def test_a_change_out_of_it_is_not_overlooked(hand: str) -> None:
    assert verdict(hand, "stvo.rg6", "motorway", back=True) == "unknown"
    assert verdict(hand, "stvo.rg6", "motorway", back=True, outer="driving") == "fail"
    assert verdict(hand, "stvo.rg6", "motorway", back=False) == "not_applicable"
    assert verdict(hand, "stvo.rg6", "motorway", back=True, outer="shoulder") == "not_applicable"


@HANDS
def test_the_direction_is_judged_there(hand: str) -> None:
    assert verdict(hand, "ukhc.r143.direction", "rural") == "pass"
