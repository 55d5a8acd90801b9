"""A manifest that no drive can be judged by is refused as a whole, in one line, before anything is judged."""

from __future__ import annotations

import re
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.audit.sources import drives
from drivelint.cli.audits import audit as audit_command
from drivelint.drive import conditions
from drivelint.drive.trace import DriveInput
from drivelint.errors import UsageError
from drivelint.guide import __file__ as guide
from tests.audit import fleet
from tests.audit.here import InThisProcess, judged


def written(home: Path, *lines: str) -> str:
    (home / "logs").mkdir(exist_ok=True)
    (home / "logs" / "a").mkdir(exist_ok=True)
    (home / "logs" / "a.mcap").touch()
    file = home / "fleet.csv"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return str(file)


def test_the_example_of_the_guide_and_of_the_help_holds() -> None:
    text = Path(guide).with_name("fleets.md").read_text(encoding="utf-8")
    for said in (text, audit_command.__doc__ or ""):
        (example,) = re.findall(r"environment\W+(\w+=\w+(?:;\w+=\w+)+)", said)
        assert conditions.parse(example.split(";"))


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("c.mcap,weather=rain,", r"row 2 \(c.mcap\): environment 'weather=rain': 'rain' is no weather"),
        ("c.mcap,weather,", r"row 2 \(c.mcap\): environment 'weather': write KEY=VALUE"),
        ("c.mcap,,left", r"row 2 \(c.mcap\): handedness 'left': known are auto, lht, rht"),
        ("c.mcap,weather=dry,", r"row 2 \(c.mcap\): environment 'weather=dry': weather is 'wet' already"),
    ],
)
def test_a_value_that_is_none_is_told_with_its_row(tmp_path: Path, line: str, said: str) -> None:
    source = written(tmp_path, "log,environment,handedness", "b.mcap,,lht", line)
    with pytest.raises(UsageError, match=said) as told:
        list(drives([source], DriveInput(env=("weather=wet",))))
    assert "\n" not in str(told.value)


def test_nothing_is_judged_by_such_a_manifest(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 3)
    text = few.manifest.read_text(encoding="utf-8").splitlines()
    text = [text[0] + ",environment", *(f"{line},weather=rain" for line in text[1:])]
    few.manifest.write_text("\n".join(text) + "\n", encoding="utf-8")
    executor = InThisProcess()
    with pytest.raises(UsageError, match="row 1"):
        judged(few, tmp_path / "out", executor)
    with pytest.raises(UsageError, match="'rain' is no weather"):
        judged(fleet.write(tmp_path / "other", 1), tmp_path / "out2", executor, env=("weather=rain",))
    assert not executor.tasks
    assert not list((tmp_path / "out").rglob("receipts/*"))


@pytest.mark.parametrize("log", ["logs/a.mcap", "logs/a", "s3://fleet/a.mcap"])
def test_a_manifest_without_a_column_log_is_no_drive(tmp_path: Path, log: str) -> None:
    source = written(tmp_path, "path,release", f"{log},r1")
    with pytest.raises(UsageError, match="a manifest needs a column log: its column 'path' names logs"):
        list(drives([source], DriveInput()))


@pytest.mark.parametrize(
    ("columns", "row", "said"),
    [
        ("map,ego,release", "road.xodr,1,r1", "its columns are map, ego, release$"),
        ("file,release", "nowhere/a.mcap,r1", "its columns are file, release$"),
        ("vehicle,year", "v1,2026", "its columns are vehicle, year$"),
        ("log;release", "logs/a.mcap;r1", "its columns are log;release; separate them by commas$"),
        ("ego,environment", "", "its columns are ego, environment$"),
    ],
)
def test_a_manifest_is_told_which_column_it_lacks(tmp_path: Path, columns: str, row: str, said: str) -> None:
    source = written(tmp_path, columns, row)
    with pytest.raises(UsageError, match=f"^{re.escape(source)}: a manifest needs a column log: {said}"):
        list(drives([source], DriveInput()))


def test_a_manifest_in_parquet_is_told_which_column_it_lacks(tmp_path: Path) -> None:
    pq.write_table(pa.table({"file": ["nowhere/a.mcap"], "year": [2026]}), tmp_path / "fleet.parquet")
    with pytest.raises(UsageError, match=r"a manifest needs a column log: its columns are file, year$"):
        list(drives([str(tmp_path / "fleet.parquet")], DriveInput()))


def test_a_table_with_lines_before_its_header_is_a_drive(tmp_path: Path) -> None:
    """As esmini writes them."""
    source = written(
        tmp_path, "esmini GIT REV: N/A", "Scenario File Name: cut-in.xosc", "t [s], x, y, name", "0.0, 1.0, 2.0, car"
    )
    assert [each.log for each in drives([source], DriveInput())] == [source]


@pytest.mark.parametrize("empty", ["time,x", ""])
def test_a_table_without_rows_is_left_to_its_reader(tmp_path: Path, empty: str) -> None:
    source = written(tmp_path, empty)
    assert [each.log for each in drives([source], DriveInput())] == [source]


def test_a_table_of_states_is_a_drive(tmp_path: Path) -> None:
    """Also one that names the recording it was made from, which is not there."""
    source = written(tmp_path, "time,actor,x,made_of", "0.0,1,2.0,run/7.mcap")
    assert [each.log for each in drives([source], DriveInput())] == [source]
