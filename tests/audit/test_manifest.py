"""A manifest that no drive can be judged by is refused as a whole, in one line, before anything is judged."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from drivelint.audit.sources import drives, expand_manifests, tag_warnings
from drivelint.cli.audits import audit as audit_command
from drivelint.drive import conditions
from drivelint.drive.trace import DriveInput
from drivelint.errors import UsageError
from drivelint.guide import __file__ as guide
from drivelint.result import request
from drivelint.result.load import load_result
from tests.audit import fleet
from tests.audit.here import InThisProcess, run_audit
from tests.fleet_report.command import ran


def manifest_file(home: Path, *lines: str) -> str:
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
        assert conditions.parse_env_settings(example.split(";"))


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("c.mcap,weather=rain,", r"row 2 \(c.mcap\): environment 'weather=rain': 'rain' is no weather"),
        ("c.mcap,weather,", r"row 2 \(c.mcap\): environment 'weather': write KEY=VALUE"),
        ("c.mcap,,left", r"row 2 \(c.mcap\): handedness 'left': known are auto, lht, rht"),
        ("c.mcap,weather=dry,", r"row 2 \(c.mcap\): environment 'weather=dry': weather is 'wet' already"),
    ],
)
def test_a_value_that_is_none_is_told_with_its_row(tmp_path: Path, line: str, message: str) -> None:
    source = manifest_file(tmp_path, "log,environment,handedness", "b.mcap,,lht", line)
    with pytest.raises(UsageError, match=message) as told:
        list(drives([source], DriveInput(env=("weather=wet",))))
    assert "\n" not in str(told.value)


def test_nothing_is_judged_by_such_a_manifest(tmp_path: Path) -> None:
    few = fleet.write(tmp_path / "fleet", 3)
    text = few.manifest.read_text(encoding="utf-8").splitlines()
    text = [text[0] + ",environment", *(f"{line},weather=rain" for line in text[1:])]
    few.manifest.write_text("\n".join(text) + "\n", encoding="utf-8")
    executor = InThisProcess()
    with pytest.raises(UsageError, match="row 1"):
        run_audit(few, tmp_path / "out", executor)
    with pytest.raises(UsageError, match="'rain' is no weather"):
        run_audit(fleet.write(tmp_path / "other", 1), tmp_path / "out2", executor, env=("weather=rain",))
    assert not executor.tasks
    assert not list((tmp_path / "out").rglob("receipts/*"))


@pytest.mark.parametrize("log", ["logs/a.mcap", "logs/a", "s3://fleet/a.mcap"])
def test_a_manifest_without_a_column_log_is_no_drive(tmp_path: Path, log: str) -> None:
    source = manifest_file(tmp_path, "path,release", f"{log},r1")
    with pytest.raises(UsageError, match="a manifest needs a column log: its column 'path' names logs"):
        list(drives([source], DriveInput()))


@pytest.mark.parametrize(
    ("columns", "row", "message"),
    [
        ("map,ego,release", "road.xodr,1,r1", "its columns are map, ego, release$"),
        ("file,release", "nowhere/a.mcap,r1", "its columns are file, release$"),
        ("vehicle,year", "v1,2026", "its columns are vehicle, year$"),
        ("log;release", "logs/a.mcap;r1", "its columns are log;release; separate them by commas$"),
        ("ego,environment", "", "its columns are ego, environment$"),
    ],
)
def test_a_manifest_is_told_which_column_it_lacks(tmp_path: Path, columns: str, row: str, message: str) -> None:
    source = manifest_file(tmp_path, columns, row)
    with pytest.raises(UsageError, match=f"^{re.escape(source)}: a manifest needs a column log: {message}"):
        list(drives([source], DriveInput()))


def test_a_manifest_in_parquet_is_told_which_column_it_lacks(tmp_path: Path) -> None:
    pq.write_table(pa.table({"file": ["nowhere/a.mcap"], "year": [2026]}), tmp_path / "fleet.parquet")
    with pytest.raises(UsageError, match=r"a manifest needs a column log: its columns are file, year$"):
        list(drives([str(tmp_path / "fleet.parquet")], DriveInput()))


def test_a_table_with_lines_before_its_header_is_a_drive(tmp_path: Path) -> None:
    """As esmini writes them."""
    source = manifest_file(
        tmp_path, "esmini GIT REV: N/A", "Scenario File Name: cut-in.xosc", "t [s], x, y, name", "0.0, 1.0, 2.0, car"
    )
    assert [each.log for each in drives([source], DriveInput())] == [source]


@pytest.mark.parametrize("empty", ["time,x", ""])
def test_a_table_without_rows_is_left_to_its_reader(tmp_path: Path, empty: str) -> None:
    source = manifest_file(tmp_path, empty)
    assert [each.log for each in drives([source], DriveInput())] == [source]


def test_a_table_of_states_is_a_drive(tmp_path: Path) -> None:
    """Also one that names the recording it was made from, which is not there."""
    source = manifest_file(tmp_path, "time,actor,x,made_of", "0.0,1,2.0,run/7.mcap")
    assert [each.log for each in drives([source], DriveInput())] == [source]


@pytest.fixture(scope="module")
def two(tmp_path_factory: pytest.TempPathFactory) -> fleet.Fleet:
    return fleet.write(tmp_path_factory.mktemp("two") / "fleet", 2)


def manifest(two: fleet.Fleet, *rows: str, name: str = "own.csv") -> str:
    file = two.manifest.parent / name
    file.write_text("\n".join(["log,map,ego,environment,site", *rows]), encoding="utf-8")
    return str(file)


@pytest.mark.ci
def test_check_reads_each_log_of_a_manifest_by_its_own_options(two: fleet.Fleet, tmp_path: Path) -> None:
    logs = [f"logs/drive-0000{n}.parquet" for n in range(2)]
    named = manifest(two, f"{logs[0]},ring.xodr,1,weather=wet,leeds", f"{logs[1]},ring.xodr,,,york")
    words = ("check", named, "--rules", fleet.RULE, "--no-robustness", "--no-annotate", "--env", "light=day")
    found = ran(*words, "--out", tmp_path / "out", "--format", "json", "--quiet", "--no-cache")
    assert found.code in {0, 1}, found
    result = load_result(tmp_path / "out")
    ids = result.drives["drive_id"].to_pylist()
    egos = {(row["drive_id"], row["ego_id"]) for row in result.verdicts.to_pylist()}
    assert egos == {(ids[0], "1"), (ids[1], "0")}
    said = [{each["condition"]: each["value"] for each in row} for row in result.drives["conditions"].to_pylist()]
    assert said == [{"light": "day", "weather": "wet"}, {"light": "day"}]
    asked = request.load(tmp_path / "out")
    mine = asked.of_drive(ids[0])
    assert (mine.ego, mine.env) == ("1", ("light=day", "weather=wet"))
    assert mine.map is not None
    assert mine.map.samefile(two.road)
    assert asked.of_drive("another") == asked
    same = ran("explain", f"{fleet.RULE}@{ids[0]}", "--in", tmp_path / "out", "--samples", "0", "--format", "json")
    assert same.code == 0, same
    assert json.loads(same.out)["verdict"]["ego_id"] == "1"
    refused = ran("pack", tmp_path / "out", "--out", tmp_path / "pack")
    assert (refused.code, "options of their own" in refused.err) == (2, True)


@pytest.mark.parametrize(
    ("rows", "why"),
    [
        (("logs/drive-00000.parquet,,,weather=foggy,",), "row 1 .*weather.*nothing was judged yet"),
        (("logs/drive-00000.parquet,,,,", "logs/drive-00000.parquet,,1,,"), "twice, with different options"),
        (("logs,,1,,",), "not one log"),
    ],
)
def test_check_refuses_a_manifest_before_it_judges(rows: tuple[str, ...], why: str, two: fleet.Fleet) -> None:
    found = ran("check", manifest(two, *rows, name="bad.csv"), "--map", two.road, "--quiet", "--no-cache")
    assert found.code == 2
    assert re.search(why, found.err), found.err


def test_a_table_of_states_with_a_column_log_is_a_log(two: fleet.Fleet, tmp_path: Path) -> None:
    states = pq.read_table(two.manifest.parent / "logs" / "drive-00000.parquet")
    pq.write_table(states.append_column("log", pa.array(["a b c"] * states.num_rows)), tmp_path / "own.parquet")
    assert expand_manifests([str(tmp_path / "own.parquet")], DriveInput()) == ((str(tmp_path / "own.parquet"),), {})


@pytest.mark.parametrize(
    ("columns", "warnings"),
    [
        (["mpa", "site"], ["the manifest's column mpa is only a tag: did you mean map?"]),
        (["Handednes"], ["the manifest's column Handednes is only a tag: did you mean handedness?"]),
        (["lap", "release"], []),
    ],
)
def test_a_misspelt_column_is_told_once(columns: list[str], warnings: list[str], tmp_path: Path) -> None:
    assert list(tag_warnings(columns)) == warnings
    rows = [",".join(["logs/a.mcap", *("x" for _ in columns)])] * 2
    notes: list[str] = []
    expand_manifests([manifest_file(tmp_path, ",".join(["log", *columns]), *rows)], DriveInput(), notes.append)
    assert notes == warnings
