"""A log with a fault, checked with a sound one: its exit code, what is told, no pass from not looking, and nobody else harmed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import drivelint
from tests.faults import drives
from tests.faults.bad_logs import BAD_LOGS, BadLog

if TYPE_CHECKING:
    from pathlib import Path

RULES = "ukhc.no-collision"


def checked(*logs: Path, **options: Any) -> drivelint.CheckResult:
    return drivelint.check(logs, rules=RULES, ego="0", annotate=False, robustness=False, **options)


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[dict[str, Any]]]:
    """Return a sound log and its verdicts when it is checked alone."""
    log = drives.osi_mcap(tmp_path_factory.mktemp("sound") / "sound", drives.drive(drives.N + 1))
    alone = checked(log)
    rows: list[dict[str, Any]] = alone.verdicts.arrow().to_pylist()
    assert (alone.exit_code, [row["verdict"] for row in rows]) == (0, ["pass", "pass"])
    return log, rows


@pytest.mark.parametrize("names", [[name for name in drives.WRITERS if name != "csv"], ["csv"]], ids=["most", "csv"])
def test_the_drive_is_sound_in_every_format(names: list[str], tmp_path: Path) -> None:
    result = checked(
        *(drives.WRITERS[name](tmp_path / name, drives.drive()) for name in names), **mapping(names[-1], tmp_path)
    )
    rows = result.drives.arrow().to_pylist()
    told = {found["check_id"] for row in rows for found in row["quality"]}
    assert told <= {"no_indicator", "no_brake_light", "velocity_derived", "unprotected"}
    assert (len(rows), result.exit_code) == (len(names), 0)
    assert result.verdicts.arrow()["verdict"].to_pylist() == ["pass", "pass"] * len(names)


def mapping(name: str, folder: Path) -> dict[str, str]:
    if name != "csv":
        return {}
    (folder / "mapping.toml").write_text(drives.MAPPING, encoding="utf-8")
    return {"mapping": str(folder / "mapping.toml")}


@pytest.mark.parametrize("bad", BAD_LOGS, ids=lambda bad: f"{bad.fault} {bad.format}")
def test_a_bad_log(bad: BadLog, tmp_path: Path, sound: tuple[Path, list[dict[str, Any]]]) -> None:
    good, alone = sound
    (tmp_path / "in").mkdir()
    log = bad.write(tmp_path / "in")
    result = checked(log, good, **mapping(bad.format, tmp_path))
    by_name = {row["file_name"]: row for row in result.drives.arrow().to_pylist()}
    told = (by_name[log.name]["status_reason"] or "") + "".join(f["message"] for f in by_name[log.name]["quality"])
    assert bad.told in told
    assert "internal error" not in told
    assert told.count("the log is damaged or cut off") <= 1
    assert by_name[log.name]["status"] == ("not_judged" if bad.exit_code == 4 else "judged")
    assert by_name[log.name]["lossy"] == (bad.exit_code == 3)
    assert result.exit_code == bad.exit_code
    rows = result.verdicts.arrow().to_pylist()
    assert [row for row in rows if row["drive_id"].startswith("sound")] == alone
    verdicts = {row["verdict"] for row in rows if row["drive_id"].startswith("bad")}
    assert verdicts == (set() if bad.exit_code == 4 else set(bad.verdicts))
