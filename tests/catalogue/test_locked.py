"""A rule is untrusted code: what its SQL may not do, said with file and line; and that the database would refuse it too."""

from __future__ import annotations

import sys
from pathlib import Path

import duckdb
import msgspec
import pyarrow as pa
import pytest

from drivelint.casefile import Case, judge_case
from drivelint.catalogue import Rule, allowed_sql
from drivelint.catalogue.check import check_query
from drivelint.engine.session import JudgingSession
from drivelint.errors import RuleError
from drivelint.sql import store
from tests.evaluate.packs import INVARIANT, MEASURE, write

HEADER = INVARIANT | MEASURE | {"reads": '["ego_state"]'}
GOOD = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 1 AS required\nFROM ego_state"
FIRST = 14
"""The line of a rule's file on which its SQL begins: ten of header, one blank, one of the section's mark."""


def of(source: str, value: str = "speed_mps") -> str:
    return f"SELECT drive_id, ego_id, t_ns, {value} AS observed, 1 AS required\nFROM {source}"


ATTACKS = {
    "read_csv": (of("read_csv('/etc/passwd')"), 2, "table function read_csv()"),
    "read_text": (of("read_text('/etc/passwd')"), 2, "table function read_text()"),
    "glob": (of("glob('/etc/*')"), 2, "table function glob()"),
    "a file as a table": (of("'/etc/passwd'"), 2, "no table '/etc/passwd'"),
    "query": (of("query('SELECT 1')"), 2, "table function query()"),
    "query_table": (of("query_table(['ego_state'])"), 2, "table function query_table()"),
    "ST_Read": (of("ST_Read('/etc/passwd')"), 2, "table function st_read()"),
    "settings": (of("duckdb_settings()"), 2, "table function duckdb_settings()"),
    "settings as a view": (of("duckdb_settings"), 2, "no table 'duckdb_settings'"),
    "sqlite_master": (of("sqlite_master"), 2, "no table 'sqlite_master'"),
    "the schemas": (of("information_schema.tables"), 2, "no table 'information_schema.tables'"),
    "a database by name": (of("memory.main.ego_state"), 2, "no table 'memory.main.ego_state'"),
    "a kept database": (of("kept.ego_state"), 2, "no table 'kept.ego_state'"),
    "outputs": (of("verdict"), 2, "no table 'verdict'"),
    "the engine's tables": (of("_subject"), 2, "no table '_subject'"),
    "getenv": (of("ego_state", "getenv('HOME')"), 1, "function getenv()"),
    "getvariable": (of("ego_state", "getvariable('x')"), 1, "function getvariable()"),
    "current_setting": (of("ego_state", "current_setting('threads')"), 1, "function current_setting()"),
    "a quoted function": (of("ego_state", '"read_text"(ego_id)'), 1, "function read_text()"),
    "a function by its schema": (of("ego_state", "system.main.getenv('HOME')"), 1, "function getenv()"),
    "a function as a method": (of("ego_state", "ego_id.getenv()"), 1, "function getenv()"),
    "a window of chance": (of("ego_state", "speed_mps + max(random()) OVER ()"), 1, "function random()"),
    "an estimate": (of("ego_state", "approx_count_distinct(t_ns) OVER ()"), 1, "function approx_count_distinct()"),
    "an aggregate by name": (of("ego_state", "list_aggregate([1], 'approx_quantile')"), 1, "list_aggregate()"),
    "SQL out of JSON": (of("ego_state", "json_deserialize_sql('{}')"), 1, "function json_deserialize_sql()"),
    "the log of the database": (of("ego_state", "write_log('x')"), 1, "function write_log()"),
    "sleep": (of("ego_state", "sleep_ms(1000)"), 1, "function sleep_ms()"),
    "a sequence": (of("ego_state", "nextval('s')"), 1, "function nextval()"),
    "the clock": (of("ego_state", "now()"), 1, "function now()"),
    "the clock as a column": (of("ego_state", "current_timestamp"), 1, "current_timestamp does not return the same"),
    "who asks": (of("ego_state", "session_user"), 1, "session_user does not return the same"),
    "deep in a FILTER": (of("ego_state", "max(1) FILTER (uuid() = '') OVER ()"), 1, "function uuid()"),
    "deep in an ORDER BY": (f"{GOOD}\nORDER BY random()", 3, "function random()"),
    "deep in a REPLACE": (of("(SELECT * REPLACE (random() AS speed_mps) FROM ego_state)"), 2, "function random()"),
    "deep in a lambda": (of("ego_state", "list_transform([1], lambda x: random())"), 1, "function random()"),
    "COPY": ("COPY ego_state TO '/tmp/x.csv'", 1, "exactly one SELECT, and this is none"),
    "ATTACH": ("ATTACH '/tmp/x.db'", 1, "exactly one SELECT, and this is none"),
    "PRAGMA": ("PRAGMA database_list", 1, "only a plain SELECT"),
    "INSTALL": ("INSTALL httpfs", 1, "exactly one SELECT, and this is none"),
    "LOAD": ("LOAD httpfs", 1, "exactly one SELECT, and this is none"),
    "SET": ("SET threads = 1", 1, "exactly one SELECT, and this is none"),
    "CALL": ("CALL pragma_version()", 1, "exactly one SELECT, and this is none"),
    "EXPLAIN": (f"EXPLAIN {GOOD}", 1, "exactly one SELECT, and this is none"),
    "INSERT": (f"INSERT INTO ego_state BY NAME {GOOD}", 1, "exactly one SELECT, and this is none"),
    "nothing": ("-- only words", 1, "exactly one SELECT, and this is none"),
    "a second statement": (f"{GOOD};\n\nDROP TABLE step", 4, "exactly one SELECT, found 2"),
    "a macro named like an allowed function": (
        f"CREATE MACRO sum(x) AS TABLE SELECT * FROM read_text(x);\n{GOOD}",
        2,
        "exactly one SELECT, found 2",
    ),
    "out of the brackets": (f"{GOOD}\n) SELECT 1 --", 3, "syntax error"),
    "DESCRIBE": ("DESCRIBE ego_state", 1, "SHOW is not allowed"),
    "DESCRIBE inside": (of("(DESCRIBE ego_state)"), 2, "SHOW is not allowed"),
    "SUMMARIZE": ("SUMMARIZE ego_state", 1, "SHOW is not allowed"),
    "SHOW": ("SHOW ALL TABLES", 1, "SHOW is not allowed"),
    "PIVOT": ("PIVOT ego_state ON ego_id USING max(speed_mps)", 1, "found 2 statements"),
    "PIVOT in the standard's words": (of("ego_state PIVOT (max(speed_mps) FOR ego_id IN ('e'))"), 2, "PIVOT is not"),
    "UNPIVOT": (of("(UNPIVOT ego_state ON x_m, y_m INTO NAME n VALUE v)"), 2, "PIVOT is not"),
    "a recursion without an end": (
        f"WITH RECURSIVE r AS (\nSELECT 1 AS x UNION ALL SELECT x + 1 FROM r)\n{GOOD.replace('ego_state', 'r')}",
        2,
        "RECURSIVE CTE is not allowed",
    ),
    "a sample": (f"{GOOD} USING SAMPLE 3", 2, "a sample differs every time"),
    "a sample of a table": (f"{GOOD} TABLESAMPLE 10%", 2, "a sample differs every time"),
    "time travel": (f"{GOOD} AT (VERSION => 1)", 2, "AT (...) is not allowed"),
    "some rows": (f"{GOOD}\nLIMIT 5", 2, "LIMIT without ORDER BY"),
    "a first row": (
        GOOD.replace("speed_mps AS", "first(speed_mps) OVER (PARTITION BY ego_id) AS"),
        1,
        "first() without ORDER BY",
    ),
    "any row": (
        of("(SELECT *, (SELECT any_value(x_m) FROM pair) AS y FROM ego_state)"),
        2,
        "any_value() without ORDER BY",
    ),
    "rows by number": (of("(SELECT *, row_number() OVER () AS n FROM ego_state)"), 2, "row_number() without ORDER BY"),
    "a number beyond all": (of("ego_state", "1e999 > 2"), 1, "beyond all numbers"),
    "the order of rows": (of("ego_state POSITIONAL JOIN pair"), 2, "POSITIONAL JOIN depends"),
    "a CTE that shadows": (f"WITH\nstep AS (SELECT 1)\n{GOOD}", 2, "rename the CTE 'step'"),
    "a CTE like the engine's": (f"WITH _grid AS (SELECT 1)\n{GOOD}", 1, "rename the CTE '_grid'"),
    "a file behind a CTE of another scope": (
        of("""(WITH "/etc/passwd" AS (SELECT 1 AS x) SELECT x FROM "/etc/passwd"),\n'/etc/passwd'"""),
        3,
        "no table '/etc/passwd'",
    ),
    "a CTE that reads what it hides": (
        "WITH duckdb_settings AS (\nSELECT * FROM duckdb_settings)\n" + of("duckdb_settings"),
        2,
        "no table 'duckdb_settings'",
    ),
    "a very deep expression": (of("ego_state", "1" + " + 1" * 900), 1, "too deeply nested"),
    "an even deeper one": (of("ego_state", "1" + " + 1" * 9000), 1, "expression depth"),
    "very many brackets": (of("ego_state", "NOT(" * 20_000 + "true" + ")" * 20_000), 1, ""),
}


