"""Judges copies of a drive with random errors of position, clock and map, to show how sure a verdict is."""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Final

from drivelint.engine.batch import MAX_BATCH_STATES
from drivelint.engine.robustness.copies import MeasurementErrors, copies
from drivelint.explain.model import Sensitivity
from drivelint.result.certainty import certainty

if TYPE_CHECKING:
    from collections.abc import Iterator

    from drivelint.engine.batch import Drive
    from drivelint.explain.model import Row
    from drivelint.explain.verdict_context import VerdictContext

_VERDICTS: Final = ("fail", "unknown", "pass", "not_applicable", "error")


def measurement_errors_with_default_number_of_copies(errors: MeasurementErrors, verdict: str) -> MeasurementErrors:
    """Return the errors with a number of copies: 10 for an unknown verdict, which small errors seldom decide, else 100."""
    return errors if errors.samples is not None else replace(errors, samples=10 if verdict == "unknown" else 100)


def sensitivity_from_copies_of_check(finding: Row | None, errors: MeasurementErrors) -> Sensitivity | None:
    """Return the sensitivity from the copies that `check` judged; None if it judged none, or if other errors are requested."""
    if finding is None or finding["n_copies"] is None or errors != MeasurementErrors():
        return None
    values = asdict(errors) | {"samples": finding["n_copies"], "counts": {"fail": finding["n_stays"]}}
    return Sensitivity(**values, from_ns=None, to_ns=None, certainty=certainty(finding))


def groups_of_perturbed_copies(drive: Drive, errors: MeasurementErrors) -> Iterator[tuple[list[str], Drive]]:
    """Yield the ids and tables of copies of a drive, in groups of a batch's size; the same seed gives the same copies."""
    samples = errors.samples or 0
    at_once = max(1, MAX_BATCH_STATES // max(1, drive.n_states))
    for start in range(1, samples + 1, at_once):
        yield copies(drive, errors, range(start, min(start + at_once, samples + 1)))


def verdict_sensitivity(
    context: VerdictContext, drive: Drive, errors: MeasurementErrors, span_ns: tuple[int, int] | None
) -> Sensitivity:
    """Return how often each verdict occurs on copies of `drive`. `span_ns`: the interval of `drive` if it is only a part of the log."""
    verdicts: list[str] = []
    for ids, batch in groups_of_perturbed_copies(drive, errors):
        with context.sandbox([batch]) as sandbox:
            verdicts += context.verdicts_on(sandbox.judge(context.params), ids)
    counts: dict[str, int] = {verdict: verdicts.count(verdict) for verdict in _VERDICTS if verdict in verdicts}
    start, end = span_ns or (None, None)
    return Sensitivity(**asdict(errors), counts=counts, from_ns=start, to_ns=end)
