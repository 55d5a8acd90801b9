"""Actors that jump to one place and stay there until the log ends were taken out of the scene."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.ingested import ingested
from tests.scenes import Actor, drive, moving, road, times

if TYPE_CHECKING:
    from drivelint.drive.trace import Trace

WAY = road(((2000.0, 0.0),))
T = times(10.0)


def put(actor: Actor, since: float, x: float = 0.0, y: float = 500.0) -> Actor:
    """Return the actor standing at (x, y) since then."""
    there = since - 0.05 < T
    vx, vy = (np.where(there, 0.0, v) for v in (actor.vx, actor.vy))
    return replace(actor, x=np.where(there, x, actor.x), y=np.where(there, y, actor.y), vx=vx, vy=vy)


def read(*actors: Actor, egos: tuple[str, ...] = ("ego",)) -> Trace:
    ego = moving("ego", WAY, T, 100 + 10 * T, WAY.ego_d)
    return ingested(drive([ego, *actors], WAY.environment, egos=egos)).trace


def last_seen(trace: Trace) -> dict[str, float]:
    states = trace.tables["actor_state"].to_pylist()
    return {row["actor_id"]: row["t_ns"] / 1e9 for row in states}


def walker(name: str, s: float) -> Actor:
    return moving(name, WAY, T, s + 1.4 * T, WAY.ego_d + 6, kind="pedestrian", length=0.5, width=0.6)


def test_tracks_end_where_their_actors_are_put_upon_each_other() -> None:
    trace = read(put(walker("a", 150), 4.0), put(walker("b", 170), 7.0))
    assert last_seen(trace) == {"ego": T[-1], "a": 3.9, "b": 6.9}
    quality = {row["check_id"]: row for row in trace.tables["quality"].to_pylist()}
    n = sum(int((since - 0.05 < T).sum()) for since in (4.0, 7.0))
    assert (quality["removed"]["n"], quality["removed"]["t_first_ns"]) == (n, 4_000_000_000)
    assert "(a, b)" in quality["removed"]["message"]
    assert not {"teleport", "track_parted"} & quality.keys()


@pytest.mark.parametrize(
    ("actor", "neighbour"),
    [
        (put(walker("a", 150), 4.0), walker("b", 170)),
        (put(walker("a", 150), 4.0), put(walker("b", 170), 4.0, x=0.5)),
        (put(walker("a", 150), 4.0), put(walker("b", 170), -1.0)),
    ],
    ids=["alone", "half a metre beside", "one that was there always"],
)
def test_one_that_is_alone_there_goes_on(actor: Actor, neighbour: Actor) -> None:
    trace = read(actor, neighbour)
    assert max(t for name, t in last_seen(trace).items() if name.startswith("a")) == T[-1]
    assert "removed" not in {row["check_id"] for row in trace.tables["quality"].to_pylist()}


def test_one_that_moves_on_from_there_goes_on() -> None:
    moves = put(walker("b", 170), 4.0)
    trace = read(put(walker("a", 150), 4.0), replace(moves, x=moves.x + np.clip(T - 6.0, 0.0, None)))
    assert max(t for name, t in last_seen(trace).items() if name.startswith("b")) == T[-1]


def test_the_ego_that_is_named_is_kept() -> None:
    trace = read(put(walker("a", 150), 4.0), put(walker("b", 170), 4.0), egos=("a",))
    assert last_seen(trace)["a"] == T[-1]
