"""The statements that Python runs by name: each is a whole, or part of one that is; none is forgotten; they are planned as hash joins."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import duckdb
import pytest

from drivelint.reasons.reason_table import make_reason_table
from drivelint.sql import store, syntax
from drivelint.sql.statements import statement, statement_texts
from tests.sql import selects

SOURCE = Path(__file__).resolve().parents[2] / "src" / "drivelint"
IN_ORDER = {
    "judging": "tables pending todo watched content grid_group error_of_steps "
    "error_of_measuring outcome_of_episodes outcome_of_holes outcome_of_references course_of_near_misses stretch course_of_stretches "
    "margin_of_steps blind closed no_cause cause named failed verdict finding margin course",
    "evidence": "every_moment moment around scene danger_space_edge near_lane lane lane_point overtake_record opportunity_record "
    "drive overtake_space chain_point",
    "inspect": "registration quality",
}
VALUES: dict[str, Any] = {
    "_objects": True, "per_rule": 1, "least_m": 1.0, "most_m": 1.0, "first_no": 0, "end_no": 1, "path_ns": 1, "step_ns": 1,
    "ids": ["a"], "only": None, "losses": [], "aside_check": "a",
}  # fmt: skip


def test_fragments_are_replaced_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "drivelint.sql.statements.statement_texts",
        lambda _part: {"x": "SELECT {'a': {value}}, format('{}', 1) -- {value}"},
    )
    assert statement("part/x", value="{value}") == "SELECT {'a': {value}}, format('{}', 1) -- {value}"
    with pytest.raises(KeyError, match="value"):
        statement("part/x")


@pytest.mark.parametrize("name", selects.fixed())
def test_a_fixed_statement_is_read(name: str) -> None:
    assert syntax.tables_read(syntax.parse_select(selects.fixed()[name], name))


def test_python_runs_every_statement() -> None:
    sources = "\n".join(file.read_text(encoding="utf-8") for file in SOURCE.rglob("*.py"))
    named = set(re.findall(r'"(?:\w+/)?(\w+)"', sources))
    assert {f"{part}/{name}" for part in selects.PARTS for name in statement_texts(part) if name not in named} == set()


def test_the_plans_join_on_keys() -> None:
    con = store.connect(threads=1)
    nested = set()
    for part, names in IN_ORDER.items():
        for name in names.split():
            if name == "verdict":
                make_reason_table(con, "SELECT NULL AS rule_no, NULL AS cause, NULL AS start_ns")
            for parsed in con.extract_statements(statement(f"{part}/{name}")):
                values = {key: VALUES[key] for key in parsed.named_parameters}
                if selects.select(parsed.query) and parsed.type != duckdb.StatementType.CREATE_FUNC:
                    (explained,) = con.extract_statements(f"EXPLAIN {parsed.query}")
                    if any("BLOCKWISE_NL" in plan for _, plan in con.execute(explained, values).fetchall()):
                        nested.add(f"{part}/{name}")
                con.execute(parsed, values)
    assert nested == set()


_COUNTED_ANEW = re.compile(r"count\(\*\)\s+FILTER\s*\((?:[^()]|\([^()]*\))*\)\s+OVER", re.IGNORECASE)


def test_no_filtered_count_of_rows_stands_over_a_window() -> None:
    """DuckDB counts the whole frame anew for each row: 32 s for a drive of 8 h. `count(CASE WHEN ... THEN 1 END)` takes a moment."""
    files = sorted((SOURCE.parents[1] / "queries").rglob("*.sql"))
    assert [file.name for file in files if _COUNTED_ANEW.search(file.read_text("utf-8"))] == []
    assert _COUNTED_ANEW.search("SELECT count(*) FILTER (NOT a AND (b OR c)) OVER w FROM t")
