"""The standard streams of the command: lines on stderr, and a stdout that may be closed, full or without a reader."""

from __future__ import annotations

import io
import os
import sys
from contextlib import suppress
from typing import Final

from drivelint.errors import DriveLintError, ExitCode

READER_LEFT: Final = 141
"""The exit code if the reader of stdout leaves before its end, as `head` does: the code that a shell returns for SIGPIPE."""


class ReaderLeftError(Exception):
    """No program reads stdout any more. Not an OSError, because libraries turn that into exit code 1."""


class StdoutError(DriveLintError):
    """The system refuses a write to stdout."""

    exit_code = ExitCode.TEMPFAIL


class _Stdout(io.TextIOWrapper):
    """Stdout that raises our errors."""

    def write(self, text: str) -> int:
        try:
            return super().write(text)
        except OSError as error:
            raise _stdout_error(error) from error

    def flush(self) -> None:
        try:
            super().flush()
        except OSError as error:
            raise _stdout_error(error) from error


def _stdout_error(error: OSError) -> Exception:
    _to_nowhere(1)  # Python tries to write the rest at its end
    if isinstance(error, BrokenPipeError):
        return ReaderLeftError()
    return StdoutError(f"stdout cannot be written: {error.strerror}")


def prepare() -> None:
    """Make both streams writable, whatever the caller did: a write to a closed stream is dropped.

    Some programs report a terminal of 0 columns; its width is then not known.
    """
    if not os.environ.get("COLUMNS", "").strip().lstrip("0"):
        os.environ.pop("COLUMNS", None)
    for no, name in ((1, "stdout"), (2, "stderr")):
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(_to_nowhere(no), "w", encoding="utf-8"))
        stream = getattr(sys, name)
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a log's words may not fit the terminal's encoding
    if isinstance(sys.stdout, io.TextIOWrapper) and sys.stdout is sys.__stdout__:  # not a stream that replaced it
        encoding, buffered = sys.stdout.encoding, sys.stdout.line_buffering
        sys.stdout = _Stdout(sys.stdout.detach(), encoding, errors="replace", line_buffering=buffered)


def say(line: str) -> None:
    """Print a line on stderr if possible; the exit code is correct in any case."""
    with suppress(OSError):
        print(line, file=sys.stderr, flush=True)


def _to_nowhere(no: int) -> int:
    sink = os.open(os.devnull, os.O_WRONLY)
    if sink != no:
        os.dup2(sink, no)
        os.close(sink)
    return no
