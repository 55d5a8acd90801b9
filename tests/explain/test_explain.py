"""Explanations of a failing, an unknown and a passing verdict, from the log and from a kept database."""

from __future__ import annotations

import json
import math
import re
import shutil
from functools import cache
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from rich.console import Console

from drivelint.errors import UsageError
from drivelint.explain import ExplainRequest, Explanation, MeasurementErrors, VerdictFilter, explain
from drivelint.explain.target import _complete_name, _other_verdicts
from drivelint.explain.text import _sentence_with_rounded_numbers, render, to_json
from drivelint.result.text import seconds
from tests.explain.overtake_check import OVERTAKE, RULES, check
from tests.scene_drives import scene_drive
from tests.shared_data import ROOT

NO_COPIES = MeasurementErrors(samples=0)
SAFE = (str(OVERTAKE / "safe.csv"),)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("explained")
    check(out, robustness=False)  # an explanation judges its own copies
    return out


@cache  # several tests look at one explanation; no result is written anew into its folder
def of(folder: Path, name: str, *, errors: MeasurementErrors = NO_COPIES, **filters: Any) -> Explanation:
    return explain(ExplainRequest(name, folder, VerdictFilter(**filters), errors=errors))


def printed_text(explanation: Explanation, width: int = 100) -> str:
    console = Console(width=width, highlight=False)
    with console.capture() as captured:
        console.print(render(explanation, width))
    return captured.get()


def flat(text: str) -> str:
    return re.sub(r"\s+", " ", text)


def test_a_failed_verdict_says_what_why_and_what_would_change_it(folder: Path) -> None:
    found = of(folder, "r162.safe@near_miss", profile="nominal")
    assert found.verdict["verdict"] == found.verdict["judged_anew"] == "fail"
    text = flat(printed_text(found))
    assert "FAIL: the rule was broken" in text
    assert re.sub(r"(\d+\.\d\d)\d+ ", lambda m: f"{float(m[0]):.2f} ", found.verdict["reason"]) in text
    assert "UKHC R162" in text
    assert "It was judged at one moment only." in text
    assert [rows.table for rows in found.rows] == ["overtake", "overtake_sda", "profile"]
    (sda,) = found.rows[1].rows
    assert (sda["da_m"], sda["sda_m"]) == pytest.approx(
        (found.verdict["observed"], found.verdict["required"]), abs=1e-9
    )
    assert found.decides_ns == found.verdict["t_ref_ns"]


@pytest.mark.ci
def test_the_header_names_the_first_step_at_which_the_rule_is_broken(folder: Path) -> None:
    found = of(folder, "contact-signature@collision")
    first = next(step.t_ns for step in found.series if step.holds is False)
    assert f"first broken at {seconds(first, found.drive['t_start_ns'])}" in flat(printed_text(found))
    assert "first broken" not in printed_text(of(folder, "no-collision@safe"))


def test_a_requirement_is_taken_apart(folder: Path) -> None:
    found = of(folder, "r162.safe@near_miss", profile="nominal")
    assert math.isclose(sum(part.value for part in found.parts), found.verdict["required"], rel_tol=1e-9)
    assert [part.name for part in found.parts] == ["pull_out_m", "passing_m", "cut_in_m", "oncoming_m", "stopping_m"]
    told = " + ".join(f"{part.description} {part.value:.2f} m" for part in found.parts)
    assert f"{found.verdict['required']:.2f} m = {told}." in flat(printed_text(found))
    assert of(folder, "no-collision@safe").parts == []


def test_the_conclusion_stands_first_and_the_sql_last(folder: Path) -> None:
    text = printed_text(of(folder, "r162.safe@near_miss", profile="nominal"))
    headings = [line for line in text.splitlines() if line and line[0].isupper()]
    assert headings[0].startswith("FAIL")
    assert headings[1] == "What happened"
    assert headings[-1] == "How it was judged"
    assert "SELECT" in text[text.index("How it was judged") :]
    assert "SELECT" not in text[: text.index("How it was judged")]


