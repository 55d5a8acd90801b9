"""Where the time of `derive` goes: per table, and per operator of the dearest ones, as DuckDB's own profile tells."""

from __future__ import annotations

import json
import time
from typing import TYPE_CHECKING, Any

from drivelint import catalogue
from drivelint.drive.trace import DriveInput, IngestOptions
from drivelint.engine.batch import Drive
from drivelint.engine.map_library import MapLibrary
from drivelint.engine.profiles import load_profiles, profile_table
from drivelint.engine.session import JudgingSession
from drivelint.formats import read_trace
from drivelint.sql import store
from drivelint.sql.derivations import needed_derivations
from tests.bench.table import Row

if TYPE_CHECKING:
    from tests.bench.place import Place

DEAREST = 8
OPERATORS = 4


def profile(place: Place) -> list[Row]:
    """Return the dearest derived tables of the reference drive, the costliest operators in the note."""
    spent: dict[str, tuple[float, str]] = {}
    rules = catalogue.select_rules(catalogue.load_rules(()), ("ukhc",), ())
    tables = {table for rule in rules for table in rule.reads}
    trace = read_trace(place.reference, IngestOptions())
    road = MapLibrary(DriveInput(map=place.road)).find(trace)[0]
    with store.connect() as con:
        store.insert(con, "profile", profile_table(load_profiles(()), ()))
        bench = JudgingSession(con, rules, catalogue.parse_params(rules, ()), None)
        bench._load_drives([Drive(trace, road)])
        for step in needed_derivations(tables):
            if not step.is_of_map_only:
                begin = time.perf_counter()
                plan = con.execute(
                    f"EXPLAIN (ANALYZE, FORMAT JSON) INSERT INTO {step.table} BY NAME {step.sql}"
                ).fetchall()[0][1]
                took = time.perf_counter() - begin
                rows = con.execute(f"SELECT count(*) FROM {step.table}").fetchall()[0][0]
                spent[step.table] = took, f"{rows:,} rows; {_operators(json.loads(plan))}"
    dearest = sorted(spent.items(), key=lambda item: -item[1][0])[:DEAREST]
    whole = sum(took for took, _ in spent.values())
    return [
        Row("profile", "derive, profiled", whole, note="profiling adds some"),
        *(Row("profile", table, took, note=note) for table, (took, note) in dearest),
    ]


def _operators(plan: dict[str, Any]) -> str:
    """Return the costliest operators with their CPU seconds and rows out."""
    found: list[tuple[float, str]] = []
    _collect(plan, found)
    return "; ".join(f"{name} {seconds:.2f} s" for seconds, name in sorted(found, reverse=True)[:OPERATORS])


def _collect(node: dict[str, Any], operator_times: list[tuple[float, str]]) -> None:
    if "operator_timing" in node:
        about = node.get("extra_info", {})
        what = next((str(about[key]) for key in ("Conditions", "Table", "CTE Name", "Expressions") if key in about), "")
        name = f"{node['operator_name'].strip()} ({' '.join(what.split())[:60]}) -> {node['operator_cardinality']:,}"
        operator_times.append((node["operator_timing"], name.replace("|", "/")))
    for child in node.get("children", []):
        _collect(child, operator_times)
