"""One drive's actor states as arrays, and the poses of the actors at given times."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyarrow.compute as pc

from drivelint.arrays import floats
from drivelint.drive.order import MAX_GAP_PERIODS

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pyarrow as pa
    from numpy.typing import NDArray

    from drivelint.arrays import Floats, Times


class ActorPoses(NamedTuple):
    """One actor's box: centre and heading at several times, NaN where they are unknown, and its length and width."""

    x: Floats
    y: Floats
    z: Floats
    yaw: Floats
    length: float
    width: float


@dataclass(frozen=True)
class Tracks:
    """Rows of `actor_state` in their own order (actor, then time), with NaN for NULL.

    `actor`: the index of each row's actor in `names`, `classes`, `sizes` and `is_ego`.
    """

    names: list[str]
    classes: list[str | None]
    sizes: Floats
    is_ego: list[bool]
    actor: NDArray[np.int32]
    t_ns: Times
    x: Floats
    y: Floats
    z: Floats
    yaw: Floats

    @property
    def egos(self) -> list[str]:
        """The names of the egos, sorted."""
        return sorted(name for name, is_ego in zip(self.names, self.is_ego, strict=True) if is_ego)

    @cached_property
    def rows_by_actor(self) -> dict[str, slice]:
        """The rows of each actor."""
        edges = np.searchsorted(self.actor, np.arange(len(self.names) + 1))
        return {name: slice(int(edges[i]), int(edges[i + 1])) for i, name in enumerate(self.names)}

    def times(self, name: str) -> Times:
        """Return the times of an actor's samples; empty if there is no such actor."""
        return self.t_ns[self.rows_by_actor.get(name, slice(0, 0))]

    def poses_at(self, name: str, t_ns: Times) -> ActorPoses:
        """Return an actor's poses at some times, from its last sample before each time, unless that is too old."""
        span, times = self.rows_by_actor.get(name, slice(0, 0)), self.times(name)
        if not len(times):
            nowhere = np.full(len(t_ns), np.nan)
            return ActorPoses(nowhere, nowhere, nowhere, nowhere, np.nan, np.nan)
        k = np.searchsorted(times, t_ns, side="right") - 1
        row = span.start + np.clip(k, 0, None)
        gap = MAX_GAP_PERIODS * float(np.median(np.diff(times))) if len(times) > 1 else 0.0
        is_known = (k >= 0) & (t_ns - self.t_ns[row] <= gap)
        x, y, z, yaw = (np.where(is_known, column[row], np.nan) for column in (self.x, self.y, self.z, self.yaw))
        length, width, _ = map(float, self.sizes[self.actor[span.start]])
        return ActorPoses(x, y, z, yaw, length, width)


def tracks(tables: Mapping[str, pa.Table]) -> Tracks:
    """Return the tracks of one trace from its tables `actor` and `actor_state`."""
    states = tables["actor_state"]
    codes = pc.dictionary_encode(states["actor_id"].combine_chunks())
    names = codes.dictionary.to_pylist()
    actors = tables["actor"]
    about = actors.take(pc.index_in(codes.dictionary, value_set=actors["actor_id"].combine_chunks()))
    return Tracks(
        names,
        about["actor_class"].to_pylist(),
        np.column_stack([floats(about[name]) for name in ("length_m", "width_m", "height_m")]),
        about["is_ego"].to_pylist(),
        codes.indices.to_numpy(),
        states["t_ns"].to_numpy(),
        *(floats(states[name]) for name in ("x_m", "y_m", "z_m", "yaw_rad")),
    )
