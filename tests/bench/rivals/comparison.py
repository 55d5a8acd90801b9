"""Programs that need a Python of their own: their script runs there, times itself and prints JSON."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from tests.bench.table import Skipped


def ask(script: str, module: str, variable: str, *arguments: object) -> dict[str, Any]:
    """Run a script of this folder with the Python named by an environment variable (default: this one), return what it prints.

    Errors: `Skipped` where that Python does not have `module`.
    """
    python = os.environ.get(variable, sys.executable)
    if subprocess.run([python, "-c", f"import {module}"], capture_output=True, check=False).returncode:
        raise Skipped(f"{module} is not installed: install it, or name a Python that has it in {variable}")
    command = [python, str(Path(__file__).with_name(script)), *(str(a) for a in arguments)]
    answer = subprocess.run(command, capture_output=True, text=True, check=False)
    if answer.returncode:
        raise RuntimeError(f"{script} failed: {answer.stderr.strip().splitlines()[-1:]}")
    found: dict[str, Any] = json.loads(answer.stdout.splitlines()[-1])
    return found


def agree(quantity: str, our_value: float, their_value: float, tolerance: float = 1e-6) -> None:
    """Refuse to compare times of different answers. Errors: `AssertionError`."""
    if not abs(our_value - their_value) <= tolerance * max(1.0, abs(our_value), abs(their_value)):
        raise AssertionError(f"{quantity}: ours {our_value}, theirs {their_value}")
