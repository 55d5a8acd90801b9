"""What the Python interface imports."""

from __future__ import annotations

import subprocess
import sys

from tests.shared_data import ROOT

SCRIPT = """
import sys, drivelint
try:
    drivelint.check("no-such-log.mcap", env={"weather": "dry"}, map_offset=(1, 2))
except drivelint.DriveLintError as error:
    assert "no-such-log" in str(error), error
from drivelint import parallel, run
assert "typer" not in sys.modules, "Typer is imported"
"""


def test_python_needs_no_typer() -> None:
    source = str(ROOT / "src")
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], capture_output=True, text=True, env={"PYTHONPATH": source}, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
