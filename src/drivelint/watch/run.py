"""The loop of a watch: reads frames, judges windows, and emits messages."""

from __future__ import annotations

import os
import re
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple, Self

from drivelint import catalogue
from drivelint.engine.barrier import refusal_of
from drivelint.errors import DriveLintError, TraceError, UsageError
from drivelint.phrases import plural
from drivelint.result.counts import SEVERITIES
from drivelint.temporary import temporary_folder
from drivelint.watch import contact, messages, triggers
from drivelint.watch.advice import ProfileAdvice
from drivelint.watch.alarms import WARM_UP_NS, AlarmLog
from drivelint.watch.halting import ChildProgram
from drivelint.watch.judge import WindowJudge
from drivelint.watch.settled import SettledVerdicts
from drivelint.watch.shrinking import ShrinkingMargins
from drivelint.watch.window import NS_PER_S, Window

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from concurrent.futures import Future

    from drivelint.drive.trace import Trace
    from drivelint.engine.interruption import Interruption
    from drivelint.watch.alarms import Alarm
    from drivelint.watch.judge import JudgedWindow
    from drivelint.watch.messages import Message
    from drivelint.watch.options import WatchOptions
    from drivelint.watch.server import LiveServer
    from drivelint.watch.source import Frame, Source

READ_TIMEOUT_S: Final = 0.05
"""How long one read waits for new frames."""
FIRST_WINDOW_AFTER_NS: Final = NS_PER_S
"""The log time after which the first window is judged. It shows the ego, and problems of the log or the map."""
CONTACT_SEARCH_PAUSE_S: Final = 0.05
"""The pause after each search for contacts: without it, the searches would take as much time as the windows."""
JUDGE_NICENESS: Final = 3
"""The nice value of the thread that judges windows. It gets half as much processor time as the search for contacts; a greater value
would let other programs stop it."""
SILENCE_AFTER_CHILD_END_S: Final = 1.0
"""After the program that writes the log has ended, the source is read until no frames have come for this long."""


@dataclass
class WatchOutcome:
    """The outcome of the live part of a watch."""

    n_unjudged: int = 0
    """Windows that could not be read or judged."""
    broken: str | None = None
    """Why the source failed; None: it did not fail."""
    halted: Alarm | None = None
    halted_ns: int | None = None
    busy_s: list[float] = field(default_factory=list)
    """The seconds that each judged window took: for a line on stderr, not for results."""

    def timing_text(self) -> str:
        """Return in words how many windows were judged, and how long that took."""
        took = sorted(self.busy_s)
        if not took:
            return "no window could be judged"
        return f"{plural(len(took), 'window')} judged, each in {took[len(took) // 2]:.1f} s (median), {took[-1]:.1f} s at most"


class _WindowOutcome(NamedTuple):
    """The outcome of a window, and the seconds that it took."""

    trace: Trace | None
    outcome: JudgedWindow | DriveLintError
    took_s: float


def _lower_thread_priority() -> None:
    """Lower the priority of this thread and of threads that it starts below that of the search for contacts; on Linux only."""
    if sys.platform == "linux":
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), JUDGE_NICENESS)


def egos_of(trace: Trace) -> set[str]:
    """Return the ids of a log's egos."""
    actors = trace.tables["actor"]
    return set(actors.filter(actors["is_ego"])["actor_id"].to_pylist())


