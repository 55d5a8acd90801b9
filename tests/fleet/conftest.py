"""Real results for the tests of fleets: `check --out` on the overtakes of the fixtures, run once for each set of options."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.shared_data import ROOT

OVERTAKE = ROOT / "fixtures" / "overtake"
Checked = Callable[..., Path]


@pytest.fixture(scope="session")
def checked(tmp_path_factory: pytest.TempPathFactory) -> Checked:
    """Return a function that judges the three overtakes, or other logs, with further options and returns the result's folder."""
    made: dict[tuple[str, ...], Path] = {}

    def check(
        *options: str, logs: tuple[str, ...] = ("safe", "near_miss", "collision"), folder: Path = OVERTAKE
    ) -> Path:
        command = [
            "check",
            *(str(folder / f"{name}.csv") for name in logs),
            *options,
            "--map",
            str(OVERTAKE / "road.xodr"),
        ]
        command += ["--mapping", str(OVERTAKE / "mapping.toml"), "--quiet", "--no-annotate", "--fail-on", "never"]
        if (key := tuple(command)) not in made:
            out = tmp_path_factory.mktemp("audit") / "results"
            done = subprocess.run(
                [sys.executable, "-m", "drivelint", *command, "--out", str(out)],
                check=False,
                capture_output=True,
                env={**os.environ, "PYTHONPATH": str(ROOT / "src")},
            )
            assert done.returncode == 0, done.stderr.decode()
            made[key] = out
        return made[key]

    return check
