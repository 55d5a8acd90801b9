"""Ids are text: what a rule returns as one is never another actor's that reads alike as a number."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pyarrow.parquet as pq
import pytest

from drivelint.engine.profiles import load_profiles, profile_table
from drivelint.engine.session import JudgingSession
from drivelint.sql import store
from tests.evaluate.packs import EXECUTION, INVARIANT, MEASURE, write
from tests.scenes import drive, moving, road, rows, times

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.catalogue import Rule

PAIR = {"reads": '["pair"]'}


def verdict_by_object(rule: Rule, out: Path | None = None) -> dict[str | None, dict[str, Any]]:
    """Return object -> verdict in a drive whose other actors are called 42 and 042."""
    way, t = road(((400.0, 0.0),)), times(3.0)
    actors = [moving(name, way, t, s + 10 * t, way.ego_d) for name, s in (("ego", 20), ("42", 60), ("042", 100))]
    with store.connect() as con:
        store.insert(con, "profile", profile_table(load_profiles(), ()))
        session = JudgingSession(con, [rule], {}, out, margins=out is not None)
        session.judge([drive(actors, way.environment)])
        session.close()
        return {row["object_id"]: row for row in rows(con, "FROM verdict")}


@pytest.mark.sample(1, ci=1)
@pytest.mark.parametrize("kind", ["VARCHAR", "INTEGER", "DOUBLE", "DECIMAL(9, 1)"])
def test_an_actor_that_the_rule_left_out_is_unknown(tmp_path: Path, kind: str) -> None:
    sql = f"""SELECT drive_id, ego_id, t_ns, object_id::VARCHAR::{kind} AS object_id, clearance_m AS observed, 1.0 AS required
    FROM pair WHERE object_id::VARCHAR = '42'"""
    found = verdict_by_object(write(tmp_path, INVARIANT | MEASURE | PAIR, {"condition": sql}))
    assert (found["042"]["verdict"], found["042"]["n_judged"]) == ("unknown", 0)
    assert found["42"]["verdict"] == ("pass" if kind in {"VARCHAR", "INTEGER"} else "unknown")  # 42.0 is nobody's id


@pytest.mark.ci
def test_margins_of_an_actor_that_no_log_has(tmp_path: Path) -> None:
    who = "SELECT drive_id, ego_id, t_ns, 'nobody' AS object_id"
    sections = {
        "reference": f"{who} FROM clock JOIN step USING (drive_id, ego_id) WHERE k = 0",
        "condition": f"{who}, 2.0 AS observed, 1.0 AS required FROM step WHERE k = 0",
    }
    rule = write(tmp_path, EXECUTION | MEASURE | {"reads": '["clock", "step"]'}, sections)
    assert verdict_by_object(rule, tmp_path)["nobody"]["verdict"] == "pass"
    assert pq.read_table(tmp_path / ".margins.parquet")["object_id"].to_pylist() == ["nobody"]