class Watch:
    """Watches one source. `emit` is called with each message; `server` shows the watch to viewers.

    `judge`: a judge that was created before the source was opened; None: create one. The watch closes the judge at its end.
    """

    def __init__(
        self,
        options: WatchOptions,
        source: Source,
        emit: Callable[[Message], None],
        interruption: Interruption,
        server: LiveServer | None = None,
        *,
        judge: WindowJudge | None = None,
    ) -> None:
        if options.window_s * NS_PER_S <= 2 * WARM_UP_NS:
            raise UsageError(f"--window {options.window_s:g}: use more than {2 * WARM_UP_NS / NS_PER_S:g} s")
        if options.every_s * NS_PER_S > options.window_s * NS_PER_S - WARM_UP_NS:
            raise UsageError(
                f"--every {options.every_s:g}: use at most {options.window_s - WARM_UP_NS / NS_PER_S:g} s, or a longer --window"
            )
        self._options = options
        self._source = source
        self._emit = emit
        self._interruption = interruption
        self._server = server
        self._stack = ExitStack()
        self._judge = self._stack.enter_context(judge or WindowJudge(options))
        self._worker = self._stack.enter_context(
            ThreadPoolExecutor(1, initializer=None if source.is_advanced_by_reads else _lower_thread_priority)
        )
        self._running: Future[_WindowOutcome] | None = None
        self._contacts = self._judge.contact_finder()
        self._egos: set[str] = set()
        """The egos of the window that was judged last."""
        self._looked_until_ns: int | None = None
        self._has_begun = False
        self._unseen: list[Frame] = []
        self._look_at_s = 0.0
        rules_by_id = catalogue.load_rules(options.rules_dirs)
        self._triggers = triggers.parse(options.on, rules_by_id, self._judge.rules)
        self._folder = self._stack.enter_context(temporary_folder())
        self._ingest = options.ingest_options()
        self._window = Window(round(options.window_s * NS_PER_S))
        self.alarms = AlarmLog(self._judge.gaps_ns, self._judge.profiles)
        self.settled = SettledVerdicts()
        self._warnings = ShrinkingMargins() if options.warn else None
        self._advice = ProfileAdvice(self._judge.style_by_profile) if options.advise else None
        self._judged_until_ns: int | None = None
        self._drive_start_ns: int | None = None
        self._doubt: str | None = None
        self._erred: set[str] = set()
        self.watched = WatchOutcome()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        for trigger in self._triggers:
            trigger.wait_for_running_commands()
        self._stack.close()

    def watch(self) -> WatchOutcome:
        """Judge until the source has ended, an alarm halts it, or the run is interrupted; then close the windows' database.

        A source that fails counts as ended; its recording can still be checked. Errors: `UsageError`, errors of the machine.
        """
        child = ChildProgram(self._options.command) if self._options.command else None
        try:
            self._loop(child)
            for text in filter(None, [trigger.note_on_left_out_alarms() for trigger in self._triggers]):
                self._emit(messages.note(text))
            if child is not None and self.watched.halted is None and not self._interruption.requested:
                code = child.wait_or_end()
                if code:
                    self._emit(messages.note(f"{self._options.command[0]} ended with exit code {code}"))
        finally:
            if child is not None:
                child.end()
            self._stack.close()
        return self.watched

    def _loop(self, child: ChildProgram | None) -> None:
        quiet_since = time.monotonic()
        is_over = False
        while not (is_over or self._is_stopped):
            frames = self._read_frames()
            if frames:
                self._window.add(frames)
                self._unseen += frames
                quiet_since = time.monotonic()
            if self._unseen and (self._source.is_advanced_by_reads or time.monotonic() >= self._look_at_s):
                self._report_contacts(self._unseen)
                self._unseen = []
                self._look_at_s = time.monotonic() + CONTACT_SEARCH_PAUSE_S
            is_quiet = time.monotonic() - quiet_since > SILENCE_AFTER_CHILD_END_S
            is_over = frames is None or (child is not None and child.exit_code is not None and is_quiet)
            self._judge_due_windows(is_over=is_over)

    def _judge_due_windows(self, *, is_over: bool) -> None:
        """Judge the windows that are due, one after another; in the background, unless the source is in step or has ended."""
        is_advanced_by_reads, every_ns = self._source.is_advanced_by_reads, round(self._options.every_s * NS_PER_S)
        due_ns = every_ns if self._has_begun else min(every_ns, FIRST_WINDOW_AFTER_NS)
        # frames that came while a window was judged are judged in one pass, but each step with `WARM_UP_NS` of its past
        most_ns = every_ns if is_advanced_by_reads else self._window_length_ns - WARM_UP_NS
        while not self._is_stopped:
            if self._running is not None:
                if not (is_advanced_by_reads or is_over or self._running.done()):
                    return
                running, self._running = self._running, None
                self._report_window_outcome(running.result())
                continue
            is_due = self._source.is_window_due or is_over or self._window.unjudged_ns >= due_ns
            if not (is_due and self._window.advance(most_ns)):
                return
            self._has_begun = True
            self._running = self._worker.submit(self._deferred_judgement())

    @property
    def _is_stopped(self) -> bool:
        return self._interruption.requested or self.watched.halted is not None

    def _read_frames(self) -> Sequence[Frame] | None:
        """Return the next frames of the source, and report its notes; None: the source has ended or failed."""
        try:
            frames = self._source.read(READ_TIMEOUT_S)
        except TraceError as error:
            self.watched.broken = str(error)
            self._emit(messages.note(str(error)))
            frames = None
        for text in (*self._source.notes(), *(() if self._server is None else self._server.notes())):
            self._emit(messages.note(text))
        while self._window.jumps:
            since_ns, until_ns = self._window.jumps.pop(0)
            self._emit(
                messages.note(
                    f"the clock jumps from {since_ns / NS_PER_S:.3f} s to {until_ns / NS_PER_S:.3f} s: nothing is judged across the jump"
                )
            )
        return frames

    @property
    def _window_length_ns(self) -> int:
        return round(self._options.window_s * NS_PER_S)

    def _report_contacts(self, frames: Sequence[Frame]) -> None:
        """Report the contacts in new frames, once the ego is known."""
        if self._contacts is None or self._drive_start_ns is None:
            return
        latest = self._window.frames_since(min(frame.t_ns for frame in frames) - contact.LEAST_EXAMINED_LOG_SPAN_NS)
        try:
            trace = self._source.latest_trace(latest, self._folder, self._ingest)
            if self._egos != egos_of(trace):
                return
            rows = self._contacts.new_contacts(trace, self._looked_until_ns)
        except DriveLintError:
            return  # the log is too short or cannot be read: the window reports the problem
        except Exception as error:  # noqa: BLE001 - the windows are still judged
            self._contacts = None
            self._emit(messages.note(f"contacts are only found in windows: {error}"))
            return
        now_ns = self._looked_until_ns = trace.tables["data_log"]["t_end_ns"][0].as_py()
        self._report_alarms(self.alarms.add_contacts_and_return_new_alarms(rows, now_ns), now_ns, self._drive_start_ns)

    def _deferred_judgement(self) -> Callable[[], _WindowOutcome]:
        """Return a function that judges the present window. It may be called in another thread, and raises nothing."""
        begun_s = time.perf_counter()
        frames, drive_start_ns = self._window.frames, self._drive_start_ns

        def judge_window() -> _WindowOutcome:
            trace = None
            try:
                trace = read_window()
                outcome = self._judge.judge([trace], drive_start_ns)[0]
            except Exception as error:  # noqa: BLE001 - whatever error a window causes, the recording must still be checked
                outcome = refusal_of(Path(self._options.source), error).error
            return _WindowOutcome(trace, outcome, time.perf_counter() - begun_s)

        try:
            read_window = self._source.window_reader(frames, self._folder, self._ingest)
        except Exception as error:  # noqa: BLE001 - as above
            failure = refusal_of(Path(self._options.source), error).error
            return lambda: _WindowOutcome(None, failure, 0.0)
        return judge_window

    def _report_window_outcome(self, window_outcome: _WindowOutcome) -> None:
        """Report the new results of a window. If it cannot be read or judged, report this and continue."""
        if isinstance(window_outcome.outcome, DriveLintError):
            self._report_unjudged_window(window_outcome.outcome)
            return
        self._doubt = None
        since_ns = self._judged_until_ns
        self._report_judged_window(window_outcome.outcome)
        self.watched.busy_s.append(window_outcome.took_s)
        if window_outcome.trace is not None:
            self._egos = egos_of(window_outcome.trace)
        if self._server is not None and window_outcome.trace is not None:
            self._server.publish_scene(window_outcome.trace)
            self._server.publish_margins(window_outcome.outcome.margins_since(since_ns))

    def _report_unjudged_window(self, error: DriveLintError) -> None:
        """Report why the log so far cannot be judged; not again for a text that differs only in its numbers."""
        self.watched.n_unjudged += 1
        text = str(error).replace(str(self._folder), "...")
        if (doubt := re.sub(r"\d+", "0", text)) != self._doubt:
            self._doubt = doubt
            self._emit(messages.note(f"not judged yet: {text}"))

    def _report_judged_window(self, judged_window: JudgedWindow) -> None:
        """Report new results of a window."""
        if self._drive_start_ns is None:
            self._drive_start_ns = judged_window.t_start_ns
        for rule_id, reason in judged_window.rule_errors():
            if rule_id not in self._erred:
                self._erred.add(rule_id)
                self._emit(messages.note(f"{rule_id} cannot be run on a window: {reason}"))
        from_ns = None if self._window.is_whole else judged_window.t_end_ns - self._window_length_ns
        for row in self.settled.new_settled_rows(
            judged_window, judged_window.t_start_ns if from_ns is None else from_ns + WARM_UP_NS
        ):
            self._emit(messages.settled_verdict(row, self._drive_start_ns))
        change = self.alarms.add_window(judged_window, self._judged_until_ns, from_ns)
        self._judged_until_ns = judged_window.t_end_ns
        # frames that came while the window was judged are known, too
        now_ns = judged_window.t_end_ns + self._window.unjudged_ns
        for alarm in change.withdrawn:
            self._emit(messages.withdrawn(alarm, now_ns, self._drive_start_ns))
        for alarm in change.new:
            alarm.said_ns = now_ns
        self._report_alarms(change.new, now_ns, self._drive_start_ns)
        for alarm in change.over:
            self._emit(messages.over(alarm, self._drive_start_ns))
        if self._warnings is not None:
            for message in self._warnings.new_messages(judged_window, self._judge.rules, self._drive_start_ns):
                self._emit(message)
        if self._advice is not None:
            for message in self._advice.new_messages(judged_window, self._drive_start_ns):
                self._emit(message)

    def _report_alarms(self, alarms: Sequence[Alarm], now_ns: int, drive_start_ns: int) -> None:
        """Report alarms, start the commands for them, and halt the source if one of the alarms requires it."""
        alarm_messages = []
        for alarm in alarms:
            alarm_messages.append(messages.alarm(alarm, self._judge.rules[alarm.row["rule_id"]], drive_start_ns))
            self._emit(alarm_messages[-1])
            if self._server is not None:
                self._server.publish_alarm(alarm_messages[-1])
        for trigger in self._triggers:
            if (trouble := trigger.run_for_alarms_and_return_note(alarm_messages)) is not None:
                self._emit(messages.note(trouble))
        halting = next((alarm for alarm in alarms if self._is_halting_alarm(alarm)), None)
        if halting is not None:
            self.watched.halted, self.watched.halted_ns = halting, now_ns
            self._emit(messages.halt(halting, now_ns, drive_start_ns))
            self._source.end_sender_if_possible()

    def _is_halting_alarm(self, alarm: Alarm) -> bool:
        """Return whether an alarm halts the source: its severity is at least `halt_on`, and its rule is no draft."""
        least, severity = self._options.halt_on, alarm.row["severity"]
        if least is None or self._judge.rules[alarm.row["rule_id"]].status != "stable":
            return False
        return SEVERITIES.index(severity) <= SEVERITIES.index(least)
