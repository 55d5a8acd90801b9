"""`rules test --mutate` shows a bar on a terminal, and prints the same beside it."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
from typing import TYPE_CHECKING

from drivelint.casefile import commands as workshop
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from pathlib import Path


def test_the_bar_is_for_a_terminal_only(tmp_path: Path) -> None:
    workshop.new_rule("mine.one", tmp_path, "invariant")
    command = [sys.executable, "-m", "drivelint", "rules", "test", str(tmp_path), "--mutate"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src"), "TERM": "xterm", "COLUMNS": "100"}
    plain = subprocess.run(command, capture_output=True, check=False, env=environment)
    assert plain.stderr == b""
    assert b"mine.one: " in plain.stdout
    ours, theirs = pty.openpty()
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=theirs, env=environment) as running:
        os.close(theirs)
        assert running.stdout is not None
        shown = os.read(ours, 4096)
        assert running.stdout.read() == plain.stdout
        while chunk := _rest(ours):
            shown += chunk
    os.close(ours)
    assert b"judging mutants" in shown


def _rest(terminal: int) -> bytes:
    try:
        return os.read(terminal, 4096)
    except OSError:  # Linux: the other end is closed
        return b""
