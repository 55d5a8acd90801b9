"""Handles the standard streams: prints lines on stderr, and handles a stdout that is closed, full or without a reader."""

from __future__ import annotations

import io
import os
import sys
from contextlib import suppress
from typing import Final

from drivelint.errors import DriveLintError, ExitCode

READER_LEFT_EXIT_CODE: Final = 141
"""The exit code if the reader of stdout closes it early, as `head` does: the code that a shell returns for SIGPIPE."""


class ReaderLeftError(Exception):
    """The reader of stdout has closed it. The class is no OSError, because libraries turn an OSError into exit code 1."""


class StdoutError(DriveLintError):
    """The system refuses a write to stdout."""

    exit_code = ExitCode.TEMPFAIL


class _Stdout(io.TextIOWrapper):
    """A stdout that raises `ReaderLeftError` and `StdoutError` in place of OSErrors."""

    def write(self, text: str) -> int:
        try:
            return super().write(text)
        except OSError as error:
            raise _error_of_stdout(error) from error

    def flush(self) -> None:
        try:
            super().flush()
        except OSError as error:
            raise _error_of_stdout(error) from error


def _error_of_stdout(error: OSError) -> Exception:
    _redirect_to_null(1)  # at exit, Python tries to write the remaining buffer
    if isinstance(error, BrokenPipeError):
        return ReaderLeftError()
    return StdoutError(f"stdout cannot be written: {error.strerror}")


def make_stdout_and_stderr_writable() -> None:
    """Make stdout and stderr writable even if the caller closed them: output to a closed stream is discarded.

    Also removes a variable COLUMNS of 0, which some programs set: the width is then unknown.
    """
    if not os.environ.get("COLUMNS", "").strip().lstrip("0"):
        os.environ.pop("COLUMNS", None)
    for no, name in ((1, "stdout"), (2, "stderr")):
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(_redirect_to_null(no), "w", encoding="utf-8"))
        stream = getattr(sys, name)
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # text from a log may have characters outside the terminal's encoding
    if isinstance(sys.stdout, io.TextIOWrapper) and sys.stdout is sys.__stdout__:  # stdout was not replaced
        encoding, buffered = sys.stdout.encoding, sys.stdout.line_buffering
        sys.stdout = _Stdout(sys.stdout.detach(), encoding, errors="replace", line_buffering=buffered)


def print_on_stderr(line: str) -> None:
    """Print a line on stderr if possible; ignore errors, so that the exit code stays correct."""
    with suppress(OSError):
        print(line, file=sys.stderr, flush=True)


def _redirect_to_null(descriptor: int) -> int:
    sink = os.open(os.devnull, os.O_WRONLY)
    if sink != descriptor:
        os.dup2(sink, descriptor)
        os.close(sink)
    return descriptor
