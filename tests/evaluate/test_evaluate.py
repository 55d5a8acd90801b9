"""What holds for every rule and subject: nobody without a verdict, errors kept apart, parameters, places, ids."""

from __future__ import annotations

from typing import TYPE_CHECKING

import duckdb
import pytest

from drivelint.casefile.scene import insert_rows
from drivelint.catalogue import Rule
from drivelint.errors import UsageError
from drivelint.evaluate import evaluate, query_plans
from drivelint.evaluate.evaluation import Evaluation
from drivelint.sql import store
from tests.evaluate.packs import EXECUTION, INVARIANT, MEASURE, write

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

SPEED = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, $limit AS required FROM ego_state"
PARAM = '[params.limit]\ndefault = 10\nunit = "m/s"\nwhy = "a test"'
READS = {"reads": '["ego_state"]'}


@pytest.fixture
def con() -> Iterator[duckdb.DuckDBPyConnection]:
    with store.connect() as con:
        for drive, ego in (("a", "1"), ("a", "2"), ("b", "1")):
            who = {"drive_id": drive, "ego_id": ego}
            insert_rows(con, "clock", [who | {"period_ns": 10, "max_gap_ns": 25, "t_start_ns": 0, "t_end_ns": 20}])
            insert_rows(con, "step", [who | {"t_ns": k * 10, "k": k, "seg": 0} for k in range(3)])
            insert_rows(
                con,
                "ego_state",
                [
                    who
                    | {
                        "t_ns": k * 10,
                        "speed_mps": 12.0 if drive == "a" else 8.0,
                        "x_m": 1.5,
                        "y_m": 2.5,
                        "lanelet_id": "l",
                    }
                    for k in range(3)
                ],
            )
            insert_rows(con, "ego_condition", [who | {"t_ns": k * 10, "engaged": True} for k in range(3)])
            insert_rows(con, "capability", [who | {"signal": "map", "available": drive == "a", "reason": "because"}])
        for drive in "ab":
            insert_rows(con, "data_log", [{"drive_id": drive, "sha256": f"hash-{drive}"}])
        yield con


def rules(tmp_path: Path) -> list[Rule]:
    header = INVARIANT | MEASURE | READS
    events = EXECUTION | MEASURE | {"reads": '["ego_state", "exit_taken"]'}
    reference = "SELECT drive_id, ego_id, t_ns FROM exit_taken"
    broken = SPEED.replace("speed_mps", "lanelet_id::DOUBLE")
    return [
        write(tmp_path, header, {"condition": SPEED}, name="speed", tables=PARAM),
        write(tmp_path, header | {"requires": '["map", "mode_horn"]'}, {"condition": SPEED}, name="moon", tables=PARAM),
        write(tmp_path, header | {"requires": '["map"]'}, {"condition": SPEED}, name="map", tables=PARAM),
        write(tmp_path, header, {"condition": broken}, name="broken", tables=PARAM),
        write(tmp_path, events, {"reference": reference, "condition": SPEED}, name="never", tables=PARAM),
    ]


def test_every_subject_has_a_verdict_of_every_rule(con: duckdb.DuckDBPyConnection, tmp_path: Path) -> None:
    evaluate(con, rules(tmp_path))
    rows = con.execute("SELECT rule_id, drive_id, ego_id, verdict, reason_code FROM verdict ORDER BY ALL").fetchall()
    subjects = [("a", "1"), ("a", "2"), ("b", "1")]
    expected = {
        "broken": dict.fromkeys(subjects, ("error", "rule_error")),
        "map": {s: ("pass", "kept") if s[0] == "a" else ("unknown", "missing_map") for s in subjects},
        "moon": {s: ("unknown", "missing_mode_horn") if s[0] == "a" else ("unknown", "missing_map") for s in subjects},
        "never": dict.fromkeys(subjects, ("not_applicable", "not_triggered")),
        "speed": {s: ("pass", "kept") if s[0] == "a" else ("fail", "violated") for s in subjects},
    }
    assert rows == [(f"pack.{rule}", *s, *expected[rule][s]) for rule in expected for s in subjects]


def test_verdicts_are_appended_and_nothing_is_left_behind(con: duckdb.DuckDBPyConnection, tmp_path: Path) -> None:
    before = con.execute("SELECT table_name FROM duckdb_tables() ORDER BY ALL").fetchall()
    chosen = rules(tmp_path)
    evaluate(con, chosen[:1])
    evaluate(con, chosen[1:2])
    evaluate(con, [])
    assert con.execute("SELECT rule_id, count(*) FROM verdict GROUP BY ALL ORDER BY ALL").fetchall() == [
        ("pack.moon", 3),
        ("pack.speed", 3),
    ]
    assert con.execute("SELECT table_name FROM duckdb_tables() ORDER BY ALL").fetchall() == before


