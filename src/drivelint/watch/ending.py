"""The end of a watch: checks the recording, and compares the alarms and verdicts with the result."""

from __future__ import annotations

import shutil
from dataclasses import replace
from typing import TYPE_CHECKING

from drivelint import run
from drivelint.errors import ChangedLogError, TraceError
from drivelint.phrases import plural
from drivelint.result.model import exit_status
from drivelint.watch import messages
from drivelint.watch.window import NS_PER_S

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from drivelint.engine.interruption import Interruption
    from drivelint.report.progress import Progress
    from drivelint.result.model import Result
    from drivelint.watch.messages import Message
    from drivelint.watch.options import WatchOptions
    from drivelint.watch.run import Watch


def check_recording(
    options: WatchOptions,
    recording: Path,
    work: Path | None,
    watch: Watch,
    *,
    folder: Path,
    progress: Progress,
    interruption: Interruption,
) -> Result:
    """Check the recording like any log. `folder`: for a copy, if needed. Errors: as `check`; `TraceError` for an empty recording."""
    if not recording.exists() or (recording.is_file() and not recording.stat().st_size):
        raise TraceError(f"{options.source}: nothing was recorded: {watch.watched.broken or 'no frame came'}")
    try:
        result = run.check(
            run.CheckOptions.from_judging_options((str(recording),), options, work), progress, interruption
        )
    except ChangedLogError:
        # another program still writes the recording: a copy of its present content is checked
        copy = folder / recording.name
        shutil.copy(recording, copy)
        result = run.check(run.CheckOptions.from_judging_options((str(copy),), options, work), progress, interruption)
    if watch.watched.broken is not None:
        why = f"the recording ended early: {watch.watched.broken}"
        result = replace(result, ended_early=why, notes=(*result.notes, why))
    halted = watch.watched.halted
    if halted is None or watch.watched.halted_ns is None:
        return result
    drive_start_ns = result.drives["t_start_ns"][0].as_py() or 0
    note = (
        f"halted at {(watch.watched.halted_ns - drive_start_ns) / NS_PER_S:.2f} s by an alarm of {halted.row['rule_id']} "
        f"at {(halted.row['t_start_ns'] - drive_start_ns) / NS_PER_S:.2f} s"
    )
    return replace(result, halted=note, notes=(*result.notes, note))


def report_outcome_and_return_counts_text(result: Result, watch: Watch, emit: Callable[[Message], None]) -> str:
    """Report for each alarm whether the whole log confirms it, then the late and the revised verdicts. Return the counts as a text."""
    missed = watch.alarms.assign_findings_and_return_unassigned(result.findings.to_pylist(), result.verdicts)
    for alarm in watch.alarms.alarms:
        emit(messages.alarm_outcome(alarm))
    late, revised = watch.settled.late_and_revised_rows(result.verdicts)
    for row in late:
        emit(messages.late_verdict(row))
    for row in revised:
        emit(messages.revised_verdict(row))
    status = exit_status(result)
    alarms = watch.alarms.alarms
    counts = {
        "n_windows": len(watch.watched.busy_s),
        "n_windows_not_judged": watch.watched.n_unjudged,
        "n_verdicts_said_before_the_end": len(watch.settled),
        "n_verdicts_revised": len(revised),
        "n_alarms": len(alarms),
        "n_alarms_withdrawn": sum(alarm.withdrawn_ns is not None for alarm in alarms),
        "n_alarms_that_are_findings": sum(bool(alarm.finding_ids) for alarm in alarms),
        "n_findings": result.findings.num_rows,
        "n_findings_without_alarm": len(missed),
    }
    emit(messages.end(counts, int(status.code), status.why))
    return (
        f"{plural(len(alarms), 'alarm')}, {counts['n_alarms_that_are_findings']} of them findings of the whole log, "
        f"{counts['n_alarms_withdrawn']} withdrawn; {len(missed)} of {plural(result.findings.num_rows, 'finding')} without an alarm"
    )
