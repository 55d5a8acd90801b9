"""An encounter is one: who it is seen from changes nothing of it. Between samples, on tracks that are cut, where somebody stops."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.derive.meetings import NORTH, line, mirrored, same
from tests.scenes import Actor, Road, derived, drive, moving, rows, times

Row = dict[str, object]
T = times(24)


def way(*pieces: tuple[float, float], start: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Road:
    return Road(None, pieces, start)  # type: ignore[arg-type]


def of_both(*actors: Actor, **options: object) -> list[Row]:
    """Return the encounters that `ego` sees; `other` sees the same."""
    con = derived(drive(actors, None, egos=("ego", "other"), **options), tables=["conflict"])  # type: ignore[arg-type]
    found = rows(con, "FROM conflict WHERE ego_id = 'ego' AND object_id = 'other' ORDER BY occurrence")
    turned = rows(con, "FROM conflict WHERE ego_id = 'other' AND object_id = 'ego' ORDER BY occurrence")
    assert sorted(map(repr, map(mirrored, found))) == sorted(map(repr, map(same, turned)))
    return found


LEFT = (8 * math.pi / 2, 1 / 8)
RIGHT = (6 * math.pi / 2, -1 / 6)
WAYS = {
    "east": way((400.0, 0.0)),
    "east, left to north": way((100.0, 0.0), LEFT, (200.0, 0.0)),
    "east, right to south": way((100.0, 0.0), RIGHT, (200.0, 0.0)),
    "west, in the next lane": way((400.0, 0.0), start=(200.0, 3.5, math.pi)),
    "west, left to south": way((96.0, 0.0), LEFT, (200.0, 0.0), start=(200.0, 3.5, math.pi)),
    "north, right to east": way((94.0, 0.0), RIGHT, (200.0, 0.0), start=(108.0, -100.0, math.pi / 2)),
    "north, left to west": way((95.5, 0.0), LEFT, (200.0, 0.0), start=(108.0, -100.0, math.pi / 2)),
    "a shift to the left": way((90.0, 0.0), (8.0, 1 / 12), (8.0, -1 / 12), (200.0, 0.0)),
    "once round": way((90.0, 0.0), (2 * math.pi * 12, 1 / 12), (200.0, 0.0)),
}  # fmt: skip


@st.composite
def drivers(draw: st.DrawFn, name: str) -> Actor:
    """Return one on one of the ways, at 3 to 12 m/s, that stands for a while somewhere or does not."""
    road = WAYS[draw(st.sampled_from(sorted(WAYS)))]
    v, at, waits = draw(st.integers(3, 12)), draw(st.integers(80, 125)), draw(st.sampled_from([0, 0, 1, 5]))
    came = draw(st.integers(6, 12))  # seconds: when it is there
    s = np.interp(T, [came - 20, came, came + waits, came + waits + 20], [at - 20 * v, at, at, at + 20 * v])
    sizes: list[dict[str, Any]] = [{}, {"length": 12.0, "width": 2.5}, {"length": 1.8, "width": 0.6, "kind": "bicycle"}]
    size = draw(st.sampled_from(sizes))
    return moving(name, road, T, s, 0.0, **size)


@pytest.mark.slow
@settings(max_examples=8)
@given(st.lists(st.tuples(drivers("ego"), drivers("other")), min_size=12, max_size=12))
def test_both_see_the_same(pairs: list[tuple[Actor, Actor]]) -> None:
    """Turning across each other, merging, parting, following, standing: the same encounters, times, angle and time between."""
    con = derived(
        *(drive(pair, None, drive_id=f"{no:02}", egos=("ego", "other")) for no, pair in enumerate(pairs)),
        tables=["conflict"],
    )
    for no in range(len(pairs)):
        seen = rows(con, "FROM conflict WHERE drive_id = ? ORDER BY t_object_in_ns", [f"{no:02}"])
        of_ego, of_other = ([row for row in seen if row["ego_id"] == who] for who in ("ego", "other"))
        assert sorted(map(repr, map(mirrored, of_ego))) == sorted(map(repr, map(same, of_other)))


@pytest.mark.parametrize(("period", "v"), [(0.1, 20.0), (0.5, 20.0), (1.0, 30.0)])
def test_a_slow_recorder_gives_the_same_time(period: float, v: float) -> None:
    """At 30 m/s and 1 Hz a car is never recorded on the ground that it drives over."""
    t = times(20, period=period)
    a = moving("ego", line(), t, v * (t - 8.3), 0.0)
    b = moving("other", NORTH, t, v / 2 * (t - 11.7), 0.0)
    (row,) = of_both(a, b)
    assert row["pet_s"] == pytest.approx(11.7 - 3.3 / (v / 2) - (8.3 + 3.3 / v), abs=0.002)
    assert row["pet_at_most"] is False