@pytest.mark.parametrize("most_rows", [0, 1_000_000], ids=["rule by rule", "at once"])
def test_where_outcomes_of_several_rules_fail_each_rule_is_judged_alone(
    con: duckdb.DuckDBPyConnection, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, most_rows: int
) -> None:
    packs = rules(tmp_path)
    query = "SELECT * FROM verdict ORDER BY ALL"
    evaluate(con, packs)
    usual = con.execute(query).fetchall()
    con.execute("DELETE FROM verdict; DELETE FROM finding")
    aggregate_pending_steps, sizes = Evaluation.aggregate_pending_steps, []

    def fail(self: Evaluation) -> None:
        sizes.append(len(self._pending))
        if len(self._pending) > 1 or self._pending[0].rule.id.endswith("map"):
            self.con.execute("SELECT 9_223_372_036_854_775_807 + n FROM range(1, 2) t(n)")
        aggregate_pending_steps(self)

    monkeypatch.setattr(Evaluation, "aggregate_pending_steps", fail)
    monkeypatch.setattr("drivelint.evaluate.evaluation.MOST_PENDING_ROWS", most_rows)
    evaluate(con, packs)
    found = con.execute(query).fetchall()
    assert (max(sizes) > 1) == (most_rows > 0)
    kept, new = ([row for row in rows if not row[2].endswith("map")] for rows in (usual, found))
    assert new == kept
    blamed = con.execute(
        "SELECT DISTINCT verdict, reason_code FROM verdict WHERE rule_id LIKE '%map' AND drive_id = 'a'"
    ).fetchall()
    assert blamed == [("error", "rule_error")]


def test_parameters_override_the_default(con: duckdb.DuckDBPyConnection, tmp_path: Path) -> None:
    speed = rules(tmp_path)[0]
    evaluate(con, [speed], {"pack.speed": {"limit": 5.0}})
    assert con.execute("SELECT DISTINCT verdict, required FROM verdict").fetchall() == [("pass", 5.0)]
    with pytest.raises(UsageError, match="has no parameter 'limt'; it has: limit"):
        evaluate(con, [speed], {"pack.speed": {"limt": 5.0}})
    with pytest.raises(UsageError, match=r"'pack\.other', which is not among the selected rules"):
        evaluate(con, [speed], {"pack.other": {}})


def test_rows_carry_place_and_stable_ids(con: duckdb.DuckDBPyConnection, tmp_path: Path) -> None:
    chosen = rules(tmp_path)
    evaluate(con, chosen)
    assert con.execute("SELECT DISTINCT x_m, y_m, lanelet_id FROM verdict WHERE verdict = 'fail'").fetchall() == [
        (1.5, 2.5, "l")
    ]
    assert con.execute("SELECT DISTINCT rule_version FROM verdict WHERE rule_id = 'pack.speed'").fetchall() == [
        (chosen[0].version,)
    ]
    ((first,),) = con.execute("SELECT finding_id FROM finding WHERE rule_id = 'pack.speed'").fetchall()
    con.execute("DELETE FROM finding")
    evaluate(con, chosen[:1], {"pack.speed": {"limit": 11.0}})
    assert con.execute("SELECT finding_id FROM finding").fetchall() == [(first,)], "no floats in a finding's id"
    con.execute("DELETE FROM finding")
    con.execute("UPDATE data_log SET sha256 = 'other' WHERE drive_id = 'b'")
    evaluate(con, chosen[:1])
    assert con.execute("SELECT finding_id FROM finding").fetchall() != [(first,)], "another log, another finding"


def test_findings_of_two_egos_have_two_ids(con: duckdb.DuckDBPyConnection, tmp_path: Path) -> None:
    evaluate(con, rules(tmp_path)[:1], {"pack.speed": {"limit": 13.0}})
    assert con.execute("SELECT count(*), count(DISTINCT finding_id) FROM finding").fetchall() == [(3, 3)]


@pytest.mark.ci
def test_explain_shows_a_plan_that_joins_by_nested_loops(con: duckdb.DuckDBPyConnection, tmp_path: Path) -> None:
    """The guard of the catalogue can fail: a residual that is no comparison in an outer join."""
    sql = SPEED.replace("FROM ego_state", "FROM ego_state e LEFT JOIN pair p USING (drive_id, ego_id)").replace(
        "drive_id, ego_id, t_ns, speed", "e.drive_id, e.ego_id, e.t_ns, e.speed"
    )
    bad = sql.replace(
        "USING (drive_id, ego_id)", "ON p.drive_id = e.drive_id AND (p.object_id IS NULL OR p.t_ns = e.t_ns)"
    )
    header = INVARIANT | MEASURE | {"reads": '["ego_state", "pair"]'}
    plans = {
        name: "".join(query_plans(con, write(tmp_path, header, {"condition": text}, name=name, tables=PARAM)))
        for name, text in (("good", sql), ("bad", bad))
    }
    assert "BLOCKWISE_NL" not in plans["good"]
    assert "BLOCKWISE_NL" in plans["bad"]
