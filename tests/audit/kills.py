"""Kills an audit at random moments, driver or workers, and lets it go on until it ends: `python -m tests.audit kills DRIVES KILLS`."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence


def children(pid: int) -> list[int]:
    """Return the processes that a process's threads have started, and those that these have (Linux)."""
    found: list[int] = []
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        with suppress(OSError):
            found += [int(child) for child in task.read_text(encoding="ascii").split()]
    return [each for child in found for each in (child, *children(child))]


def audit_with_kills(command: Sequence[str], n_kills: int, seconds: float, seed: int = 0) -> tuple[int, int]:
    """Run `drivelint` with these arguments until it ends by itself; return its exit code and how many processes were killed.

    A kill comes within `seconds` of a start or of the last kill, and takes the driver or one of its workers, by lot. A driver loses
    two workers at most: over a third one, a drive might be quarantined that is not to blame.
    """
    rng = random.Random(seed)  # noqa: S311 - not a secret
    killed = 0
    while True:
        running = subprocess.Popen(
            [sys.executable, "-m", "drivelint", *command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        most_workers = 2
        while killed < n_kills:
            with suppress(subprocess.TimeoutExpired):
                running.wait(rng.uniform(0.3, seconds))
            if running.poll() is not None:
                break
            victim = rng.choice([running.pid, *(children(running.pid) if most_workers else ())])
            with suppress(ProcessLookupError):
                os.kill(victim, signal.SIGKILL)
                killed += 1
                most_workers -= victim != running.pid
            if victim == running.pid:
                running.wait()
                break
        code = running.wait()
        if code != -signal.SIGKILL:
            return code, killed
        time.sleep(0.1)
