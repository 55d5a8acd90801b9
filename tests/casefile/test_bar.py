"""`rules test --mutate` shows a bar on a terminal, and prints the same beside it."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from drivelint.casefile import commands as workshop
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.ci
def test_the_bar_is_for_a_terminal_only(tmp_path: Path) -> None:
    workshop.write_new_rule("mine.one", tmp_path, "invariant")
    command = [sys.executable, "-m", "drivelint", "rules", "test", str(tmp_path), "--mutate"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src"), "TERM": "xterm", "COLUMNS": "100"}
    plain = subprocess.run(command, capture_output=True, check=False, env=environment)
    assert plain.stderr == b""
    assert b"mine.one: " in plain.stdout
    ours, theirs = pty.openpty()
    printed = tmp_path / "printed.txt"
    # a file takes any length: nobody waits for a reader of a full pipe while the terminal is read
    with printed.open("wb") as out, subprocess.Popen(command, stdout=out, stderr=theirs, env=environment):
        os.close(theirs)
        shown = b"".join(iter(lambda: _read(ours), b""))
    os.close(ours)
    assert printed.read_bytes() == plain.stdout
    assert b"judging mutants" in shown


def _read(terminal: int) -> bytes:
    try:
        return os.read(terminal, 4096)
    except OSError:  # Linux: the other end is closed
        return b""