def test_a_value_that_is_nearly_nothing_keeps_its_digits() -> None:
    told = _sentence_with_rounded_numbers(
        "Distance 0.00421 m at 7.700 s, object 3.1234 where more than -1.23456 m/s2 is required"
    )
    assert told == "Distance 0.0042 m at 7.70 s, object 3.1234 where more than -1.23 m/s2 is required"


@pytest.mark.slow
def test_the_change_that_is_named_changes_the_verdict_and_a_smaller_one_does_not(folder: Path, tmp_path: Path) -> None:
    found = of(folder, "r162.safe@near_miss", profile="nominal")
    change = next(c for c in found.changes if c.name == "nominal.pull_out_headroom_m")
    assert change.becomes == "pass"
    assert change.nearest_value is not None
    assert 0 < change.nearest_value < change.now
    rules = tmp_path / "mine"
    for value, expected in (
        (change.nearest_value, "pass"),
        (change.now - 0.9 * (change.now - change.nearest_value), "fail"),
    ):
        (rules / "pack").mkdir(parents=True, exist_ok=True)
        (rules / "pack" / "x.sql").write_text((ROOT / "queries/assertions/ukhc/no-collision.sql").read_text())
        (rules / "profiles.toml").write_text(
            "[nominal]\nstyle = 1\npull_out_angle_deg = 20.0\ncut_in_angle_deg = 20.0\n"
            f"pull_out_headroom_m = {value}\ncut_in_clearance_m = 4.65\nv_min_mps = 0.0\nv_max_mps = 31.3\n"
        )
        result = check(
            tmp_path / "out", traces=(str(OVERTAKE / "near_miss.csv"),), rules=(RULES[0],), profiles=("nominal",), params=(),
            rules_dirs=(rules,), robustness=False,
        )  # fmt: skip
        assert result.verdicts["verdict"].to_pylist() == [expected]


@pytest.mark.slow
def test_parameters_are_those_of_the_run_and_change_as_said(folder: Path, tmp_path: Path) -> None:
    found = of(folder, "contact-signature@collision")
    assert {p["name"]: p["value"] for p in found.params}["within_m"] == 0.4
    assert "$within_m" not in " ".join(found.sql.values())
    assert "0.4" in found.sql["condition"] + found.sql.get("applies", "")
    change = next(c for c in found.changes if c.name == "tyre_mps2")
    assert change.becomes == "pass"
    assert change.beyond
    assert change.nearest_value is not None
    assert change.nearest_value > found.verdict["observed"]
    assert change.nearest_value < 1.1 * found.verdict["observed"]
    assert f"tyre_mps2 >= {change.nearest_value:g} m/s2 it would pass" in flat(printed_text(found))
    for value, expected in (
        (change.nearest_value, {"pass", "not_applicable"}),
        (0.95 * found.verdict["observed"], {"fail"}),
    ):
        result = check(
            tmp_path, traces=(str(OVERTAKE / "collision.csv"),), rules=(RULES[1],),
            params=("ukhc.contact-signature.within_m=0.4", f"ukhc.contact-signature.tyre_mps2={value}"),
        )  # fmt: skip
        assert {
            row["verdict"] for row in result.verdicts.to_pylist() if row["object_id"] == found.verdict["object_id"]
        } <= expected


@pytest.mark.slow
def test_a_finding_is_found_by_the_beginning_of_its_id(folder: Path) -> None:
    found = of(folder, "r126.ds-av-out-of-ov@collision")
    ids = {row["finding_id"]: row for row in _findings(folder)}
    mine = next(
        i
        for i, row in ids.items()
        if row["rule_id"] == "ukhc.r126.ds-av-out-of-ov" and row["drive_id"].startswith("collision")
    )
    same = of(folder, mine[:9])
    assert same.verdict["finding_id"] == mine
    assert same.verdict["drive_id"] == found.verdict["drive_id"]
    assert same.verdict["margin"] == ids[mine]["margin"]
    assert mine in printed_text(same)


def _findings(folder: Path) -> list[dict[str, Any]]:
    return list(pq.read_table(folder / "findings.parquet").to_pylist())


