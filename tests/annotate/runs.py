"""Checks of the overtaking case with annotated logs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from drivelint.report.progress import Silent
from drivelint.result.files import parquet_bytes
from drivelint.result.names import TABLE_OF_FILE
from drivelint.run import CheckOptions, check

ROOT = Path(__file__).resolve().parents[2]
CASE = ROOT / "fixtures" / "overtake"


def run(out: Path, *traces: Path, **options: Any) -> Path:
    """Check some logs of the case and return the folder of their annotated logs."""
    given: dict[str, Any] = {
        "map": CASE / "road.xodr",
        "mapping": str(CASE / "mapping.toml"),
        "rules": ("ukhc",),
        "profiles": ("relaxed", "nominal", "aggressive"),
        "robustness": False,  # logs are annotated before copies are judged
        **options,
    }
    result = check(CheckOptions(tuple(map(str, traces)), out=out, **given), Silent())
    for name, table in TABLE_OF_FILE.items():
        (out / f"{name}.parquet").write_bytes(parquet_bytes(getattr(result, name), table))
    return out / "annotated"


def the(folder: Path, stem: str) -> Path:
    (path,) = folder.glob(f"{stem}-*.mcap")
    return path