@pytest.mark.parametrize("name", ATTACKS)
def test_what_a_rule_may_not_do_is_refused_with_file_and_line(tmp_path: Path, name: str) -> None:
    sql, line, message = ATTACKS[name]
    with pytest.raises(RuleError) as caught:
        write(tmp_path, HEADER, {"condition": sql})
    said = str(caught.value)
    assert said.startswith(f"{tmp_path / 'pack' / 'rule.sql'}:{FIRST + line - 1}: ")
    assert message in said
    # one line for each function that it calls
    assert all(line.startswith(f"{tmp_path / 'pack' / 'rule.sql'}:") for line in said.splitlines())


def test_what_a_rule_may_do(tmp_path: Path) -> None:
    sql = """
WITH fast AS (SELECT *, row_number() OVER w AS n FROM ego_state WINDOW w AS (PARTITION BY drive_id ORDER BY t_ns)),
    n AS (SELECT unnest([1, 2]) AS i FROM range(2)),
    again AS (SELECT * FROM fast)
SELECT drive_id, ego_id, t_ns, greatest(speed_mps, list_max([x for x in [1, 2] if x > 1]), {'a': 1}.a) AS observed,
    CASE WHEN EXISTS (SELECT 1 FROM n WHERE i = 1) AND speed_mps NOT BETWEEN 1 AND 2 THEN standing_mps() ELSE 2 ** 2 END
        AS required
FROM again SEMI JOIN (VALUES ('e')) v(who) ON who = ego_id
UNION ALL BY NAME SELECT drive_id, ego_id, t_ns, 1 AS observed, 2 AS required FROM fast WHERE ego_id LIKE 'x%'"""
    assert write(tmp_path, HEADER, {"condition": sql}).reads == ("ego_state",)