@pytest.mark.ci
def test_the_margin_over_time_has_every_step(folder: Path) -> None:
    found = of(folder, "r126.ds-av-out-of-ov@near_miss")
    assert len(found.series) == found.verdict["n_expected"]
    assert min(step.margin for step in found.series if step.margin is not None) == found.verdict["margin"]
    assert {step.holds for step in found.series} == {True, False}
    text = printed_text(found)
    assert "limit┼" in text
    assert "The rule has no numeric parameter" in flat(text)


def test_a_passing_verdict(folder: Path) -> None:
    found = of(folder, "no-collision@safe")
    assert found.verdict["verdict"] == "pass"
    text = flat(printed_text(found))
    assert "PASS: the rule was kept" in text
    assert (
        f"With the same limit, the rule would be broken if distance between the two were {found.verdict['margin']:.2f} m less."
        in text
    )


def test_an_unknown_verdict_for_want_of_a_signal(folder: Path) -> None:
    found = of(folder, "r112.horn@safe", errors=MeasurementErrors(samples=5))
    text = flat(printed_text(found))
    assert "UNKNOWN: it is not known whether the rule was kept: this is not a pass" in text
    assert "no parameter changes that" in text
    assert found.sensitivity is None
    assert found.changes == []
    (table,) = found.rows
    assert (table.table, table.rows[0]["available"]) == ("capability", False)
    assert table.rows[0]["reason"] in text
    assert "What would decide it" in printed_text(found)
    assert "When horn is on, as declared events horn with the values on and off" in text
    assert "How it was judged The rule was not run: the log or the map lacks a signal that it requires." in text
    assert "SELECT" not in text


def test_a_rule_that_did_not_run_as_the_log_lacks_its_signal(tmp_path: Path) -> None:
    check(tmp_path / "out", traces=SAFE, rules=("ukhc.r112*",), params=())
    found = of(tmp_path / "out", "r112.horn@safe")
    assert (found.verdict["verdict"], found.verdict["reason_code"]) == ("not_applicable", "unrecorded_mode_horn")
    assert (found.sensitivity, found.changes, [table.table for table in found.rows]) == (None, [], ["capability"])
    text = flat(printed_text(found))
    assert "NOT APPLICABLE: the log does not contain a signal that the rule needs" in text
    assert "What would decide it When horn is on, as declared events horn with the values on and off" in text
    assert "The rule reads the event horn (value: on, off)" in text
    assert "The rule was not run: the log or the map lacks a signal that it requires." in text


@pytest.mark.slow
def test_an_unknown_condition_is_shown_with_the_place_of_the_ego(tmp_path: Path) -> None:
    rule = tmp_path / "packs" / "mine" / "wet.sql"
    rule.parent.mkdir(parents=True)
    text = (ROOT / "queries/assertions/ukhc/no-collision.sql").read_text(encoding="utf-8")
    head, requires, rest = text.partition("-- requires")
    line, _, body = rest.partition("\n")
    rule.write_text(f'{head}{requires}{line}\n--\n-- [applies]\n-- weather = ["wet"]\n{body}', encoding="utf-8")
    check(tmp_path / "out", traces=SAFE, rules=("mine.wet",), rules_dirs=(tmp_path / "packs",), params=())
    found = of(tmp_path / "out", "mine.wet@safe")
    assert found.verdict["reason_code"] == "weather_unknown"
    condition, state = found.rows[:2]
    assert (condition.table, state.table) == ("ego_condition", "ego_state")
    assert (len(condition.rows), condition.rows[0]["weather"], len(state.rows)) == (1, None, 1)
    shown = printed_text(found)
    assert re.search(r"ego_condition:(?:\n   .*)*\n +weather +NULL", shown)
    assert re.search(rf"ego_state:(?:\n   .*)*\n +lanelet_id +{re.escape(state.rows[0]['lanelet_id'])}", shown)


