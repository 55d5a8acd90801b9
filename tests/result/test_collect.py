"""Drive rows from a judged database."""

from __future__ import annotations

import duckdb
import pyarrow as pa
import pytest

from drivelint.result import collect
from drivelint.sql import store
from tests.report.synthetic import table, verdict


@pytest.fixture
def con() -> duckdb.DuckDBPyConnection:
    """A database with one drive on a map, judged for two egos, and one drive without anything."""
    con = duckdb.connect()
    store.create_tables(con)
    log = {"file_name": "f.csv", "sha256": "aa", "format": "x", "n_states": 30}
    log |= {"has_indicator": False, "has_brake_light": False, "has_acceleration": False, "in_sight": False}
    insert(
        con, "data_log", [log | {"drive_id": "d1", "environment_id": "e", "t_start_ns": 5, "t_end_ns": 2_000_000_005}]
    )
    insert(con, "data_log", [log | {"drive_id": "d0"}])
    road = {"environment_id": "e", "name": "road.xodr", "sha256": "bb", "format": "opendrive", "handedness": "lht"}
    insert(con, "environment", [road | {"offset_x_m": 0.0, "offset_y_m": 0.0, "handedness_source": "attribute"}])
    insert(
        con,
        "exposure",
        [
            {
                "drive_id": "d1",
                "ego_id": e,
                "km": km,
                "hours": 0.1,
                "engaged_km": km / 2,
                "engaged_hours": 0.05,
                "n_steps": 20,
            }
            for e, km in (("b", 0.2), ("a", 0.1))
        ],
    )
    insert(con, "quality", [{"drive_id": "d1", "check_id": "gap", "severity": "warning", "n": 1, "message": "a hole"}])
    insert(
        con,
        "map_quality",
        [
            {
                "environment_id": "e",
                "check_id": "missing_link",
                "severity": "warning",
                "lanelet_id": "1.0.1",
                "n": 1,
                "message": "no way on",
            }
        ],
    )
    insert(
        con,
        "capability",
        [
            {"drive_id": "d1", "ego_id": "a", "signal": "indicator", "available": False, "reason": "not in the log"},
            {"drive_id": "d1", "ego_id": "a", "signal": "map", "available": True, "reason": "given"},
        ],
    )
    rows = [
        verdict("pass"),
        verdict("fail", occurrence=1),
        verdict("not_applicable", profile=None),
        verdict("unknown", profile="relaxed"),
    ]
    store.insert(con, "verdict", table("verdict", rows))
    return con


def insert(con: duckdb.DuckDBPyConnection, name: str, rows: list[dict[str, object]]) -> None:
    given = {"signs_mapped": True} if name == "environment" else {}
    store.insert(con, name, pa.Table.from_pylist([given | row for row in rows]))


def test_a_drive_is_told_with_map_way_and_what_is_missing(con: duckdb.DuckDBPyConnection) -> None:
    empty, row = collect.drives(con).to_pylist()
    assert (row["drive_id"], row["map_name"], row["map_sha256"], row["handedness"]) == ("d1", "road.xodr", "bb", "lht")
    assert row["duration_s"] == 2.0
    assert row["km"] == pytest.approx(0.3)
    assert (row["n_egos"], row["n_steps"]) == (2, 40)
    assert [(x["ego_id"], x["engaged_km"], x["engaged_hours"]) for x in row["exposure"]] == [
        ("a", 0.05, 0.05), ("b", 0.1, 0.05),
    ]  # fmt: skip
    assert row["occasions"] == [
        {"rule_id": "ukhc.r162.safe-distance-ahead", "profile": "nominal", "n": 2, "n_judged": 2},
        {"rule_id": "ukhc.r162.safe-distance-ahead", "profile": "relaxed", "n": 1, "n_judged": 0},
    ]
    assert [x["message"] for x in row["quality"]] == ["a hole", "map road.xodr, 1.0.1: no way on"]
    assert row["not_judged"] == [
        {"ego_id": "a", "signal": "indicator", "reason_code": "text", "reason": "not in the log"}
    ]
    assert (empty["drive_id"], empty["n_egos"], empty["map_name"], empty["duration_s"]) == ("d0", 0, None, None)


@pytest.mark.parametrize(
    ("check", "severity", "lossy"),
    [
        ("duplicate_state", "error", True), ("duplicate_state", "info", False), ("teleport", "warning", False),
        ("malformed_row", "warning", True),
    ],
)  # fmt: skip
def test_an_error_or_a_lost_row_of_the_log_makes_a_drive_lossy(
    check: str, severity: str, lossy: bool, con: duckdb.DuckDBPyConnection
) -> None:
    assert [row["lossy"] for row in collect.drives(con).to_pylist()] == [False, False]
    con.execute("UPDATE map_quality SET severity = 'error'")  # a map that is wrong somewhere loses nothing of the log
    insert(con, "quality", [{"drive_id": "d1", "check_id": check, "severity": severity, "n": 1, "message": "bad"}])
    assert [row["lossy"] for row in collect.drives(con).to_pylist()] == [False, lossy]


def test_verdicts_come_in_total_order(con: duckdb.DuckDBPyConnection) -> None:
    assert [(r["profile"], r["occurrence"]) for r in collect.verdicts(con).to_pylist()] == [
        (None, 0),
        ("nominal", 0),
        ("nominal", 1),
        ("relaxed", 0),
    ]


def test_a_log_that_could_not_be_judged_fits_beside_those_that_could(con: duckdb.DuckDBPyConnection) -> None:
    both = pa.concat_tables([collect.drives(con), collect.unjudged_drive("bad", "bad.mcap", "cut short")])
    row = both.to_pylist()[-1]
    assert (row["status"], row["status_reason"], row["sha256"]) == ("not_judged", "cut short", None)
