"""A clip of a log, judged alone, gives the finding that it was cut for."""

from __future__ import annotations

import hashlib
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pytest

from drivelint import cli, demo
from drivelint.convert import ConvertRequest, summary_text
from drivelint.drive.time_span import cut_trace
from drivelint.drive.trace import ASSUMED_SIZE_CHECK, IngestOptions
from drivelint.errors import UsageError
from drivelint.formats import read_trace
from drivelint.incident import IncidentRequest, clip, judge_parties_again
from drivelint.incident.sheet import template_values
from drivelint.report.inputs import input_notes
from drivelint.report.outputs import write
from drivelint.report.progress import Silent
from drivelint.run import CheckOptions
from drivelint.run import check as run_check
from drivelint.sql.store import table_with_owner_id
from tests.explain.overtake_check import OVERTAKE
from tests.shared_data import shared

if TYPE_CHECKING:
    from drivelint.result.model import Result

MARGIN = 1e-6


def check_result(out: Path, *logs: Path, **options: Any) -> Result:
    result = run_check(
        CheckOptions(tuple(map(str, logs)), rules=("ukhc",), out=out, annotate=False, robustness=False, **options),
        Silent(),
    )
    write(result, out)
    return result


def findings(result: Result) -> list[dict[str, Any]]:
    return [dict(row) for row in result.findings.to_pylist()]


def judged_alone(path: Path, rule_id: str) -> list[dict[str, Any]]:
    """Return the findings of a rule in a clip, by a check as a user runs it: no map and no mapping is given."""
    return findings(run_check(CheckOptions((str(path),), rules=(rule_id,), robustness=False), Silent()))


def same(rows: list[dict[str, Any]], finding: dict[str, Any]) -> bool:
    keys = ("ego_id", "rule_id", "profile", "object_id", "t_worst_ns")
    return any(
        all(row[key] == finding[key] for key in keys)
        and (row["margin"] == finding["margin"] or abs(row["margin"] - finding["margin"]) < MARGIN)
        for row in rows
    )


def cut(log: Path, folder: Path, out: Path, finding: dict[str, Any], to: Literal["mcap", "parquet"] = "mcap") -> Path:
    return clip.write_clip(ConvertRequest(str(log), to, out), finding["finding_id"], folder, None).path