@pytest.mark.slow
def test_an_unknown_step_is_the_one_that_decides(tmp_path: Path) -> None:
    """The oncoming car has no place for two seconds, long enough to have been anywhere: there the margin is not known."""
    lines = (OVERTAKE / "near_miss.csv").read_text(encoding="utf-8").splitlines()
    head = lines[0].split(",")
    x, who, at = head.index("x_m"), head.index("actor"), head.index("time_s")
    rows = [line.split(",") for line in lines[1:]]
    ov = next(row[who] for row in rows if row[who] not in {"ego", rows[1][who]})
    for row in rows:
        if row[who] == ov and 8.0 <= float(row[at]) < 10.0:
            row[x] = ""
    log = tmp_path / "blind.csv"
    log.write_text("\n".join([lines[0], *(",".join(row) for row in rows)]) + "\n", encoding="utf-8")
    check(tmp_path / "out", traces=(str(log),), rules=("ukhc.no-collision",), params=())
    found = of(tmp_path / "out", "no-collision", object_id=ov)
    assert found.verdict["verdict"] == "unknown"
    # 56.4 m apart when last seen at 7.9 s: at 60 m/s they may have met by 8.84 s
    assert found.decides_ns == 8_900_000_000
    pair = next(rows for rows in found.rows if rows.table == "pair")
    assert pair.rows[0]["clearance_m"] is None
    text = printed_text(found)
    assert re.search(r"clearance_m\s+NULL", text)
    words = (
        "Object oncoming has no position, or only an outdated one: record it. This is for the first of 6 unknown steps"
    )
    assert words in flat(text)
    assert "?" in text[text.index("Margin over time") :]


@pytest.mark.ci
def test_an_unknown_names_the_section_and_the_column_without_a_value(tmp_path: Path) -> None:
    traces = (str(OVERTAKE / "collision.csv"),)
    check(tmp_path, traces=traces, rules=("ukhc.r128.back-before-solid",), profiles=("nominal",), params=())
    text = printed_text(of(tmp_path, "r128.back@collision"), 500)
    decides = text[text.index("What would decide it") :]
    assert "The SELECT below that gives no value: @anchor." in decides
    assert "NULL in overtake (queries/library/overtakes/overtake.sql): t3_ns." in decides
    anchor = decides[decides.index("-- @anchor") : decides.index("-- @condition")].splitlines()
    (at,) = (no for no, line in enumerate(anchor) if "-- NULL here: " in line)
    assert anchor[at].strip() == "-- NULL here: t3_ns", "the line is too long for a note at its end"
    assert "t3_ns" in anchor[at - 2] + anchor[at - 1]


@pytest.mark.ci
def test_an_unknown_names_the_column_that_tells_that_something_is_not_known(tmp_path: Path) -> None:
    """A person is lost beside the crossing; that the map states no kind of it is not the reason."""
    scene_drive("crossings", "zebra-walker-lost", tmp_path / "lost")
    over = {"map": None, "mapping": None, "profiles": ("nominal",), "params": ()}
    check(tmp_path / "out", traces=(str(tmp_path / "lost"),), rules=("ukhc.r195.zebra-on",), **over)
    text = printed_text(of(tmp_path / "out", "zebra-on"), 500)
    decides = text[text.index("What would decide it") :]
    assert "no in crossing_passage (queries/library/junctions/crossing_passage.sql): known." in decides
    assert "WHEN NOT known THEN why('person_unplaced')  -- no here: known" in decides


def test_other_verdicts_of_the_rule_are_told_worst_first() -> None:
    row = {
        "drive_id": "d",
        "rule_id": "a.b",
        "ego_id": "e",
        "profile": None,
        "t_start_ns": 0,
        "occurrence": 0,
        "margin": None,
    }
    verdicts = [{**row, "object_id": verdict, "verdict": verdict} for verdict in ("pass", "unknown", "fail", "error")]
    others = _other_verdicts(verdicts[0], verdicts)
    assert [other["verdict"] for other in others] == ["error", "fail", "unknown"]


