"""`drivelint demo` as a newcomer meets it: files, one command to copy, and that command's verdicts."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from contextlib import chdir
from functools import partial
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

from drivelint import cli
from drivelint import demo as demo_files
from drivelint.engine.profiles import load_profiles
from drivelint.errors import UsageError
from tests.demo.overtakes import PAPER_SPEED_MPS, PROFILES, distance_ahead_m, safe_distance_ahead_m
from tests.demo.road import MPH
from tests.demo.table_1 import TABLE_1

PROGRAM = [sys.executable, "-m", "drivelint"]


def run(words: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False, env=dict(os.environ))


def printed_command(folder: Path) -> list[str]:
    """Return the words after `drivelint` of the command that the demo prints."""
    shown = run([*PROGRAM, "demo", "a new folder"], folder)
    assert shown.returncode == 0, shown.stderr
    (line,) = shown.stdout.splitlines()
    program, *words = shlex.split(line)
    assert program == "drivelint"
    return words


@pytest.mark.slow
def test_the_printed_command_shows_the_safe_drive_as_safe(tmp_path: Path) -> None:
    words = printed_command(tmp_path)
    checked = run([*PROGRAM, *words, "--no-annotate"], tmp_path)
    assert checked.returncode == 1, checked.stderr
    findings = pq.read_table(tmp_path / words[-1] / "findings.parquet").to_pylist()
    severities = {(row["drive_id"].rpartition("-")[0], row["severity"]) for row in findings}
    assert not severities & {("safe", "critical"), ("safe", "major")}
    assert severities >= {("near-miss", "critical"), ("collision", "critical")}


@pytest.mark.slow
def test_the_printed_command_gives_the_nine_verdicts_at_both_speeds(tmp_path: Path) -> None:
    words = printed_command(tmp_path)
    checked = run([*PROGRAM, *words, *(word for name in PROFILES for word in ("--profile", name))], tmp_path)
    assert checked.returncode == 1, checked.stderr
    out = Path(words[words.index("--out") + 1])
    found: dict[str, dict[str, str]] = {}
    profiles = load_profiles()
    for row in pq.read_table(tmp_path / out / "verdicts.parquet").to_pylist():
        if row["rule_id"] == "ukhc.r162.safe-distance-ahead":
            name = row["drive_id"].rpartition("-")[0]
            found.setdefault(name, {})[row["profile"]] = row["verdict"]
            v = 25 * MPH if name.endswith("-25mph") else PAPER_SPEED_MPS
            assert row["observed"] == pytest.approx(distance_ahead_m(name.removesuffix("-25mph"), v), abs=0.01)
            assert row["required"] == pytest.approx(safe_distance_ahead_m(profiles[row["profile"]], v), abs=0.01)
    assert found == TABLE_1 | {f"{name}-25mph": verdicts for name, verdicts in TABLE_1.items()}


def test_the_folder_is_an_argument_or_an_option(tmp_path: Path) -> None:
    invoke = partial(CliRunner().invoke, cli.app)
    for words in (["demo", "one"], ["demo", "--out", "one"], ["demo", "one", "--out", "one"], ["demo"]):
        (folder := tmp_path / str(len(list(tmp_path.iterdir())))).mkdir()
        with chdir(folder):
            done = invoke(words)
        assert done.exit_code == 0, words
        (written,) = folder.iterdir()
        assert written.name == ("one" if "one" in words else "demo")
        assert done.stdout.rstrip().endswith(f"--out {written.name}/results")
    refused = invoke(["demo", "one", "--out", "two"])
    assert isinstance(refused.exception, UsageError)
    assert str(refused.exception) == "one and --out two: name one folder"


def test_an_earlier_demo_is_written_over(tmp_path: Path) -> None:
    first = {path.name: path.read_bytes() for path in demo_files.write(tmp_path)}
    road = tmp_path / demo_files.ROAD_FILE
    road.write_text(road.read_text(encoding="utf-8").replace("30", "20"), encoding="utf-8")
    assert {path.name: path.read_bytes() for path in demo_files.write(tmp_path)} == first


@pytest.mark.parametrize("foreign", [b"", b"mine", b"\x89MCAP0\r\n" + bytes(2000) + b"drivelint demo"])
def test_somebody_elses_file_stays_and_nothing_is_written(tmp_path: Path, foreign: bytes) -> None:
    mine = tmp_path / "near-miss.mcap"
    mine.write_bytes(foreign)
    with pytest.raises(UsageError, match=r"near-miss\.mcap was not written by this demo"):
        demo_files.write(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [mine.name]
    assert mine.read_bytes() == foreign


def test_a_folder_or_a_dangling_link_of_that_name_stays(tmp_path: Path) -> None:
    (tmp_path / "one" / "safe.mcap").mkdir(parents=True)
    (tmp_path / "two").mkdir()
    (tmp_path / "two" / "safe.mcap").symlink_to(tmp_path / "nowhere")
    for name in ("one", "two"):
        with pytest.raises(UsageError, match=r"safe\.mcap was not written"):
            demo_files.write(tmp_path / name)


def test_the_next_command_names_the_program_as_it_was_called_where_it_is_on_no_path(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("PATH", "")
    assert demo_files.check_command(Path("demo"), ".venv/bin/drivelint").startswith(
        ".venv/bin/drivelint check demo/*.mcap "
    )
    assert demo_files.check_command(Path("demo"), "/x/pytest").startswith("drivelint check ")
    assert demo_files.check_command(Path("my demo")).endswith("--out 'my demo'/results")