def test_no_macro_of_ours_has_the_name_of_a_function_of_the_database() -> None:
    with duckdb.connect() as con:
        names = {name for (name,) in con.execute("SELECT DISTINCT function_name FROM duckdb_functions()").fetchall()}
    assert not allowed_sql.macros() & names


def test_every_allowed_function_gives_the_same_answer_every_time() -> None:
    with duckdb.connect() as con:
        rows = con.execute("SELECT function_name, stability, has_side_effects FROM duckdb_functions()").fetchall()
    unstable = {name for name, stability, effects in rows if stability == "VOLATILE" or effects}
    assert {"random", "nextval"} <= unstable
    assert not allowed_sql.functions() & unstable


def beyond_the_checker(tmp_path: Path, sql: str) -> Rule:
    """A rule whose SQL nobody looked at."""
    rule = write(tmp_path, HEADER, {"condition": GOOD})
    return msgspec.structs.replace(rule, sections={"condition": sql})


@pytest.mark.sample(3, ci=4)
@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("read_text('{file}')", "file system operations are disabled"),
        ("read_csv('{file}')", "file system operations are disabled"),
        ("glob('{file}*')", "file system operations are disabled"),
        ("'{file}'", "does not exist"),
        ("ST_Read('{file}')", "Could not open GDAL dataset"),
        ("ST_Read('/vsicurl/http://127.0.0.1/x.json')", "External access is disabled"),
        ("read_text('http://127.0.0.1/x.json')", "disabled"),
    ],
)
def test_the_database_refuses_what_the_checker_would_have_let_pass(tmp_path: Path, source: str, message: str) -> None:
    file = tmp_path / "secret.geojson"
    file.write_text('{"type": "Point", "coordinates": [1, 2]}', encoding="utf-8")
    with store.connect(threads=1) as con:
        assert con.execute(f"SELECT count(*) FROM ST_Read('{file}')").fetchall() == [(1,)]  # it could be read
    rule = beyond_the_checker(tmp_path, of(source.format(file=file), "1"))
    case = Case(name="open", given_tables={"ego_state": {"t_s": "0..1 by 0.1", "speed_mps": 2}}, expect="pass")
    verdicts, _ = judge_case(rule, case)
    assert [row["verdict"] for row in verdicts] == ["error"]
    assert message in verdicts[0]["reason"]


@pytest.mark.sample(4, ci=5)
@pytest.mark.parametrize(
    "statement",
    [
        "COPY clock TO '{folder}/out.csv'",
        "EXPORT DATABASE '{folder}/out'",
        "ATTACH '{folder}/out.db'",
        "LOAD httpfs",
        "INSTALL httpfs",
        "SET enable_external_access = true",
        "SET lock_configuration = false",
        "RESET allowed_configs",
        "SET python_enable_replacements = true",
    ],
)
def test_the_bench_on_which_rules_run_is_locked(tmp_path: Path, statement: str) -> None:
    with store.connect(threads=1) as con:
        JudgingSession(con, (), {}, None)
        with pytest.raises(duckdb.Error):
            con.execute(statement.format(folder=tmp_path))
        con.execute("SET memory_limit = '1GB'; SET threads = 2")  # what the bench itself changes
    assert list(tmp_path.iterdir()) == []


def test_a_variable_of_the_program_is_no_table_on_any_of_its_connections() -> None:
    secret = pa.table({"a": [1]})
    with store.connect(threads=1) as con, con.cursor() as other:
        for each in (con, other):
            with pytest.raises(duckdb.CatalogException, match="secret"):
                each.execute("SELECT * FROM secret")
    assert secret.num_rows == 1


def test_joins_too_deep_for_what_they_need_are_refused_by_name() -> None:
    """A chain of joins costs the checker a frame each; how many fit depends on what called it."""

    def deeper(frames: int) -> None:
        if frames:
            deeper(frames - 1)
        else:
            check_query(of("ego_state" + " CROSS JOIN step" * 900, "1"), "rule.sql")

    with pytest.raises(RuleError, match="too deeply nested"):
        deeper(sys.getrecursionlimit() - 400)
