"""How derivations run: beside each other, each after what it reads; what fails is named."""

from __future__ import annotations

import math
import time
from itertools import accumulate
from typing import TYPE_CHECKING, Any

import duckdb
import pytest

from drivelint.engine import derive
from drivelint.errors import DriveLintError
from drivelint.sql import derivations, store

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

STEP = "SELECT 'd' AS drive_id, 'e' AS ego_id, range AS t_ns, range::INTEGER AS k, NULL AS dt_ns, 0 AS seg, 0.0 AS travel_m FROM range(5)"
SLOW = "SELECT 'd' AS drive_id, 0 AS t_from_ns, sum(hash(a.range, b.range) % 7)::BIGINT AS t_to_ns FROM range(1000000) a, range(1000000) b"


@pytest.fixture
def con() -> Iterator[duckdb.DuckDBPyConnection]:
    with store.connect() as con:
        yield con


def only(monkeypatch: pytest.MonkeyPatch, tables: Mapping[str, tuple[str, set[str]]]) -> None:
    made = {table: derivations.Derivation(table, sql, frozenset(reads)) for table, (sql, reads) in tables.items()}
    monkeypatch.setattr(derivations, "library_tables", lambda: made)
    monkeypatch.setattr(derivations, "_derivation", made.__getitem__)


CLOCK = """SELECT drive_id, ego_id, max(t_to_ns) AS period_ns, count(*) AS max_gap_ns, min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns
FROM step JOIN lost_time USING (drive_id) GROUP BY ALL"""
LOST_TIME = "SELECT drive_id, min(t_ns) AS t_from_ns, max(t_ns) AS t_to_ns FROM step GROUP BY drive_id"


@pytest.mark.parametrize(("most_states", "n"), [(derive.MOST_STATES_FOR_EMPTINESS_TEST, 0), (-1, 5)])
def test_without_an_occasion_a_table_of_few_states_stays_empty(
    con: duckdb.DuckDBPyConnection, monkeypatch: pytest.MonkeyPatch, most_states: int, n: int
) -> None:
    """Of many, nothing is run twice: the statement itself finds that there are no rows; here it is made to have some."""
    made = {"step": derivations.Derivation("step", STEP, frozenset(), occasion="SELECT 1 WHERE false")}
    monkeypatch.setattr(derivations, "library_tables", lambda: made)
    monkeypatch.setattr(derivations, "_derivation", made.__getitem__)
    monkeypatch.setattr(derive, "MOST_STATES_FOR_EMPTINESS_TEST", most_states)
    derive.derive(con, ["step"], are_map_tables=False, always_needed_tables=())
    assert con.execute("SELECT count(*) FROM step").fetchone() == (n,)


@pytest.mark.parametrize("large", [0, 10])
def test_each_runs_after_what_it_reads(
    con: duckdb.DuckDBPyConnection, monkeypatch: pytest.MonkeyPatch, large: int
) -> None:
    only(
        monkeypatch,
        {"step": (STEP, set()), "lost_time": (LOST_TIME, {"step"}), "clock": (CLOCK, {"step", "lost_time"})},
    )
    monkeypatch.setattr(derive, "LEAST_STATES_FOR_ONE_WORKER", large)  # on one connection, or on two
    told: list[str] = []
    fill = derive._fill_table

    def telling(con: duckdb.DuckDBPyConnection, step: derivations.Derivation, *types: Any, **old: Any) -> int:
        told.append(step.table)
        return fill(con, step, *types, **old)

    monkeypatch.setattr(derive, "_fill_table", telling)
    derive.derive(con, ["clock"], are_map_tables=False, always_needed_tables=())
    assert told == ["step", "lost_time", "clock"]
    assert con.execute("SELECT * FROM clock").fetchall() == [("d", "e", 4, 5, 0, 4)]


@pytest.mark.parametrize("begins_late", [False, True])  # an interrupt before a statement has begun is lost
def test_what_fails_is_named_and_what_runs_beside_it_is_stopped(
    con: duckdb.DuckDBPyConnection, monkeypatch: pytest.MonkeyPatch, begins_late: bool
) -> None:
    only(monkeypatch, {"lost_time": (SLOW, set()), "step": (STEP.replace("0 AS seg", "'x'::INTEGER AS seg"), set())})
    fill = derive._fill_table

    def late(con: duckdb.DuckDBPyConnection, step: derivations.Derivation, *types: Any, **old: Any) -> int:
        if begins_late and step.table == "lost_time":
            time.sleep(0.3)
        return fill(con, step, *types, **old)

    monkeypatch.setattr(derive, "_fill_table", late)
    with pytest.raises(DriveLintError, match=r"^queries/library/log/step\.sql: .*'x'"):
        derive.derive(con, ["step", "lost_time"], are_map_tables=False, always_needed_tables=())
    assert con.execute("SELECT (SELECT count(*) FROM lost_time), (SELECT count(*) FROM step)").fetchall() == [(0, 0)]


def test_short_memory_is_no_fault_of_the_query(con: duckdb.DuckDBPyConnection, monkeypatch: pytest.MonkeyPatch) -> None:
    con.execute("SET memory_limit = '20MB'")
    con.execute("SET temp_directory = ''")
    only(
        monkeypatch,
        {
            "lost_time": (
                "SELECT 'd' AS drive_id, range AS t_from_ns, range AS t_to_ns FROM range(20000000) ORDER BY hash(range)",
                set(),
            )
        },
    )
    with pytest.raises(duckdb.OutOfMemoryException):
        derive.derive(con, ["lost_time"], are_map_tables=False, always_needed_tables=())


SAMPLES = (91, 91, 16, 91, 91, 34, 29, 23, 18, 17, 91)


def way(egos: Sequence[int]) -> dict[int, list[float]]:
    """Return ego -> its way, step by step, where these egos are in one drive."""
    with store.connect() as con:
        con.execute(
            "CREATE TEMP TABLE e AS SELECT unnest(?) AS e, unnest(?) AS n", [[*egos], [SAMPLES[e] for e in egos]]
        )
        con.execute("INSERT INTO actor BY NAME SELECT 'd' AS drive_id, e::VARCHAR AS actor_id, true AS is_ego FROM e")
        con.execute(
            "INSERT INTO actor_state BY NAME SELECT 'd' AS drive_id, e::VARCHAR AS actor_id, range * 50_000_000 AS t_ns, "
            "sqrt(range * 1.7) * (31 + e) AS x_m, sin(range / 7) AS y_m FROM e, range(100) WHERE range < n"
        )
        derive.derive(con, ["step"], are_map_tables=False)
        found = con.execute("SELECT ego_id::INTEGER, list(travel_m ORDER BY k) FROM step GROUP BY ego_id").fetchall()
        return dict(found)


@pytest.mark.slow
def test_the_way_is_the_same_to_the_last_bit_beside_other_egos() -> None:
    crowd = way(range(len(SAMPLES)))
    for ego, n in enumerate(SAMPLES):
        x, y = [math.sqrt(k * 1.7) * (31 + ego) for k in range(n)], [math.sin(k / 7) for k in range(n)]
        steps = [math.hypot(b - a, d - c) for a, b, c, d in zip(x, x[1:], y, y[1:], strict=False)]
        assert crowd[ego] == pytest.approx([0.0, *accumulate(steps)], abs=1e-9)
        assert way([ego])[ego] == crowd[ego]
