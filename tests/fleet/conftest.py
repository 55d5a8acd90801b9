"""Real results for the tests of fleets: `check --out` on the overtakes of the fixtures, run once for each set of options."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.fleet_report.command import ran
from tests.shared_data import ROOT

OVERTAKE = ROOT / "fixtures" / "overtake"
RunCheck = Callable[..., Path]


@pytest.fixture(scope="session")
def run_check(tmp_path_factory: pytest.TempPathFactory) -> RunCheck:
    """Return a function that judges the three overtakes, or other logs, with further options and returns the result's folder."""
    folders: dict[tuple[str, ...], Path] = {}

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
        command += ["--mapping", str(OVERTAKE / "mapping.toml"), "--quiet", "--fail-on", "never"]
        command += ["--no-annotate", "--no-robustness"]  # a fleet's rates count neither
        if (key := tuple(command)) not in folders:
            out = tmp_path_factory.mktemp("audit") / "results"
            done = ran(*command, "--out", out)
            assert done.code in {0, 4}, done.err  # 4: rules of which nothing can be decided
            folders[key] = out
        return folders[key]

    return check
