"""Same inputs, same rows: for any order of the rows, any number of threads, alone and in a crowd. Shown on more than a
million pairs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import duckdb
import pytest

from drivelint.evaluate import evaluate, evaluation
from drivelint.sql import store
from tests.evaluate.packs import BEFORE, EXECUTION, HOLDS, INVARIANT, MEASURE, write

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.catalogue import Rule

N_STEPS, N_OBJECTS = 11_500, 50
DRIVES = ("d0", "d1")


@pytest.fixture(scope="module")
def rules(tmp_path_factory: pytest.TempPathFactory) -> list[Rule]:
    folder = tmp_path_factory.mktemp("rules")
    pair = {"reads": '["pair"]'}
    events = {"reads": '["declared_event", "pair"]', "combine": '"all"'}
    gap = "SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed, 0.5 AS required FROM pair"
    reference = "SELECT drive_id, actor_id AS ego_id, t_ns FROM declared_event"
    signal = {"reads": '["ego_state", "declared_event"]', "window_s": "2.0"}
    indicator = "SELECT drive_id, ego_id, t_ns, indicator = 'left' AS holds FROM ego_state"
    return [
        write(folder, INVARIANT | MEASURE | pair, {"condition": gap}, name="gap"),
        write(folder, EXECUTION | MEASURE | events, {"reference": reference, "condition": gap}, name="all"),
        write(folder, BEFORE | HOLDS | signal, {"reference": reference, "condition": indicator}, name="signal"),
    ]


def database(drives: tuple[str, ...], *, threads: int, order: str) -> duckdb.DuckDBPyConnection:
    """Fill a database in SQL: rounded values, so that the least margin has many ties; NULLs, holes, an object that
    comes and goes."""
    con = store.open_without_creating_tables()
    con.execute(f"SET threads={threads}")
    con.execute("SET preserve_insertion_order=false")
    store.create_tables(con)
    store.create_macros(con)
    con.execute("CREATE TEMP TABLE drives AS SELECT unnest($drives) AS drive_id", {"drives": list(drives)})
    con.execute(
        f"""CREATE TEMP TABLE s AS
        SELECT drive_id, 'e' AS ego_id, (k + CASE WHEN k >= 7000 THEN 100
            ELSE 0 END) * 50000000 AS t_ns, k::INTEGER AS k, CASE WHEN k >= 7000 THEN 1 ELSE 0 END AS seg
        FROM drives, range({N_STEPS}) r(k)"""
    )
    con.execute(f"INSERT INTO step BY NAME SELECT *, 0.0 AS travel_m FROM s ORDER BY {order}")
    con.execute(
        "INSERT INTO clock SELECT drive_id, 'e', 50000000, 125000000, min(t_ns), max(t_ns) FROM s GROUP BY drive_id"
    )
    con.execute(
        f"INSERT INTO ego_condition BY NAME SELECT drive_id, ego_id, t_ns, true AS engaged FROM s ORDER BY {order}"
    )
    con.execute(
        f"""INSERT INTO ego_state BY NAME
        SELECT drive_id, ego_id, t_ns, k AS x_m, CASE WHEN k % 97 > 3 THEN 'left' END AS indicator FROM s ORDER BY {order}"""
    )
    con.execute(
        f"""INSERT INTO pair BY NAME
        SELECT drive_id, ego_id, t_ns, 'o' || o AS object_id, CASE WHEN k = 500 + o AND o % 7 = 0 THEN NULL
            ELSE round(2 + 1.6 * sin(k / 50.0 + o), 1) END AS clearance_m, false AS off_level
        FROM s, range({N_OBJECTS}) q(o) WHERE o % 5 > 0 OR k // 1000 % 2 = 0 ORDER BY {order},
            o * {1 if order == "k" else -1}"""
    )
    con.execute(
        f"""INSERT INTO declared_event BY NAME
        SELECT drive_id, 'e' AS actor_id, t_ns, 'go' AS event FROM s WHERE k % 100 = 50 ORDER BY {order}"""
    )
    return con


def result(con: duckdb.DuckDBPyConnection, rules: list[Rule]) -> dict[str, list[tuple[Any, ...]]]:
    evaluate(con, rules)
    return {table: con.execute(f"SELECT * FROM {table} ORDER BY ALL").fetchall() for table in ("verdict", "finding")}


@pytest.fixture(scope="module")
def crowd(rules: list[Rule]) -> dict[str, list[tuple[Any, ...]]]:
    with database(DRIVES, threads=2, order="k") as con:
        ((n,),) = con.execute("SELECT count(*) FROM pair").fetchall()
        assert n >= 1_000_000
        return result(con, rules)


@pytest.mark.ci
def test_the_scene_has_every_kind_of_verdict(crowd: dict[str, list[tuple[Any, ...]]]) -> None:
    kinds = {value for row in crowd["verdict"] for value in row if value in ("pass", "fail", "unknown")}
    assert kinds == {"pass", "fail", "unknown"}
    assert len(crowd["verdict"]) > 300
    assert len(crowd["finding"]) > 300


@pytest.mark.slow
def test_order_of_rows_and_number_of_threads_do_not_matter(
    crowd: dict[str, list[tuple[Any, ...]]], rules: list[Rule]
) -> None:
    with database(DRIVES, threads=1, order="hash(k)") as con:
        assert result(con, rules[::-1]) == crowd


@pytest.mark.ci
def test_a_drive_alone_has_the_same_rows_as_in_a_crowd(
    crowd: dict[str, list[tuple[Any, ...]]], rules: list[Rule]
) -> None:
    for drive in DRIVES:
        with database((drive,), threads=2, order="-k") as con:
            alone = result(con, rules)
        for table, rows in alone.items():
            assert rows == [row for row in crowd[table] if drive in row[:2]]


@pytest.mark.slow
def test_rules_are_judged_on_two_connections_as_on_one(
    crowd: dict[str, list[tuple[Any, ...]]], rules: list[Rule], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(evaluation, "LEAST_RULES_FOR_TWO_CONNECTIONS", 2)
    monkeypatch.setattr(evaluation, "LEAST_STEPS_FOR_TWO_CONNECTIONS", 0)
    with database(DRIVES, threads=2, order="k") as con:
        assert result(con, rules) == crowd


@pytest.mark.ci
def test_a_rule_that_errs_is_an_error_on_whatever_connection(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    reads = {"reads": '["ego_state"]'}
    good = "SELECT drive_id, ego_id, t_ns, x_m >= 0 AS holds FROM ego_state"
    bad = "SELECT drive_id, ego_id, t_ns, (drive_id || 'x')::BIGINT > 0 AS holds FROM ego_state"
    found = [
        write(tmp_path, INVARIANT | HOLDS | reads, {"condition": bad if n % 3 else good}, name=f"rule{n}")
        for n in range(12)
    ]
    monkeypatch.setattr(evaluation, "LEAST_RULES_FOR_TWO_CONNECTIONS", 2)
    monkeypatch.setattr(evaluation, "LEAST_STEPS_FOR_TWO_CONNECTIONS", 0)
    with database(("d0",), threads=2, order="k") as con:
        evaluate(con, found)
        rows = con.execute("SELECT rule_id, list_sort(list(DISTINCT verdict)) FROM verdict GROUP BY rule_id").fetchall()
    assert dict(rows) == {rule.id: ["error"] if n % 3 else ["pass", "unknown"] for n, rule in enumerate(found)}
