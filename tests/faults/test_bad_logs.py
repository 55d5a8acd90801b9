"""A log with a fault, checked with a sound one: its exit code, what is told, no pass from not looking, and nobody else harmed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

import drivelint
from tests.faults import drives
from tests.faults.bad_logs import BAD_LOGS, BadLog

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.ci

RULES = "ukhc.no-collision"


def check_result(*logs: Path, **options: Any) -> drivelint.CheckResult:
    return drivelint.check(logs, rules=RULES, ego="0", annotate=False, robustness=False, **options)


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[dict[str, Any]]]:
    """Return a sound log and its verdicts when it is checked alone."""
    log = drives.osi_mcap(tmp_path_factory.mktemp("sound") / "sound", drives.drive(drives.N + 1))
    alone = check_result(log)
    rows: list[dict[str, Any]] = alone.verdicts.arrow().to_pylist()
    assert (alone.exit_code, [row["verdict"] for row in rows]) == (0, ["pass", "pass"])
    return log, rows


@pytest.mark.sample(1, ci=1)
@pytest.mark.parametrize("names", [[name for name in drives.WRITERS if name != "csv"], ["csv"]], ids=["most", "csv"])
def test_the_drive_is_sound_in_every_format(names: list[str], tmp_path: Path) -> None:
    result = check_result(
        *(drives.WRITERS[name](tmp_path / name, drives.drive()) for name in names), **mapping(names[-1], tmp_path)
    )
    rows = result.drives.arrow().to_pylist()
    told = {found["check_id"] for row in rows for found in row["quality"]}
    assert told <= {"assumed_size", "ego_chosen", "no_indicator", "no_brake_light", "velocity_derived", "unprotected"}
    assert (len(rows), result.exit_code) == (len(names), 0)
    assert result.verdicts.arrow()["verdict"].to_pylist() == ["pass", "pass"] * len(names)


def mapping(name: str, folder: Path) -> dict[str, str]:
    if name != "csv":
        return {}
    (folder / "mapping.toml").write_text(drives.MAPPING, encoding="utf-8")
    return {"mapping": str(folder / "mapping.toml")}


def id_of(bad: BadLog) -> str:
    return f"{bad.fault} {bad.format}"


def assert_told(bad: BadLog, name: str, result: drivelint.CheckResult) -> None:
    """The log of that name is judged, or not, with what its fault leaves, and the user is told."""
    (drive,) = (row for row in result.drives.arrow().to_pylist() if row["file_name"].partition(".")[0] == name)
    told = (drive["status_reason"] or "") + "".join(f["message"] for f in drive["quality"])
    assert bad.phrase in told
    assert "internal error" not in told
    assert told.count("the log is damaged or cut off") <= 1
    assert drive["status"] == ("not_judged" if bad.exit_code == 4 else "judged")
    assert drive["lossy"] == (bad.exit_code == 3)
    rows = result.verdicts.arrow().to_pylist()
    verdicts = {row["verdict"] for row in rows if row["drive_id"].startswith(name)}
    assert verdicts == (set() if bad.exit_code == 4 else set(bad.verdicts))


def of_sound(result: drivelint.CheckResult) -> list[dict[str, Any]]:
    return [row for row in result.verdicts.arrow().to_pylist() if row["drive_id"].startswith("sound")]


@pytest.mark.ci
@pytest.mark.sample(3, ci=2)
@pytest.mark.parametrize("bad", BAD_LOGS, ids=id_of)
def test_a_bad_log(bad: BadLog, tmp_path: Path, sound: tuple[Path, list[dict[str, Any]]]) -> None:
    good, alone = sound
    (tmp_path / "in").mkdir()
    result = check_result(bad.write(tmp_path / "in"), good, **mapping(bad.format, tmp_path))
    assert result.exit_code == bad.exit_code
    assert_told(bad, "bad", result)
    assert of_sound(result) == alone


@pytest.fixture(scope="module")
def together(tmp_path_factory: pytest.TempPathFactory, sound: tuple[Path, list[dict[str, Any]]]) -> dict[str, Any]:
    """Return the results of one run over all logs that need no mapping, and of one over the others, by format."""
    folder = tmp_path_factory.mktemp("bad")
    found: dict[str, Any] = {}
    for names in ({bad.format for bad in BAD_LOGS} - {"csv"}, {"csv"}):
        logs = [bad.write(folder, f"bad{no:02}") for no, bad in enumerate(BAD_LOGS) if bad.format in names]
        result = check_result(*logs, sound[0], **mapping("csv" if "csv" in names else "", folder))
        found |= dict.fromkeys(names, result)
    return found


@pytest.mark.parametrize("no", range(len(BAD_LOGS)), ids=lambda no: id_of(BAD_LOGS[no]))
def test_a_bad_log_among_others(no: int, together: dict[str, drivelint.CheckResult]) -> None:
    assert_told(BAD_LOGS[no], f"bad{no:02}", together[BAD_LOGS[no].format])


def test_all_bad_logs_harm_no_other(
    together: dict[str, drivelint.CheckResult], sound: tuple[Path, list[dict[str, Any]]]
) -> None:
    for result in together.values():
        assert result.exit_code == 4
        assert of_sound(result) == sound[1]
