"""Records the inputs of a run: every file that Python opens, every folder that it lists, and other searched paths.

The state of each input is taken before its first use and at the end of the run. If these differ, it is unknown which state was judged.
Files that Python's importer reads and the package's own files are not recorded: the key of a receipt includes them.
"""

from __future__ import annotations

import os
import sys
from contextlib import contextmanager
from threading import Lock, local
from typing import TYPE_CHECKING, Any, Final

from drivelint.memo import cache_folder
from drivelint.receipts.events import NOT_REPEATABLE_EVENT, SEARCHED_PATH_EVENT
from drivelint.receipts.inputs import RunInputs, hash_of_matching_file_names, path_state_if_known
from drivelint.receipts.program import program_folders

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from drivelint.receipts.inputs import IsOutput

_WRITE_MODE_LETTERS: Final = frozenset("wax+")
_WRITE_FLAGS: Final = os.O_WRONLY | os.O_RDWR
_IGNORED_FILES: Final = frozenset({"/dev/null", "/dev/urandom", "/proc/self/statm", "/proc/meminfo"})
"""Files that affect no result: they are empty or random, or report memory. `schedstat`, which reports computing time, is also ignored."""


class InputRecorder:
    """The inputs that one run has read so far. `is_output`: returns whether a path is an output of the run."""

    def __init__(self, is_output: IsOutput) -> None:
        self.is_output = is_output
        self.trouble: str | None = None
        """Why a receipt cannot replace a new run; None: it can."""
        self._states: dict[str, str | None] = {}
        self._globs: dict[str, str] = {}
        self._written: set[str] = set()
        self._made: set[str] = set()
        self._inside = local()
        self._lock = Lock()
        cache = cache_folder()
        self._ours = tuple(
            os.path.realpath(folder) for folder in (*program_folders(), *([] if cache is None else [cache]))
        )

    def record_state(self, path: str | os.PathLike[str]) -> None:
        """Record the state of a path before it is read for the first time."""
        whole = os.path.abspath(path)  # noqa: PTH100 - a link may have another target later
        if (
            whole in self._states
            or whole in self._written
            or whole in _IGNORED_FILES
            or (whole.startswith("/proc/self/") and whole.endswith("/schedstat"))
            or self._is_program_file_or_output(os.path.realpath(whole))
        ):
            return
        with self._lock:
            self._states[whole] = None
            self._states[whole] = path_state_if_known(whole, self.is_output)
            if self._states[whole] is None:
                self.trouble = f"{whole} cannot be looked at again"

    def add(self, inputs: RunInputs | None) -> None:
        """Add the inputs of another process of the same run; None: the part of that process depends on more than its inputs."""
        with self._lock:
            if inputs is None:
                self.trouble = "a worker's part cannot be repeated"
                return
            for own_states, added_states in ((self._states, inputs.states), (self._globs, inputs.globs)):
                for name, state in added_states.items():
                    if own_states.setdefault(name, state) != state:
                        self.trouble = f"{name} changed"

    def end_recording_and_return_inputs(self) -> RunInputs | None:
        """End the recording in this thread, and return the inputs.

        None: the result depends on more than the inputs, or they changed during the run.
        """
        self._inside.busy = True  # from here on, nothing is recorded in this thread
        if self.trouble is not None:
            return None
        states = {path: state for path, state in self._states.items() if state is not None}
        inputs = RunInputs(states, dict(self._globs))
        return inputs if inputs.are_unchanged(self.is_output) else None

    def record_event(self, event: str, args: tuple[Any, ...], is_by_importer: bool) -> None:
        """Record an audit event. It never raises an error, because that would affect the audited code."""
        if getattr(self._inside, "busy", False):
            return
        self._inside.busy = True
        try:
            self._record_event_or_raise(event, args, is_by_importer)
        except Exception as error:  # noqa: BLE001 - no error may end the run
            self.trouble = f"{event}: {error!r}"
        finally:
            self._inside.busy = False

    def _record_event_or_raise(self, event: str, args: tuple[Any, ...], is_by_importer: bool) -> None:
        if event == NOT_REPEATABLE_EVENT:
            self.trouble = args[0]
        elif event == "tempfile.mkdtemp":
            self._made.add(os.path.realpath(args[0]))
        elif event == "glob.glob":
            self._globs.setdefault(pattern := os.fspath(args[0]), hash_of_matching_file_names(pattern, self.is_output))
        elif not is_by_importer and not isinstance(path := "." if args[0] is None else args[0], int):
            path = os.fsdecode(path)
            if event == "open" and _is_writing(*args[1:]):
                self._written.add(os.path.abspath(path))  # noqa: PTH100
            else:
                self.record_state(path)

    def _is_program_file_or_output(self, real_path: str) -> bool:
        return self.is_output(real_path) or any(
            is_at_or_below(real_path, folder) for folder in (*self._ours, *self._made)
        )


def is_at_or_below(path: str, folder: str) -> bool:
    """Return whether a path is a folder or below it. Both paths must be without links."""
    return path == folder or path.startswith(folder.rstrip(os.sep) + os.sep)


_AUDIT_EVENTS: Final = frozenset(
    {"open", "os.scandir", "os.listdir", "glob.glob", "tempfile.mkdtemp", SEARCHED_PATH_EVENT, NOT_REPEATABLE_EVENT}
)
_recorders: Final[list[InputRecorder]] = []
_installed_hooks: Final[list[Callable[[str, tuple[Any, ...]], None]]] = []
"""The audit hook of this process, once it is installed."""


@contextmanager
def record_inputs(is_output: IsOutput, named_paths: Iterable[str | os.PathLike[str]]) -> Iterator[InputRecorder]:
    """Record the inputs of this process inside the block. `named_paths`: paths in the request, whose states are recorded first."""
    recorder = InputRecorder(is_output)
    for path in named_paths:
        recorder.record_state(path)
    if not _installed_hooks:
        sys.addaudithook(_audit_hook)  # a hook cannot be removed
        _installed_hooks.append(_audit_hook)
    _recorders.append(recorder)
    try:
        yield recorder
    finally:
        _recorders.remove(recorder)


def current_recorder() -> InputRecorder | None:
    """Return the recorder of the current run in this process; None: nothing is recorded."""
    return _recorders[-1] if _recorders else None


def _audit_hook(event: str, args: tuple[Any, ...]) -> None:
    if not _recorders or event not in _AUDIT_EVENTS:
        return
    importer = _module_that_raised_event().startswith(("importlib.", "_frozen_importlib", "zipimport"))
    for recorder in tuple(_recorders):  # another thread may remove a recorder
        recorder.record_event(event, args, importer)


def _module_that_raised_event() -> str:
    """Return the module whose code raised the event; '' if there is none, as in a thread of a library."""
    try:
        return str(sys._getframe(2).f_globals.get("__name__", ""))  # noqa: SLF001 - the only way to recognise the importer
    except ValueError:
        return ""


def _is_writing(mode: str | None, flags: int) -> bool:
    return bool(_WRITE_MODE_LETTERS.intersection(mode or "")) or bool(flags & _WRITE_FLAGS)
