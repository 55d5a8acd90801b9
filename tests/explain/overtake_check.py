"""The fixture's overtakes, checked into a folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from drivelint import run
from drivelint.report.outputs import write
from drivelint.report.progress import Silent
from tests.shared_data import ROOT

if TYPE_CHECKING:
    from drivelint.result.model import Result

OVERTAKE = ROOT / "fixtures" / "overtake"

RULES = (
    "ukhc.r162.safe-distance-ahead",
    "ukhc.contact-signature",
    "ukhc.r126.ds-av-out-of-ov",
    "ukhc.no-collision",
    "ukhc.r112.horn",
)


def check(out: Path, **over: Any) -> Result:
    settings: dict[str, Any] = {
        "traces": tuple(str(OVERTAKE / f"{name}.csv") for name in ("safe", "near_miss", "collision")),
        "map": OVERTAKE / "road.xodr",
        "mapping": str(OVERTAKE / "mapping.toml"),
        "rules": RULES,
        "profiles": ("relaxed", "nominal"),
        "params": ("ukhc.contact-signature.within_m=0.4",),
        "out": out,
        "annotate": False,
    }
    result = run.check(run.CheckOptions(**{**settings, **over}), Silent())
    write(result, out)
    return result
