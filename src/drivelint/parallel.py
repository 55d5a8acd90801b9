"""Checks logs in several processes, each of which judges a part of the logs like a separate run.

The parts follow the order of the logs and have about the same number of bytes. The result does not depend on where they are cut.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections import defaultdict
from contextlib import nullcontext, suppress
from dataclasses import replace
from multiprocessing.connection import wait
from pathlib import Path
from threading import Lock, Thread
from typing import TYPE_CHECKING, Any, Final, NamedTuple, NoReturn

import pyarrow as pa
import pyarrow.compute as pc

from drivelint import run, temporary
from drivelint.audit.executors.local import block_ctrl_c, core_count, prepare_worker_process
from drivelint.engine.default_rules import with_selectors_of_run
from drivelint.engine.interruption import Interruption
from drivelint.engine.memory import LEAST_MEMORY_BYTES
from drivelint.errors import DriveLintError, InternalError, WorkerLostError
from drivelint.formats.files import file_names_sizes_and_change_times
from drivelint.phrases import plural
from drivelint.receipts import recorder
from drivelint.report.log_notes import LogNotes, note_on_repeated_log
from drivelint.report.progress import Progress
from drivelint.result.names import TABLE_OF_FILE, TABLE_OF_PICTURE_FILE

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from multiprocessing.connection import Connection

    from drivelint.evaluate.limits import Excess, UnstoppableRuleHandler
    from drivelint.receipts.inputs import IsOutput, RunInputs
    from drivelint.report.log_notes import LogNote
    from drivelint.result.model import Result
    from drivelint.run import CheckOptions, JudgedLogs

_INTERRUPTION_CHECK_PERIOD_S: Final = 0.2
_WORKER_END_GRACE_S: Final = 5.0
"""How long a process may take to end by itself before it is killed."""


class _PartOfLogs(NamedTuple):
    """The logs that one process judges. `n_logs`: the number of logs of the whole run.

    `is_output`: needed to record the inputs; None: they are not recorded. `limits_of_unstoppable_rules`: task -> rule -> exceeded limit,
    for rules that could not be interrupted in an earlier process.
    """

    settings: CheckOptions
    paths: Sequence[Path]
    n_logs: int
    is_output: IsOutput | None
    limits_of_unstoppable_rules: dict[str, dict[str, Excess]]


class _PartOutcome(NamedTuple):
    """The result of a part, and the inputs that were read for it."""

    judged_logs: JudgedLogs
    inputs: RunInputs | None


class _UnstoppableRule(NamedTuple):
    """A rule that continues although it was interrupted."""

    task: str
    rule_id: str
    excess: Excess


class _ProgressCall(NamedTuple):
    """A call of a `Progress` method in a worker, with its arguments."""

    method: str
    arguments: tuple[Any, ...]


def check(
    settings: CheckOptions,
    jobs: int,
    progress: Progress,
    *,
    interruption: Interruption | None = None,
    unstoppable_rule_handler: UnstoppableRuleHandler | None = None,
    on_nothing_judged: Callable[[Result], object] | None = None,
) -> Result:
    """Judge every drive as `run.check` does, in at most `jobs` processes; in one if margins are written or a database is kept.

    Errors: as `run.check`; `WorkerLostError`.
    """
    if jobs > 1 and not settings.margins and not settings.keep_db:
        settings = with_selectors_of_run(settings)
        run.RunRules.from_options(settings)  # wrong rules or parameters are refused here, once
        paths, _ = run.named_logs(settings)
        if len(parts := _cut_into_parts(paths, jobs)) > 1:
            judged_parts = _judge_in_workers(settings, paths, parts, progress, interruption or Interruption())
            return run.join_parts(paths, judged_parts, on_nothing_judged)
    return run.check(settings, progress, interruption, unstoppable_rule_handler, on_nothing_judged)


def _judge_in_workers(
    settings: CheckOptions,
    paths: Sequence[Path],
    parts: Sequence[Sequence[Path]],
    progress: Progress,
    interruption: Interruption,
) -> list[JudgedLogs]:
    """Judge each part in a process of its own."""
    memory = None if settings.memory is None else max(LEAST_MEMORY_BYTES, settings.memory // len(parts))
    worker_settings = replace(settings, memory=memory, threads=max(1, core_count() // len(parts)))
    recording = recorder.current_recorder()
    is_output = None if recording is None else recording.is_output
    progress.stage(run.CHECKING_STAGE, len(paths))
    listener = _DisplayForWorkers(progress, len(paths))
    workers = [_Worker(_PartOfLogs(worker_settings, part, len(paths), is_output, {}), listener) for part in parts]
    try:
        for worker in workers:
            worker.start()
        while running := {worker.pipe: worker for worker in workers if worker.ended is None}:
            if interruption.requested:
                for worker in running.values():
                    worker.interrupt()
            for pipe in wait(list(running), timeout=_INTERRUPTION_CHECK_PERIOD_S):
                running[pipe].receive_message()  # type: ignore[index]
    finally:
        for worker in workers:
            worker.stop()
    ended = [worker.ended for worker in workers if worker.ended is not None]
    if recording is not None:
        for outcome in ended:
            recording.add(outcome.inputs)
    return _without_duplicate_drives([outcome.judged_logs for outcome in ended])


def _cut_into_parts(paths: Sequence[Path], max_parts: int) -> list[list[Path]]:
    """Return the logs in at most `max_parts` parts of about the same size; a log whose size cannot be read counts as empty."""
    sizes = []
    for path in paths:
        with suppress(DriveLintError):
            sizes.append(sum(size for _, size, _ in file_names_sizes_and_change_times(path)))
            continue
        sizes.append(0)
    whole, size_before = sum(sizes) + len(paths), 0
    parts: dict[int, list[Path]] = defaultdict(list)
    for path, size in zip(paths, sizes, strict=True):
        middle = size_before + (size + 1) / 2
        parts[min(max_parts - 1, int(max_parts * middle / whole))].append(path)
        size_before += size + 1
    return [parts[no] for no in sorted(parts)]


def _without_duplicate_drives(parts: Sequence[JudgedLogs]) -> list[JudgedLogs]:
    """Return the parts without drives that an earlier part has judged: logs with the same name and content count once."""
    judged_ids: set[str] = set()
    unique_parts: list[JudgedLogs] = []
    for part in parts:
        drives = part.result.drives
        ids_of_part = set(drives.filter(pc.equal(drives["status"], "judged"))["drive_id"].to_pylist())
        copies = sorted(ids_of_part & judged_ids)
        unique_parts.append(_without_drives(part, copies) if copies else part)
        judged_ids |= ids_of_part
    return unique_parts


def _without_drives(part: JudgedLogs, drives: Sequence[str]) -> JudgedLogs:
    """Return a part without these drives; the only note on each of their logs is that it is a duplicate."""
    result, paths = part.result, {} if part.result.run_options is None else part.result.run_options.traces
    tables = {name: getattr(result, name) for name in (*TABLE_OF_FILE, *TABLE_OF_PICTURE_FILE)}
    remaining = {
        name: table.filter(pc.invert(pc.is_in(table["drive_id"], value_set=pa.array(drives, pa.string()))))
        for name, table in tables.items()
        if "drive_id" in table.column_names
    }
    repeated = [note_on_repeated_log(Path(paths[drive]), drive) for drive in drives if drive in paths]
    repeated_paths = {note.path for note in repeated}
    notes = [note for note in part.notes if note.path not in repeated_paths]
    return replace(part, result=replace(result, **remaining), notes=(*notes, *repeated))


class _DisplayForWorkers:
    """Shows the messages of the workers, each text once."""

    def __init__(self, progress: Progress, n_logs: int) -> None:
        self.progress = progress
        self._notes = LogNotes(progress, n_logs)

    def forward_call(self, call: _ProgressCall) -> None:
        """Forward one call of a worker to the progress display."""
        if call.method == "add":
            self._notes.add(*call.arguments)
        else:
            getattr(self.progress, call.method)(*call.arguments)


class _Worker:
    """A process that judges a part; if a rule cannot be interrupted, it is started again without this rule.

    `ended`: the outcome of the part; None: the process still runs.
    """

    def __init__(self, part: _PartOfLogs, listener: _DisplayForWorkers) -> None:
        self.ended: _PartOutcome | None = None
        self._part = part
        self._listener = listener
        self._n_done = 0

    def start(self) -> None:
        """Start the process."""
        context = multiprocessing.get_context("spawn")  # a fork would copy threads that hold locks
        self.pipe, theirs = context.Pipe()
        self._process = context.Process(target=_run_worker, args=(self._part, theirs, os.getpid()), daemon=True)
        with block_ctrl_c():
            self._process.start()
        theirs.close()

    def interrupt(self) -> None:
        """Request the process to end with the results so far."""
        with suppress(OSError):
            self.pipe.send(None)

    def receive_message(self) -> None:
        """Receive one message. Errors: the error that ended the part; `WorkerLostError`."""
        try:
            message = self.pipe.recv()
        except (EOFError, OSError):
            self._process.join()
            raise WorkerLostError(
                f"a process that judged {plural(len(self._part.paths), 'log')} died (exit code {self._process.exitcode}; -9: killed, "
                "as for lack of memory): check again with fewer --jobs"
            ) from None
        if isinstance(message, _PartOutcome):
            self.ended = message
        elif isinstance(message, BaseException):
            raise message
        elif isinstance(message, _UnstoppableRule):
            self._restart_without_rule(message)
        else:
            self._n_done += message.arguments[0] if message.method == "advance" else 0
            self._listener.forward_call(message)

    def _restart_without_rule(self, unstoppable_rule: _UnstoppableRule) -> None:
        """Start the process again without a rule that cannot be interrupted."""
        self.stop()
        self._listener.progress.note(
            f"rule {unstoppable_rule.rule_id} cannot be stopped: {plural(len(self._part.paths), 'log')} judged again without it"
        )
        self._listener.progress.advance(-self._n_done)
        self._n_done = 0
        task, limits_of_unstoppable_rules = unstoppable_rule.task, self._part.limits_of_unstoppable_rules
        limits_of_unstoppable_rules = {
            **limits_of_unstoppable_rules,
            task: {**limits_of_unstoppable_rules.get(task, {}), unstoppable_rule.rule_id: unstoppable_rule.excess},
        }
        self._part = self._part._replace(limits_of_unstoppable_rules=limits_of_unstoppable_rules)
        self.start()

    def stop(self) -> None:
        """End the process: wait until it has removed its temporary files, but not longer than `_WORKER_END_GRACE_S`, then kill it."""
        self.pipe.close()
        self._process.join(_WORKER_END_GRACE_S)
        self._process.kill()
        self._process.join()


class _ProgressSender(Progress):
    """Sends progress messages from a worker to the parent. `advance` counts only in the stage `run.CHECKING_STAGE`."""

    def __init__(self, pipe: Connection) -> None:
        self._pipe = pipe
        self._lock = Lock()
        self._counts = True

    def send(self, message: object) -> None:
        """Send a message to the parent process."""
        with self._lock:
            self._pipe.send(message)

    def stage(self, name: str, total: int | None = None) -> None:  # noqa: ARG002 - the parent knows the total
        """See `Progress`."""
        self._counts = name == run.CHECKING_STAGE
        self.doing(name)

    def advance(self, n: int = 1) -> None:
        """See `Progress`."""
        if self._counts:
            self.send(_ProgressCall("advance", (n,)))

    def doing(self, activity: str, units_since_advance: float = 0.0) -> None:  # noqa: ARG002 - parts of several workers cannot be combined
        """See `Progress`."""
        self.send(_ProgressCall("doing", (activity,)))

    def note(self, text: str) -> None:
        """See `Progress`."""
        self.send(_ProgressCall("note", (text,)))


class _NotesSender(LogNotes):
    """Sends notes on logs to the parent, which shows each text once for all workers."""

    def __init__(self, sender: _ProgressSender, n_logs: int) -> None:
        super().__init__(Progress(), n_logs)
        self._sender = sender

    def add(self, note: LogNote) -> None:
        """See `LogNotes`."""
        self.notes.append(note)
        self._sender.send(_ProgressCall("add", (note,)))


class _UnstoppableRuleHandlerOfWorker:
    """The `UnstoppableRuleHandler` of a worker: reports a rule that cannot be interrupted to the parent, and ends the worker."""

    def __init__(
        self, limits_of_unstoppable_rules: Mapping[str, Mapping[str, Excess]], sender: _ProgressSender
    ) -> None:
        self._limits_of_unstoppable_rules = limits_of_unstoppable_rules
        self._sender = sender

    def exceeded_limits(self, task: str) -> Mapping[str, Excess]:
        """See `UnstoppableRuleHandler`."""
        return self._limits_of_unstoppable_rules.get(task, {})

    def restart_without(self, task: str, rule_id: str, excess: Excess) -> NoReturn:
        """See `UnstoppableRuleHandler`."""
        temporary.remove_all()
        self._sender.send(_UnstoppableRule(task, rule_id, excess))
        os._exit(0)


def _run_worker(part: _PartOfLogs, pipe: Connection, parent: int) -> None:
    """Judge a part in this process, and send the outcome to the parent."""
    prepare_worker_process(parent)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # the listener ends this process when its parent has ended
    interruption, sender = Interruption(), _ProgressSender(pipe)
    Thread(target=_obey_parent, args=(pipe, interruption), daemon=True, name="listener").start()
    try:
        sender.send(_judge_part(part, sender, interruption))
    except DriveLintError as error:
        sender.send(error)
    except Exception as error:  # noqa: BLE001 - every error ends the run
        sender.send(InternalError(f"internal error in a worker: {type(error).__name__}: {error}: please report it"))


def _judge_part(part: _PartOfLogs, sender: _ProgressSender, interruption: Interruption) -> _PartOutcome:
    notes, handler = (
        _NotesSender(sender, part.n_logs),
        _UnstoppableRuleHandlerOfWorker(part.limits_of_unstoppable_rules, sender),
    )
    with nullcontext() if part.is_output is None else recorder.record_inputs(part.is_output, []) as recording:
        run_rules = run.RunRules.from_options(part.settings)
        judged_logs = run.judge_logs(
            part.settings,
            run_rules,
            part.paths,
            refused_logs=[],
            progress=sender,
            notes=notes,
            interruption=interruption,
            unstoppable_rule_handler=handler,
        )
    return _PartOutcome(
        judged_logs,
        None if recording is None or part.limits_of_unstoppable_rules else recording.end_recording_and_return_inputs(),
    )


def _obey_parent(pipe: Connection, interruption: Interruption) -> None:
    """Interrupt the judging on request, and end the process when the parent has ended."""
    while True:
        try:
            pipe.recv()
        except (EOFError, OSError):
            temporary.remove_all()
            os._exit(1)
        interruption.request()