@pytest.mark.slow
def test_a_track_whose_end_was_left_out_is_told(tmp_path: Path) -> None:
    """A simulator takes the two others out of the scene and writes them on, both in one place."""
    head, *lines = (OVERTAKE / "near_miss.csv").read_text(encoding="utf-8").splitlines()
    at = {name: i for i, name in enumerate(head.split(","))}
    rows = [line.split(",") for line in lines]
    for row in rows:
        if row[at["actor"]] != "ego" and float(row[at["time_s"]]) >= 7.0:
            row[at["x_m"]], row[at["y_m"]], row[at["vx_mps"]] = "0", "500", "0"
    log = tmp_path / "removed.csv"
    log.write_text("\n".join([head, *(",".join(row) for row in rows)]) + "\n", encoding="utf-8")
    check(tmp_path / "out", traces=(str(log),), rules=("ukhc.no-collision",), params=())
    found = of(tmp_path / "out", "no-collision", object_id="parked")
    assert found.verdict["reason_code"] == "lost_near_ego"
    assert "drivelint removed the ends of tracks; a longer recording would not change this" in flat(printed_text(found))
    assert "(oncoming, parked): after a jump, several actors stand at the same position" in flat(printed_text(found))


@pytest.mark.slow
def test_an_object_whose_track_has_ended_is_shown_where_it_was_last(tmp_path: Path) -> None:
    head, *lines = (OVERTAKE / "near_miss.csv").read_text(encoding="utf-8").splitlines()
    at = {name: i for i, name in enumerate(head.split(","))}
    rows = [line.split(",") for line in lines]
    kept = [row for row in rows if row[at["actor"]] != "parked" or float(row[at["time_s"]]) < 7.0]
    log = tmp_path / "short.csv"
    log.write_text("\n".join([head, *(",".join(row) for row in kept)]) + "\n", encoding="utf-8")
    check(tmp_path / "out", traces=(str(log),), rules=(RULES[1],), params=())
    found = of(tmp_path / "out", "contact-signature", object_id="parked")
    assert found.verdict["verdict"] == "unknown"
    assert found.decides_ns == 7_000_000_000
    (pair,) = [rows for rows in found.rows if rows.table == "pair"]
    assert [row["t_ns"] for row in pair.rows] == [pair.at_ns] == [6_900_000_000]
    assert "pair at 6.90 s (object parked has no row then; this is its last one before):" in flat(printed_text(found))


@pytest.mark.slow
def test_small_errors_are_counted_and_the_same_seed_draws_the_same(folder: Path) -> None:
    errors = MeasurementErrors(position_m=0.6, time_s=0.2, map_m=0.1, samples=20, seed=3)
    order = ExplainRequest("r126.ds-av-out-of-ov@near_miss", folder, VerdictFilter(), errors=errors)
    first, again = (explain(order).sensitivity for _ in range(2))
    assert first is not None
    assert first == again
    assert sum(first.counts.values()) == 20
    assert len(first.counts) > 1  # 0.98 m inside with errors of 0.6 m in both positions: not always
    others = [
        of(folder, "r126.ds-av-out-of-ov@near_miss", errors=MeasurementErrors(0.6, 0.2, 0.1, 20, seed)).sensitivity
        for seed in (4, 5, 6)
    ]
    assert any(other is not None and other.counts != first.counts for other in others)


@pytest.mark.slow
@pytest.mark.parametrize(("n_stays", "certainty"), [(97, "Sure"), (53, "Only possible")])
def test_the_copies_that_check_judged_are_not_judged_again(tmp_path: Path, n_stays: int, certainty: str) -> None:
    check(tmp_path, traces=(str(OVERTAKE / "collision.csv"),), rules=("ukhc.no-collision",), params=())
    file = tmp_path / "findings.parquet"
    written = pq.read_table(file)
    for name, value in (("n_copies", 100), ("n_stays", n_stays)):
        at = written.schema.get_field_index(name)
        values = pa.array([value] * written.num_rows, written.schema.field(at).type)
        written = written.set_column(at, written.schema.field(at), values)
    pq.write_table(written, file)
    (tmp_path / "files.json").unlink()  # its hashes would tell of the change
    for name in ("no-collision", written["finding_id"][0].as_py()):
        found = explain(ExplainRequest(name, tmp_path))
        assert found.sensitivity is not None
        assert (found.sensitivity.counts, found.sensitivity.samples) == ({"fail": n_stays}, 100)
        words = f"{certainty}: drivelint check judged 100 copies of the drive with assumed errors, and {n_stays} of them have this finding"
        assert words in flat(printed_text(found))
        assert "0.1 m in every actor's position, 0.05 s in its clock, 0.1 m in the position of the map" in flat(
            printed_text(found)
        )
    other = explain(ExplainRequest("no-collision", tmp_path, errors=MeasurementErrors(samples=2))).sensitivity
    assert other is not None
    assert (other.samples, other.certainty) == (2, None)


