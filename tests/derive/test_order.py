"""How derivations run: beside each other, each after what it reads; what fails is named."""

from __future__ import annotations

from typing import TYPE_CHECKING

import duckdb
import pytest

from drivelint import derive, store
from drivelint.errors import DriveLintError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

STEP = (
    "SELECT 'd' AS drive_id, 'e' AS ego_id, range AS t_ns, range::INTEGER AS k, 0 AS seg, 0.0 AS travel_m FROM range(5)"
)
SLOW = "SELECT 'd' AS drive_id, sum(hash(a.range, b.range) % 7)::BIGINT AS cell FROM range(1000000) a, range(1000000) b"


@pytest.fixture
def con() -> Iterator[duckdb.DuckDBPyConnection]:
    with store.connect() as con:
        yield con


def only(monkeypatch: pytest.MonkeyPatch, found: Mapping[str, tuple[str, set[str]]]) -> None:
    monkeypatch.setattr(derive, "ALWAYS", ())
    made = {table: derive.Derivation(table, sql, frozenset(reads)) for table, (sql, reads) in found.items()}
    monkeypatch.setattr(derive, "derivations", lambda: made)


CLOCK = """SELECT drive_id, ego_id, max(cell) AS period_ns, count(*) AS max_gap_ns, min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns
FROM step JOIN visited_cell USING (drive_id) GROUP BY ALL"""
CELL = "SELECT drive_id, max(t_ns) AS cell FROM step GROUP BY drive_id"


@pytest.mark.parametrize("large", [0, 10])
def test_each_runs_after_what_it_reads(
    con: duckdb.DuckDBPyConnection, monkeypatch: pytest.MonkeyPatch, large: int
) -> None:
    only(
        monkeypatch,
        {"step": (STEP, set()), "visited_cell": (CELL, {"step"}), "clock": (CLOCK, {"step", "visited_cell"})},
    )
    monkeypatch.setattr(derive, "LARGE", large)  # on one connection, or on two
    told: list[str] = []
    derive.derive(con, ["clock"], of_the_map=False, advance=told.append)
    assert told == ["step", "visited_cell", "clock"]
    assert con.execute("SELECT * FROM clock").fetchall() == [("d", "e", 4, 5, 0, 4)]


def test_what_fails_is_named_and_what_runs_beside_it_is_stopped(
    con: duckdb.DuckDBPyConnection, monkeypatch: pytest.MonkeyPatch
) -> None:
    only(monkeypatch, {"visited_cell": (SLOW, set()), "step": (STEP.replace("0 AS seg", "'x'::INTEGER AS seg"), set())})
    with pytest.raises(DriveLintError, match=r"^queries/derive/step\.sql: .*'x'"):
        derive.derive(con, ["step", "visited_cell"], of_the_map=False)
    assert con.execute("SELECT (SELECT count(*) FROM visited_cell), (SELECT count(*) FROM step)").fetchall() == [(0, 0)]


def test_short_memory_is_no_fault_of_the_query(con: duckdb.DuckDBPyConnection, monkeypatch: pytest.MonkeyPatch) -> None:
    con.execute("SET memory_limit = '20MB'")
    con.execute("SET temp_directory = ''")
    only(
        monkeypatch,
        {"visited_cell": ("SELECT 'd' AS drive_id, range AS cell FROM range(20000000) ORDER BY hash(range)", set())},
    )
    with pytest.raises(duckdb.OutOfMemoryException):
        derive.derive(con, ["visited_cell"], of_the_map=False)
