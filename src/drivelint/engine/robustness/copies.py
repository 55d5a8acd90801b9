"""Makes copies of a drive, or of a part of it, with assumed recording errors.

The errors of a copy are constant, because real ones drift slowly. They are normally distributed with mean 0: for each actor, an offset of
its position in x and in y, and of its clock, which moves it along its velocity; and one offset of the map, applied to all actors.

A draw depends only on the seed, the actor's id and the copy's number. So a part of a drive has the same errors as the whole drive, and
the same drive in another file, under another name, has the same errors.

In a block of 20 copies, each error is a Latin hypercube sample: one draw from each of 20 equally probable ranges. Small and large errors
then occur in the right proportion, so fewer copies are needed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from hashlib import sha256
from statistics import NormalDist
from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.arrays import floats, replace_columns

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from drivelint.arrays import Floats
    from drivelint.drive.trace import Trace
    from drivelint.engine.batch import Drive

COPIES_PER_BLOCK: Final = 20
"""The number of copies in a block, and of the ranges that each error is drawn from."""
_STANDARD_NORMAL: Final = NormalDist()


@dataclass(frozen=True)
class MeasurementErrors:
    """Standard deviations of the errors, the number of copies (None: as many as needed) and the seed."""

    position_m: float = 0.1
    time_s: float = 0.05
    map_m: float = 0.1
    samples: int | None = None
    seed: int = 0

    @property
    def standard_deviations_text(self) -> str:
        """The standard deviations as text."""
        return (
            f"{self.position_m:g} m in every actor's position, {self.time_s:g} s in its clock, "
            f"{self.map_m:g} m in the position of the map"
        )


def copies(drive: Drive, errors: MeasurementErrors, copy_numbers: Sequence[int]) -> tuple[list[str], Drive]:
    """Return the ids of the copies with these numbers, and one `Drive` with the rows of all of them; copy 0 has no errors."""
    ids = [f"{drive.trace.drive_id}~{number:05}" for number in copy_numbers]
    states = drive.trace.tables["actor_state"]
    tables = {name: _rows_per_copy(rows, ids) for name, rows in drive.trace.tables.items()}
    tables["actor_state"] = replace_columns(
        tables["actor_state"], _positions_of_copies(states, _state_errors(drive, errors, copy_numbers))
    )
    return ids, replace(drive, trace=replace(drive.trace, drive_id=ids[0], tables=tables))


def _rows_per_copy(rows: pa.Table, ids: Sequence[str]) -> pa.Table:
    """Return a table's rows repeated for each of these drive ids."""
    owner = pa.array(ids, pa.string()).take(np.repeat(np.arange(len(ids)), rows.num_rows))
    return replace_columns(pa.concat_tables([rows] * len(ids)), {"drive_id": owner})


def _state_errors(drive: Drive, errors: MeasurementErrors, copy_numbers: Sequence[int]) -> Floats:
    """Return the errors of x, y (m) and clock (s) of each state, shape (copies, states, 3)."""
    tables = drive.trace.tables
    actors = pc.unique(tables["actor_state"]["actor_id"])
    of_actor = np.stack(
        [_standard_normal_draws(copy_numbers, errors.seed, name) for name in actors.to_pylist()], axis=1
    )
    of_map = _standard_normal_draws(copy_numbers, errors.seed, None)[:, None, :]
    sizes = np.array([errors.position_m, errors.position_m, errors.time_s])
    common = np.array([errors.map_m, errors.map_m, 0.0])
    actor = pc.index_in(tables["actor_state"]["actor_id"], value_set=actors).to_numpy(zero_copy_only=False)
    errors_of_states: Floats = (of_actor * sizes + of_map * common)[:, actor, :]
    return errors_of_states


def _standard_normal_draws(copy_numbers: Sequence[int], seed: int, actor: str | None) -> Floats:
    """Return draws (copies, 3) of the standard normal distribution, zeros for copy 0. `actor`: an actor's id; None: the map."""
    key = sha256("\0".join([str(seed), "map" if actor is None else f"actor {actor}"]).encode()).digest()
    rng = np.random.Generator(np.random.PCG64(int.from_bytes(key)))
    ranges = np.tile(np.arange(COPIES_PER_BLOCK)[:, None], (1, 3))
    blocks = [
        (rng.permuted(ranges, axis=0) + rng.random((COPIES_PER_BLOCK, 3))) / COPIES_PER_BLOCK
        for _ in range(-(-max(copy_numbers) // COPIES_PER_BLOCK))
    ]
    # not scipy's ndtri: loading it takes longer than judging a rule
    quantiles = [_STANDARD_NORMAL.inv_cdf(share) for share in np.concatenate(blocks).ravel().tolist()]
    draws = np.concatenate([np.zeros((1, 3)), np.array(quantiles).reshape(-1, 3)])
    return draws[list(copy_numbers)]


def _positions_of_copies(states: pa.Table, state_errors: Floats) -> dict[str, Floats]:
    """Return the positions of all copies, concatenated; an unknown velocity counts as 0."""
    places = {}
    for axis, (place, speed) in enumerate((("x_m", "vx_mps"), ("y_m", "vy_mps"))):
        along = np.nan_to_num(floats(states[speed])) * state_errors[:, :, 2]
        places[place] = (floats(states[place]) + state_errors[:, :, axis] + along).ravel()
    return places


def with_drive_id(trace: Trace, drive_id: str) -> Trace:
    """Return the trace with another drive id."""
    tables = {name: _rows_per_copy(rows, [drive_id]) for name, rows in trace.tables.items()}
    return replace(trace, drive_id=drive_id, tables=tables)


def crop(drive: Drive, from_ns: int, to_ns: int, actors: Collection[str] | None = None) -> Drive:
    """Return the part of a drive between two times, with these actors (None: all that have states then)."""
    tables = dict(drive.trace.tables)
    for name in ("actor_state", "signal_state", "declared_event"):
        t_ns = tables[name]["t_ns"]
        within = pc.and_(pc.greater_equal(t_ns, from_ns), pc.less_equal(t_ns, to_ns))
        if actors is not None and name != "signal_state":
            within = pc.and_(
                within, pc.is_in(tables[name]["actor_id"], value_set=pa.array(sorted(actors), pa.string()))
            )
        tables[name] = tables[name].filter(within)
    actor_ids = pc.unique(tables["actor_state"]["actor_id"])
    tables["actor"] = tables["actor"].filter(pc.is_in(tables["actor"]["actor_id"], value_set=actor_ids))
    span = pc.min_max(tables["actor_state"]["t_ns"]).as_py()
    about = {"t_start_ns": [span["min"]], "t_end_ns": [span["max"]], "n_states": [tables["actor_state"].num_rows]}
    tables["data_log"] = replace_columns(tables["data_log"], about)
    return replace(drive, trace=replace(drive.trace, tables=tables))