@pytest.mark.slow
def test_without_errors_every_copy_is_the_drive(folder: Path) -> None:
    for name in ("no-collision@safe", "r126.ds-av-out-of-ov@near_miss"):
        found = of(folder, name, errors=MeasurementErrors(0.0, 0.0, 0.0, 3))
        assert found.sensitivity is not None
        assert found.sensitivity.counts == {found.verdict["verdict"]: 3}
        assert re.search(r"(Fails|Passes) in 3 of 3", printed_text(found))


@pytest.mark.slow
def test_the_kept_database_says_the_same_as_the_log(folder: Path, tmp_path: Path) -> None:
    check(tmp_path, keep_db=True)
    errors = MeasurementErrors(1.0, 0.1, 0.1, 5)
    for name in ("contact-signature@collision", "r126.ds-av-out-of-ov@near_miss"):
        read, kept = (of(where, name, errors=errors) for where in (folder, tmp_path))
        assert "read again" in read.source
        assert "kept database" in kept.source
        for part in ("verdict", "rows", "series", "changes", "sensitivity", "decides_ns", "sql"):
            assert getattr(read, part) == getattr(kept, part), part


@pytest.mark.slow
def test_a_log_that_is_gone_is_asked_for_and_another_one_refused(tmp_path: Path) -> None:
    log = tmp_path / "drive.csv"
    shutil.copy(OVERTAKE / "near_miss.csv", log)
    check(tmp_path / "out", traces=(str(log),), rules=("ukhc.r126.ds-av-out-of-ov",), params=(), robustness=False)
    moved = log.rename(tmp_path / "moved.csv")
    with pytest.raises(UsageError, match="--trace"):
        of(tmp_path / "out", "r126.ds")
    found = explain(ExplainRequest("r126.ds", tmp_path / "out", trace=moved, errors=NO_COPIES))
    assert found.verdict["judged_anew"] == "fail"
    assert found.verdict["drive_id"].startswith("drive-")
    with pytest.raises(UsageError, match=r"but .* was judged: give the right log"):
        explain(ExplainRequest("r126.ds", tmp_path / "out", trace=OVERTAKE / "safe.csv", errors=NO_COPIES))


@pytest.mark.slow
def test_a_folder_that_moves_with_its_logs_still_finds_them(tmp_path: Path) -> None:
    shutil.copytree(OVERTAKE, tmp_path / "a" / "logs")
    logs = tmp_path / "a" / "logs"
    check(
        tmp_path / "a" / "out",
        traces=(str(logs / "near_miss.csv"),),
        map=logs / "road.xodr",
        mapping=str(logs / "mapping.toml"),
    )
    (tmp_path / "a").rename(tmp_path / "b")
    assert of(tmp_path / "b" / "out", "r126.ds").verdict["judged_anew"] == "fail"


@pytest.mark.slow
def test_a_rule_that_was_changed_is_said(tmp_path: Path) -> None:
    rule = tmp_path / "packs" / "mine" / "near.sql"
    rule.parent.mkdir(parents=True)
    text = (ROOT / "queries/assertions/ukhc/no-collision.sql").read_text(encoding="utf-8")
    rule.write_text(text, encoding="utf-8")
    check(tmp_path / "out", traces=SAFE, rules=("mine.near",), rules_dirs=(tmp_path / "packs",), params=())
    rule.write_text(text.replace("0.0 AS required", "2.0 AS required"), encoding="utf-8")
    found = of(tmp_path / "out", "mine.near@safe")
    assert found.verdict["verdict"] == "pass"
    assert found.verdict["judged_anew"] == "fail"
    assert "The rule has changed since" in flat(printed_text(found))
    assert "Judged again, the verdict is fail, but the result contains pass" in flat(printed_text(found))


