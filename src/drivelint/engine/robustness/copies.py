"""Makes copies of a drive, or of a part of it, with assumed errors of a recording.

Every copy has, drawn once for the whole drive (such errors drift slowly, they do not jump from step to step):
for each actor an offset of its position (x and y alike) and one of its clock, which moves it along its velocity;
and one offset of the map, which is one of all actors together. Normal distributions about nothing.

A draw depends on the seed, the actor's id and the copy's number only. So a part of a drive has the errors of the whole, and the same
drive in another file, under another name, has the same errors.

Copies come in blocks. In a block, the errors of one kind are one from each of as many equally probable ranges (a Latin hypercube sample):
small and large errors occur as often as they should, so that fewer copies show in how many of all a finding would stay.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from hashlib import sha256
from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.arrays import floats, with_columns

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from drivelint.arrays import Floats
    from drivelint.drive.trace import Trace
    from drivelint.engine.batch import Drive

BLOCK: Final = 20
"""Copies among which each error is drawn once from each of as many ranges."""


@dataclass(frozen=True)
class MeasurementErrors:
    """Standard deviations of the errors, the number of copies (None: as many as it takes) and the seed."""

    position_m: float = 0.1
    time_s: float = 0.05
    map_m: float = 0.1
    samples: int | None = None
    seed: int = 0

    @property
    def words(self) -> str:
        """Their standard deviations."""
        return f"{self.position_m:g} m in every actor's position, {self.time_s:g} s in its clock, {self.map_m:g} m in the map's place"


def copies(drive: Drive, errors: MeasurementErrors, numbers: Sequence[int]) -> tuple[list[str], Drive]:
    """Return the ids of these copies of a drive, and all of them as the rows of one; 0 is the copy without errors."""
    ids = [f"{drive.trace.drive_id}~{number:05}" for number in numbers]
    states = drive.trace.tables["actor_state"]
    tables = {name: _repeated(rows, ids) for name, rows in drive.trace.tables.items()}
    tables["actor_state"] = with_columns(
        tables["actor_state"], _positions_of_copies(states, _draws(drive, errors, numbers))
    )
    return ids, replace(drive, trace=replace(drive.trace, drive_id=ids[0], tables=tables))


def _repeated(rows: pa.Table, ids: Sequence[str]) -> pa.Table:
    """Return a table's rows once for each of these drives."""
    owner = pa.array(ids, pa.string()).take(np.repeat(np.arange(len(ids)), rows.num_rows))
    return with_columns(pa.concat_tables([rows] * len(ids)), {"drive_id": owner})


def _draws(drive: Drive, errors: MeasurementErrors, numbers: Sequence[int]) -> Floats:
    """Return (copies, states, 3): the errors of x, y (m) and clock (s) of each state."""
    tables = drive.trace.tables
    actors = pc.unique(tables["actor_state"]["actor_id"])
    of_actor = np.stack([_standard(numbers, errors.seed, name) for name in actors.to_pylist()], axis=1)
    of_map = _standard(numbers, errors.seed, None)[:, None, :]
    own = np.array([errors.position_m, errors.position_m, errors.time_s])
    common = np.array([errors.map_m, errors.map_m, 0.0])
    actor = pc.index_in(tables["actor_state"]["actor_id"], value_set=actors).to_numpy(zero_copy_only=False)
    found: Floats = (of_actor * own + of_map * common)[:, actor, :]
    return found


def _standard(numbers: Sequence[int], seed: int, actor: str | None) -> Floats:
    """Return (copies, 3) draws of the standard normal distribution; zeros for the copy 0. `actor` None: the map."""
    from scipy.special import ndtri  # loading it takes longer than judging a rule

    key = sha256("\0".join([str(seed), "map" if actor is None else f"actor {actor}"]).encode()).digest()
    rng = np.random.Generator(np.random.PCG64(int.from_bytes(key)))
    ranges = np.tile(np.arange(BLOCK)[:, None], (1, 3))
    blocks = [(rng.permuted(ranges, axis=0) + rng.random((BLOCK, 3))) / BLOCK for _ in range(-(-max(numbers) // BLOCK))]
    drawn: Floats = np.concatenate([np.zeros((1, 3)), *map(ndtri, blocks)])
    return drawn[list(numbers)]


def _positions_of_copies(states: pa.Table, draws: Floats) -> dict[str, Floats]:
    """Return the positions of all copies, one after the other; an unknown velocity is taken to be none."""
    found = {}
    for axis, (place, speed) in enumerate((("x_m", "vx_mps"), ("y_m", "vy_mps"))):
        along = np.nan_to_num(floats(states[speed])) * draws[:, :, 2]
        found[place] = (floats(states[place]) + draws[:, :, axis] + along).ravel()
    return found


def renamed(trace: Trace, drive_id: str) -> Trace:
    """Return a trace under another name."""
    tables = {name: _repeated(rows, [drive_id]) for name, rows in trace.tables.items()}
    return replace(trace, drive_id=drive_id, tables=tables)


def crop(drive: Drive, from_ns: int, to_ns: int, actors: Collection[str] | None = None) -> Drive:
    """Return the part of a drive between two times, with these actors (None: all that are seen then)."""
    tables = dict(drive.trace.tables)
    for name in ("actor_state", "signal_state", "declared_event"):
        t_ns = tables[name]["t_ns"]
        within = pc.and_(pc.greater_equal(t_ns, from_ns), pc.less_equal(t_ns, to_ns))
        if actors is not None and name != "signal_state":
            within = pc.and_(
                within, pc.is_in(tables[name]["actor_id"], value_set=pa.array(sorted(actors), pa.string()))
            )
        tables[name] = tables[name].filter(within)
    seen = pc.unique(tables["actor_state"]["actor_id"])
    tables["actor"] = tables["actor"].filter(pc.is_in(tables["actor"]["actor_id"], value_set=seen))
    span = pc.min_max(tables["actor_state"]["t_ns"]).as_py()
    about = {"t_start_ns": [span["min"]], "t_end_ns": [span["max"]], "n_states": [tables["actor_state"].num_rows]}
    tables["data_log"] = with_columns(tables["data_log"], about)
    return replace(drive, trace=replace(drive.trace, tables=tables))
