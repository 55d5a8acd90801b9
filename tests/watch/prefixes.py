"""Judges every window of a log in one pass, as a watch would judge them one after another."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, NamedTuple

from drivelint import run
from drivelint.drive.trace import DriveInput
from drivelint.errors import DriveLintError
from drivelint.report.progress import Silent
from drivelint.watch import contact
from drivelint.watch.alarms import WARM_UP_NS, Alarm, AlarmLog
from drivelint.watch.judge import JudgedWindow, WindowJudge
from drivelint.watch.options import WatchOptions
from drivelint.watch.run import egos_of
from drivelint.watch.settled import SettledVerdicts
from drivelint.watch.sources.replay import Replay
from drivelint.watch.window import NS_PER_S, Window

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from drivelint.drive.trace import Trace
    from drivelint.result.text import Row


@dataclass(frozen=True)
class WatchOutcome:
    """The alarms of a log, the findings of the whole log that no alarm is of, and the windows.

    `settled`: how many verdicts were said before its end. `revised`: those of the whole log that are others than was said.
    """

    alarms: list[Alarm]
    missed: list[Row]
    findings: list[Row]
    windows: list[JudgedWindow | DriveLintError]
    settled: int
    revised: list[Row]

    @property
    def false(self) -> list[Alarm]:
        """The alarms that stand, and are no findings of the whole log."""
        return [alarm for alarm in self.alarms if not alarm.finding_ids and alarm.withdrawn_ns is None]

    @property
    def withdrawn(self) -> list[Alarm]:
        """The alarms that were taken back while the log grew."""
        return [alarm for alarm in self.alarms if alarm.withdrawn_ns is not None]


class ReplayedWindow(NamedTuple):
    """A window of a replayed log, whether it begins where the log does, and the newest steps, which are looked at before it is judged."""

    trace: Trace
    is_whole: bool
    latest: Trace


def windows_of(options: WatchOptions, folder: Path) -> list[ReplayedWindow]:
    """Return each window of a replayed log."""
    every_ns = round(options.every_s * NS_PER_S)
    source = Replay(folder / options.source, options.ingest_options(), speed=0, every_ns=every_ns)
    window = Window(round(options.window_s * NS_PER_S))
    found = []
    while (frames := source.read(0)) is not None:
        window.add(frames)
        while window.advance(every_ns):
            ingest = options.ingest_options()
            latest = source.latest_trace(
                window.frames_since(frames[0].t_ns - contact.LEAST_EXAMINED_LOG_SPAN_NS), folder, ingest
            )
            found.append(ReplayedWindow(source.window_reader(window.frames, folder, ingest)(), window.is_whole, latest))
    return found


def watch(options: WatchOptions, folder: Path, *, at_once: int = 60) -> WatchOutcome:
    """Watch a log of a folder, with so many windows in a pass."""
    made = windows_of(options, folder)
    start_ns = made[0].trace.tables["data_log"]["t_start_ns"][0].as_py()
    with WindowJudge(options) as judge:
        judged: list[JudgedWindow | DriveLintError] = []
        for at in range(0, len(made), at_once):
            judged += judge.judge([each.trace for each in made[at : at + at_once]], start_ns)
        alarms = AlarmLog(judge.gaps_ns, judge.profiles)
        settled = SettledVerdicts()
        contacts = judge.contact_finder()
        egos: set[str] = set()
        until: int | None = None
        for each, (trace, is_whole, latest) in zip(judged, made, strict=True):
            if contacts is not None and until is not None and egos == egos_of(latest):
                alarms.add_contacts_and_return_new_alarms(
                    contacts.new_contacts(latest, until), latest.tables["data_log"]["t_end_ns"][0].as_py()
                )
            if isinstance(each, JudgedWindow):
                egos = egos_of(trace)
                from_ns = None if is_whole else each.t_end_ns - round(options.window_s * NS_PER_S)
                settled.new_settled_rows(each, each.t_start_ns if from_ns is None else from_ns + WARM_UP_NS)
                alarms.add_window(each, until, from_ns)
                until = each.t_end_ns
    result = run.check(check_options(options, folder), Silent())
    findings = result.findings.to_pylist()
    missed = alarms.assign_findings_and_return_unassigned(findings, result.verdicts)
    _, revised = settled.late_and_revised_rows(result.verdicts)
    return WatchOutcome(alarms.alarms, missed, findings, judged, len(settled), revised)


def check_options(options: WatchOptions, folder: Path) -> run.CheckOptions:
    """Return the options with which `check` judges the same log."""
    same = {each.name: getattr(options, each.name) for each in fields(DriveInput)}
    return run.CheckOptions(
        traces=(str(folder / options.source),), rules=options.rules, profiles=options.profiles, robustness=False, **same
    )


def finding_keys(rows: Sequence[Row]) -> list[tuple[str, str | None, str | None, float]]:
    """Return rule, profile, object and start of findings, for a message."""
    return [(r["rule_id"], r["profile"], r["object_id"], round(r["t_start_ns"] / NS_PER_S, 2)) for r in rows]