@pytest.mark.slow
def test_json_has_it_all(folder: Path) -> None:
    plain = json.loads(to_json(of(folder, "r126.ds-av-out-of-ov@near_miss", errors=MeasurementErrors(samples=2))))
    assert plain["explain_schema"] == 1
    assert plain.keys() >= {
        "rule",
        "drive",
        "verdict",
        "sql",
        "params",
        "rows",
        "series",
        "changes",
        "sensitivity",
        "source",
    }
    assert len(plain["series"][0]) == 5
    assert plain["rows"][0]["table"] == "overtake_step"
    assert plain["sensitivity"]["counts"] == {"fail": 2}


def test_every_line_fits_a_narrow_terminal(folder: Path) -> None:
    text = printed_text(of(folder, "r126.ds-av-out-of-ov@near_miss"), 60)
    assert max(len(line) for line in text.splitlines()) <= 60


MISTAKES = [
    ("nonsense", {}, "no finding begins with 'nonsense'"),
    ("safe-distance-haed", {}, "did you mean"),
    ("ukhc.r162.safe-distance-ahead@unsafe", {}, "did you mean 'safe-"),
    ("no-collision", {"object_id": "9"}, "no verdict for object '9'"),
    ("r162.safe", {"profile": "aggressive"}, "there are nominal, relaxed"),
    ("no-collision", {"at_s": 1e6}, "includes 1e+06 s of the drive; its verdicts have the times"),
    ("no-collision", {"ego_id": "x"}, "no verdict for ego 'x'; there are ego"),
    ("no-collision", {"verdict": "unknown"}, "no verdict for verdict 'unknown'; there are fail, pass"),
    ("ukhc", {}, "the beginning of several rules"),
]


@pytest.mark.parametrize(("name", "filters", "message"), MISTAKES)
def test_mistakes_are_one_clear_line(folder: Path, name: str, filters: dict[str, Any], message: str) -> None:
    with pytest.raises(UsageError) as error:
        of(folder, name, **filters)
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_the_whole_name_of_a_log_goes_before_the_beginning_of_another() -> None:
    known = ["near-miss-25mph-54ec422b", "near-miss-e888ec04", "near-miss-25mph-slow-0a1b2c3d"]
    assert _complete_name("near-miss", known, "drive") == known[1]
    assert _complete_name("near-miss-25mph", known, "drive") == known[0]
    with pytest.raises(UsageError, match="the beginning of several drives"):
        _complete_name("near", known, "drive")


@pytest.mark.slow
def test_the_worst_verdict_is_meant_unless_one_is_asked_for(folder: Path) -> None:
    found = of(folder, "no-collision")
    assert found.verdict["drive_id"].startswith("collision")
    assert found.verdict["verdict"] == "fail"
    at = of(folder, "no-collision@safe", at_s=1.0)
    assert at.verdict["t_start_ns"] <= 1e9 <= at.verdict["t_end_ns"]
    assert of(folder, "no-collision", verdict="pass", ego_id="ego").verdict["verdict"] == "pass"


def test_a_folder_without_a_result(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no result of drivelint check"):
        of(tmp_path, "x")


@pytest.mark.slow
def test_a_long_drive_is_judged_in_part_where_the_verdict_is_the_same(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from drivelint.explain import verdict_context

    monkeypatch.setattr(verdict_context, "TRIED_CROP_MARGINS_NS", (1_000_000, 3_000_000_000))
    errors = MeasurementErrors(0.0, 0.0, 0.0, 2)
    found = of(folder, "contact-signature@collision", errors=errors)
    told = found.sensitivity
    assert told is not None
    assert told.from_ns is not None
    assert told.to_ns is not None
    start, end = found.verdict["t_start_ns"], found.verdict["t_end_ns"]
    assert told.from_ns >= start - 3_000_000_000
    assert told.to_ns <= end + 3_000_000_000
    assert told.counts == {"fail": 2}
    assert "copies of the drive, from" in flat(printed_text(found))
