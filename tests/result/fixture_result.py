"""The fixture's overtakes, checked with their evidence."""

from __future__ import annotations

from pathlib import Path

from drivelint.report.progress import Silent
from drivelint.result.model import Result
from drivelint.run import CheckOptions, check

FIXTURE = Path(__file__).resolve().parents[2] / "fixtures" / "overtake"

NAMES = ("safe", "near_miss", "collision")


def run(out: Path | None) -> Result:
    return check(
        CheckOptions(
            tuple(str(FIXTURE / f"{name}.csv") for name in NAMES),
            map=FIXTURE / "road.xodr",
            mapping=str(FIXTURE / "mapping.toml"),
            profiles=("relaxed", "nominal", "aggressive"),
            out=out,
        ),
        Silent(),
    )
