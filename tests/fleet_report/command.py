"""The command line in this process."""

from __future__ import annotations

import contextlib
import io
from typing import NamedTuple

import typer

from drivelint.cli.app import app
from drivelint.errors import DriveLintError


class Ran(NamedTuple):
    """What a command came to; `err` has the message of a user's mistake, too."""

    code: int
    out: str
    err: str


def ran(*words: object) -> Ran:
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            code = app([str(word) for word in words], standalone_mode=False) or 0
        except typer.Exit as end:
            code = end.exit_code
        except DriveLintError as error:
            err.write(str(error))
            code = int(error.exit_code)
    return Ran(code, out.getvalue(), err.getvalue())
