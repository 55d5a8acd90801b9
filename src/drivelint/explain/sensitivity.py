"""Judges copies of a drive with random errors of position, clock and map, to show how sure a verdict is.

Every copy has, drawn once for the whole drive (such errors drift slowly, they do not jump from step to step):
for each actor an offset of its position (x and y alike) and one of its clock, which moves it along its velocity;
and one offset of the map, which is one of all actors together. Normal distributions about nothing.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from drivelint.arrays import floats, with_columns
from drivelint.engine.batch import BATCH_STATES, Drive
from drivelint.explain.model import Sensitivity
from drivelint.explain.sandbox import renamed
from drivelint.result.certainty import certainty

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.arrays import Floats
    from drivelint.explain.model import Row
    from drivelint.explain.verdict_context import VerdictContext

_VERDICTS: Final = ("fail", "unknown", "pass", "not_applicable", "error")


@dataclass(frozen=True)
class MeasurementErrors:
    """Standard deviations of the errors, the number of copies (None: as `for_verdict` says) and the seed."""

    position_m: float = 0.1
    time_s: float = 0.05
    map_m: float = 0.1
    samples: int | None = None
    seed: int = 0

    def for_verdict(self, verdict: str) -> MeasurementErrors:
        """Return these errors with a number of copies: few for an unknown verdict, which small errors seldom decide."""
        return self if self.samples is not None else replace(self, samples=10 if verdict == "unknown" else 100)


def sensitivity_of_check(finding: Row | None, errors: MeasurementErrors) -> Sensitivity | None:
    """Return in how many copies `check` found what it found; None: it judged none, or others are asked for."""
    if finding is None or finding["n_copies"] is None or errors != MeasurementErrors():
        return None
    counts, not_told = {"fail": finding["n_stays"]}, (None, None, None, None)
    return Sensitivity(finding["n_copies"], *not_told, counts, None, None, certainty(finding))


def perturbed_copies(drive: Drive, errors: MeasurementErrors) -> Iterator[list[Drive]]:
    """Yield the copies of a drive, as many at once as a batch may have states; the same ones for the same seed."""
    states = drive.trace.tables["actor_state"]
    ids = sorted(pc.unique(states["actor_id"]).to_pylist())
    actor = pc.index_in(states["actor_id"], value_set=pa.array(ids, pa.string())).to_numpy(zero_copy_only=False)
    rng = np.random.Generator(np.random.PCG64(errors.seed))
    samples = errors.samples or 0
    drawn = rng.standard_normal((samples, len(ids), 3))
    of_map = rng.standard_normal((samples, 2))
    numbers = {name: floats(states[name]) for name in ("x_m", "y_m", "vx_mps", "vy_mps")}
    at_once = max(1, BATCH_STATES // max(1, states.num_rows))
    for start in range(0, samples, at_once):
        yield [
            _copy(drive, sample, numbers, drawn[sample][actor], of_map[sample], errors=errors)
            for sample in range(start, min(start + at_once, samples))
        ]


def _copy(
    drive: Drive, sample: int, numbers: dict[str, Floats], drawn: Floats, of_map: Floats, *, errors: MeasurementErrors
) -> Drive:
    """Return a copy whose states have their errors: `drawn` has x, y and clock for each state, `of_map` x and y for all."""
    states, clock = drive.trace.tables["actor_state"], drawn[:, 2] * errors.time_s
    for axis, (place, speed) in enumerate((("x_m", "vx_mps"), ("y_m", "vy_mps"))):
        along = np.nan_to_num(numbers[speed]) * clock
        values = numbers[place] + drawn[:, axis] * errors.position_m + of_map[axis] * errors.map_m + along
        states = with_columns(states, {place: values})
    moved = replace(drive.trace, tables={**drive.trace.tables, "actor_state": states})
    return Drive(renamed(moved, f"{drive.trace.drive_id}~{sample:05}"), drive.environment)


def verdict_sensitivity(
    context: VerdictContext, drive: Drive, errors: MeasurementErrors, span: tuple[int, int] | None
) -> Sensitivity:
    """Return how often each verdict occurs on copies of a drive, without those that never do. `span`: what of it is in `drive`."""
    found: list[str] = []
    for batch in perturbed_copies(drive, errors):
        with context.sandbox(batch) as sandbox:
            found += context.verdicts_on(sandbox.judge(context.params), [copy.trace.drive_id for copy in batch])
    counts: dict[str, int] = {verdict: found.count(verdict) for verdict in _VERDICTS if verdict in found}
    start, end = span or (None, None)
    return Sensitivity(**asdict(errors), counts=counts, from_ns=start, to_ns=end)
