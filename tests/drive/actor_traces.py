"""What a log says of an actor, as a CSV, and what is made of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tests.ingested import ingested
from tests.scenes import Actor, drive, moving, road, times

if TYPE_CHECKING:
    from drivelint.drive.trace import Trace

WAY = road(((2000.0, 0.0),))

T = times(10.0)


def read(*actors: Actor, egos: tuple[str, ...] = ("ego",)) -> Trace:
    ego = moving("ego", WAY, T, 100 + 10 * T, WAY.ego_d)
    return ingested(drive([ego, *actors], WAY.environment, egos=egos)).trace


def column(trace: Trace, name: str, actor: str = "x") -> np.ndarray[Any, np.dtype[np.float64]]:
    states = trace.tables["actor_state"]
    return np.array(
        [np.nan if row[name] is None else row[name] for row in states.to_pylist() if row["actor_id"] == actor],
        np.float64,
    )


def checks(trace: Trace) -> set[str]:
    return {row["check_id"] for row in trace.tables["quality"].to_pylist() if row["severity"] != "info"}


def unknown(trace: Trace, actor: str = "x") -> list[int]:
    return np.flatnonzero(np.isnan(column(trace, "x_m", actor))).tolist()
