"""Logs are read in several threads: what they share must stand its first use by all of them at once."""

from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from pathlib import Path

ROUNDS = 40
SCRIPT = """
import importlib.util, sys, threading

def first_use(work):
    barrier = threading.Barrier(4)
    def go():
        barrier.wait()
        work()
    threads = [threading.Thread(target=go) for _ in range(4)]
    [t.start() for t in threads]
    [t.join() for t in threads]

sys.setswitchinterval(1e-6)
for n in range(int(sys.argv[1])):
    spec = importlib.util.find_spec("drivelint.formats.tables.mapping")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # types look their own names up there
    spec.loader.exec_module(module)
    first_use(lambda: module.load("esmini"))
"""


@pytest.mark.ci
def test_a_mapping_is_loaded_for_the_first_time_by_several_threads(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(ROUNDS)], capture_output=True, text=True, check=False, cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert not done.stderr