def worst_per_rule(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return list({row["rule_id"]: row for row in sorted(rows, key=lambda row: -(row["margin"] or 0))}.values())


@pytest.mark.slow
def test_demo_findings_come_again(tmp_path: Path) -> None:
    files = {path.name: path for path in demo.write(tmp_path / "demo")}
    log = files["collision-25mph.mcap"]
    result = check_result(tmp_path / "out", log, map=files["road.xodr"])
    rows = worst_per_rule([row for row in findings(result) if row["severity"] == "critical"])
    assert len(rows) >= 3
    for n, row in enumerate(rows):
        path = cut(log, tmp_path / "out", tmp_path / f"clip{n}", row)
        assert path.name == f"collision-25mph-clip-{row['finding_id'][:8]}.mcap"
        assert same(judged_alone(path, row["rule_id"]), row), row["rule_id"]


@pytest.mark.slow
@pytest.mark.parametrize("to", ["mcap", "parquet"])
def test_case_study_findings_come_again(tmp_path: Path, to: Literal["mcap", "parquet"]) -> None:
    log = shared("overtake_case_study/near_miss.csv")
    road = shared("overtake_case_study/t_junction.xodr")
    result = check_result(tmp_path / "out", log, map=road, mapping="carla-testbench")
    row = next(row for row in findings(result) if row["unit"] == "m/s2")  # the touch that no box shows
    path = cut(log, tmp_path / "out", tmp_path / "clip", row, to)
    assert same(judged_alone(path, row["rule_id"]), row)
    states = read_trace(path, IngestOptions()).tables["actor_state"]["t_ns"]
    length_s = (pc.max(states).as_py() - pc.min(states).as_py()) / 1e9
    whole_s = result.drives["duration_s"][0].as_py()
    assert length_s < whole_s
    assert pc.max(states).as_py() == row["t_end_ns"] + 7 * 10**9


@pytest.mark.slow
def test_more_is_taken_where_the_rule_needs_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An overtake that began before the clip is none: a span too short gives way to a longer one."""
    log, out = OVERTAKE / "near_miss.csv", tmp_path / "out"
    result = check_result(out, log, map=OVERTAKE / "road.xodr", mapping=str(OVERTAKE / "mapping.toml"))
    row = next(row for row in findings(result) if row["rule_id"].endswith("safe-distance-ahead"))
    spans = ((0, 0.1), (5, 5))
    monkeypatch.setattr(clip, "TRIED_PADDINGS_S", spans)
    written = clip.write_clip(ConvertRequest(str(log), "mcap", tmp_path / "clip"), row["finding_id"], out, None)
    assert "because 0 s and 0.1 s do not give it" in written.notes[-1]
    assert same(judged_alone(written.path, row["rule_id"]), row)


@pytest.mark.slow
def test_another_log_is_refused(folder: Path, tmp_path: Path) -> None:
    request = ConvertRequest(str(OVERTAKE / "safe.csv"), "mcap", tmp_path)
    with pytest.raises(UsageError, match="the log of the finding: give that log"):
        clip.write_clip(request, "no-collision@collision", folder, None)


def test_clip_and_result_belong_together(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    log = str(OVERTAKE / "safe.csv")
    monkeypatch.setattr(
        sys, "argv", ["drivelint", "convert", log, "--to", "mcap", "--out", str(tmp_path), "--clip", "x"]
    )
    with pytest.raises(SystemExit) as left:
        cli.main()
    assert left.value.code == 2
    assert "--clip and --in need each other" in capfd.readouterr().err


def test_what_holds_at_the_start_stays() -> None:
    """A light that turned red before the clip is red in it, and an automated driver that was switched on is on."""
    path = OVERTAKE / "safe.csv"
    trace = read_trace(path, IngestOptions(mapping=str(OVERTAKE / "mapping.toml")))
    signals = {
        "signal_id": ["a", "a", "a", "b"],
        "t_ns": [0, 10**9, 5 * 10**9, 0],
        "state": ["green", "red", "green", "red"],
    }
    events = {"t_ns": [0, 10**8], "actor_id": ["ego"] * 2, "event": ["engaged"] * 2, "value": ["off", "on"]}
    trace.tables["signal_state"] = table_with_owner_id("signal_state", trace.drive_id, signals, "test")
    trace.tables["declared_event"] = table_with_owner_id("declared_event", trace.drive_id, events, "test")
    log = trace.tables["data_log"]
    at = log.schema.get_field_index("utc_start_ns")
    trace.tables["data_log"] = log.set_column(at, log.schema.field(at), pa.array([10**18], pa.int64()))
    short = cut_trace(trace, 3 * 10**9, 6 * 10**9).tables
    assert short["signal_state"].select(["signal_id", "t_ns", "state"]).to_pylist() == [
        {"signal_id": "b", "t_ns": 0, "state": "red"},
        {"signal_id": "a", "t_ns": 10**9, "state": "red"},
        {"signal_id": "a", "t_ns": 5 * 10**9, "state": "green"},
    ]
    assert short["declared_event"]["value"].to_pylist() == ["on"]
    assert pc.min_max(short["actor_state"]["t_ns"]).as_py() == {"min": 3 * 10**9, "max": 6 * 10**9}
    (about,) = short["data_log"].to_pylist()
    assert about["utc_start_ns"] == 10**18 + 3 * 10**9  # the same moment, by its clock
    assert about["n_states"] == short["actor_state"].num_rows
    with pytest.raises(ValueError, match="no state"):
        cut_trace(trace, 10**15, 10**16)


@pytest.mark.ci
@pytest.mark.parametrize("to", ["mcap", "parquet"])
def test_a_clip_names_the_log_that_it_was_cut_from(
    folder: Path, tmp_path: Path, to: Literal["mcap", "parquet"]
) -> None:
    log = OVERTAKE / "collision.csv"
    written = clip.write_clip(ConvertRequest(str(log), to, tmp_path), "no-collision@collision", folder, None)
    rows = read_trace(written.path, IngestOptions()).tables["quality"].to_pylist()
    (said,) = [row for row in rows if row["check_id"] == "clip"]
    assert said["severity"] == "info"
    digest = hashlib.sha256(log.read_bytes()).hexdigest()
    assert re.fullmatch(
        rf"cut from collision\.csv, SHA-256 {digest}: [\d.]+ s to [\d.]+ s(, all)? of it", said["message"]
    )
    assert "--profile relaxed --profile nominal --out results" in summary_text(written)  # as that check had them
    (sizes,) = [row for row in rows if row["check_id"] == ASSUMED_SIZE_CHECK]
    assert sizes["message"] == "size from the mapping 'mapping', not recorded"


@pytest.mark.slow
def test_the_sheet_and_the_check_of_a_clip_say_what_the_log_s_say_of_sizes_and_frame(tmp_path: Path) -> None:
    log = shared("overtake_case_study/collision.csv")
    result = check_result(tmp_path / "log", log, map=shared("overtake_case_study/t_junction.xodr"))
    row = next(row for row in findings(result) if row["unit"] == "m/s2")
    again = check_result(tmp_path / "alone", cut(log, tmp_path / "log", tmp_path / "clip", row))
    (own,) = [each for each in findings(again) if each["unit"] == "m/s2"]
    told = [
        template_values(judge_parties_again(IncidentRequest(name["finding_id"], tmp_path / folder)))
        for name, folder in ((row, "log"), (own, "alone"))
    ]
    assert "sizes are assumed, not recorded" in told[0]["rests"] == told[1]["rests"]
    assert [[party["size_source"] for party in each["parties"]] for each in told] == [
        ["size from the mapping 'carla-testbench', not recorded"] * 2
    ] * 2
    lines = [next(note.words for note in input_notes(each) if note.label == "log") for each in (result, again)]
    # the clip's format has an end mark, the log's has none
    assert (
        "size from the mapping 'carla-testbench'"
        in lines[0].replace(", as far as the format .csv shows it", "")
        == lines[1]
    )
    assert (
        "y and heading changed in sign, because the frame of the log is left-handed according to the mapping 'carla-testbench'"
        in lines[0]
    )


@pytest.mark.ci
def test_the_same_clip_has_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    for out in ("a", "b"):
        request = ConvertRequest(str(OVERTAKE / "collision.csv"), "parquet", tmp_path / out)
        clip.write_clip(request, "no-collision@collision", folder, None)
    for file in sorted((tmp_path / "a").iterdir()):
        assert file.read_bytes() == (tmp_path / "b" / file.name).read_bytes()
    assert pq.read_table(tmp_path / "a" / "actor.parquet")["is_ego"].to_pylist().count(True) == 1
