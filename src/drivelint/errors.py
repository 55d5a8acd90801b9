"""Defines the errors that a user can act on, and the exit codes."""

from __future__ import annotations

import errno
import traceback
from enum import IntEnum
from typing import Final


class ExitCode(IntEnum):
    """Exit codes of the command line. Precedence: 130 > 75 > 2 > 1 > 4 > 3 > 0."""

    OK = 0
    FAILED = 1
    USAGE = 2
    LOSSY = 3
    NOT_JUDGED = 4
    TEMPFAIL = 75
    INTERRUPTED = 130


LEAST_ADDRESS_SPACE_BYTES: Final = 2_000_000_000
"""The least address space (`ulimit -v`). With less, libraries end the process at import, with their own messages and exit codes."""
_MEMORY_LIMIT_TOO_LOW_TEXT: Final = (
    "the limit of memory (ulimit -v) is too low: raise it, and run the same command again"
)
MAX_ERROR_LENGTH: Final = 2000
"""The most characters of an error that are shown: a damaged file may contain a name of a megabyte."""
MAX_PROBLEM_LINES: Final = 100
"""The most problems of one file that are shown."""


class DriveLintError(Exception):
    """An error that is shown to the user as one clear line, without a traceback."""

    exit_code: ExitCode = ExitCode.USAGE
    _is_shown = False

    def __reduce__(self) -> tuple[object, ...]:
        """Return how pickle restores the error in another process: with its finished message, without `__init__`."""
        return _error_from_pickle, (type(self), self.args)

    def __str__(self) -> str:
        """Return the message; the middle of a very long message is left out."""
        return _shortened(super().__str__())

    def _render_traceback_(self) -> list[str]:
        """Return what IPython shows: on the first call the message alone, on later calls (`%tb`) the traceback."""
        if self._is_shown:
            return traceback.format_exception(self)
        self._is_shown = True
        # a text from a log may contain control characters of a terminal
        line = "".join(
            letter if letter.isprintable() or letter == "\n" else ascii(letter)[1:-1] for letter in str(self)
        )
        return [f"{type(self).__name__}: {line} (%tb shows the traceback)"]

    @property
    def is_about_whole_run(self) -> bool:
        """Whether the error concerns the whole run: every other drive would fail in the same way."""
        return self.exit_code == ExitCode.TEMPFAIL


def _shortened(text: str) -> str:
    if len(text) <= MAX_ERROR_LENGTH:
        return text
    return f"{text[: MAX_ERROR_LENGTH // 2]} ... {text[-MAX_ERROR_LENGTH // 2 :]}"


def _error_from_pickle(kind: type[DriveLintError], args: tuple[object, ...]) -> DriveLintError:
    """Return an error of this class without calling its `__init__`, which may need other arguments."""
    error = kind.__new__(kind)
    error.args = args
    return error


class UsageError(DriveLintError):
    """The command line, a settings file or a mapping cannot be understood."""


class ProblemLinesError(DriveLintError):
    """An error about a file, with a line for each of its problems."""

    def __str__(self) -> str:
        """Return the message, with no more than `MAX_PROBLEM_LINES` lines; the middle of a very long line is left out."""
        lines = Exception.__str__(self).split("\n")
        more = len(lines) - MAX_PROBLEM_LINES
        shortened = [_shortened(line) for line in lines[:MAX_PROBLEM_LINES]]
        return "\n".join(shortened if more <= 0 else [*shortened, f"... and {more} more problems"])


class SceneFileError(UsageError, ProblemLinesError):
    """A file of scenes has errors."""

    __str__ = ProblemLinesError.__str__


class RuleError(ProblemLinesError):
    """A rule file has an error in its header, sections, parameters or SQL."""


class MapError(DriveLintError):
    """A map is missing, unreadable or of another place."""

    exit_code = ExitCode.NOT_JUDGED


class MemoryShortError(DriveLintError):
    """There is too little memory to judge even one ego of a drive. If the user has set a memory limit, the run ends (exit code 75)."""

    exit_code = ExitCode.NOT_JUDGED

    def __init__(self, task: str) -> None:
        if memory_limit_of_process_bytes() is None:
            super().__init__(f"{task}: needs more memory than this machine has: use a larger one, or fewer --rules")
        else:
            super().__init__(f"{task}: {_MEMORY_LIMIT_TOO_LOW_TEXT}")
            self.exit_code = ExitCode.TEMPFAIL


class TraceError(DriveLintError):
    """A log is missing, unreadable, or contains nothing that can be judged."""

    exit_code = ExitCode.NOT_JUDGED


class ChangedLogError(TraceError):
    """A log changed while it was judged, so its verdicts do not describe its present content."""


class WorkerLostError(DriveLintError):
    """A process that did a part of the work has died."""

    exit_code = ExitCode.TEMPFAIL


class InternalError(DriveLintError):
    """A bug of drivelint prevents the judging of one drive; the other drives are judged."""

    exit_code = ExitCode.NOT_JUDGED


_MEMORY_ERROR_WORDS: Final = (
    "bad_alloc",
    "cannot allocate memory",
    "can't start new thread",
    "out of memory",
    "failed to allocate",
)


def describe_machine_error(error: Exception) -> tuple[str, ExitCode] | None:
    """Return the message and the exit code of an error that the machine causes; None: the cause is a bug.

    A memory limit can have an effect anywhere, even at an import or the start of a thread, and each library words the error differently.
    """
    if isinstance(error, MemoryError) or any(words in str(error).casefold() for words in _MEMORY_ERROR_WORDS):
        limited = memory_limit_of_process_bytes() is not None
        return (
            _MEMORY_LIMIT_TOO_LOW_TEXT if limited else "there is too little memory: run the same command again",
            ExitCode.TEMPFAIL,
        )
    if isinstance(error, OSError) and error.errno == errno.ENAMETOOLONG:
        return f"{error.filename}: the name is too long for this system: choose a shorter one", ExitCode.USAGE
    return None


def memory_limit_of_process_bytes() -> int | None:
    """Return the least memory limit that is set for this process; None: no limit is set, or the system does not report limits."""
    try:
        import resource
    except ImportError:  # Windows
        return None
    soft = [resource.getrlimit(kind)[0] for kind in (resource.RLIMIT_AS, resource.RLIMIT_DATA)]
    return min((limit for limit in soft if limit != resource.RLIM_INFINITY), default=None)
