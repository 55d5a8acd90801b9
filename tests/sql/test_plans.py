"""No statement of a run compares rows with rows one by one, seen on the rows of a run.

The planner takes other joins on small tables than on large ones, and a plan says little about how many rows meet. So every statement of
derivations, rules and evidence is run under EXPLAIN ANALYZE, over drives that fill the tables, and the rows that went in are counted.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from drivelint import catalogue
from drivelint.drive.trace import DriveInput, IngestOptions
from drivelint.engine import session
from drivelint.engine.batch import Drive
from drivelint.engine.map_library import MapLibrary
from drivelint.engine.profiles import load_profiles, profile_table
from drivelint.evaluate.evaluation import Evaluation
from drivelint.formats import read_trace
from drivelint.result import evidence
from drivelint.sql import store
from tests.bench import traffic
from tests.shared_data import ROOT
from tests.sql.explained import Explained, Loop

if TYPE_CHECKING:
    from pathlib import Path


LOGS = {
    "collision": "overtake-road",
    "overtake-at-junction": "overtake-at-junction",
    "exit-signalled": "exit-road",
    "overtake-two-in-one-go": "long-road",
}


@pytest.mark.sample(0, ci=1)
@pytest.mark.parametrize("margins", [False, True])
def test_no_statement_compares_all_rows_with_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, margins: bool
) -> None:
    """Every statement of every rule, also where an evaluation would stop before it."""
    prepare = Evaluation.prepare

    def with_all_alternatives(run: Evaluation) -> None:
        prepare(run)
        run._has_holes = run._check_engagement = run._has_sensors = True
        run._rules_outside_conditions = set()

    monkeypatch.setattr(Evaluation, "_may_skip_rest", lambda _self, _n_rows: False)
    monkeypatch.setattr(Evaluation, "_has_no_occasion", lambda _self, _binding: False)
    monkeypatch.setattr(Evaluation, "prepare", with_all_alternatives)
    rules = catalogue.load_rules(())
    selected = catalogue.select_rules(rules, tuple(rules), ())
    found: list[Loop] = []
    looked_at: list[str] = []
    with store.connect(threads=2) as con:
        store.insert(con, "profile", profile_table(load_profiles(()), ()))
        run = session.JudgingSession(
            Explained(con, found, looked_at),  # type: ignore[arg-type]
            selected,
            catalogue.parse_params(selected, ()),
            tmp_path,
            margins=margins,
            observers=(lambda of, _drives, **_part: evidence.gather(of),),
        )
        run.judge(drives(tmp_path))
        run.close()
        verdicts = con.execute("SELECT DISTINCT verdict FROM verdict ORDER BY ALL").fetchall()
        # a rule whose signals no log has is not run
        sql = "SELECT DISTINCT rule_id FROM verdict WHERE NOT regexp_matches(reason_code, '^(missing|unrecorded)_')"
        judged = {rule_id for (rule_id,) in con.execute(sql).fetchall()}
    assert verdicts == [("fail",), ("not_applicable",), ("pass",), ("unknown",)]
    assert len(judged) >= 100
    texts = "\n".join(looked_at)
    sections = [(rule.id, name, sql) for rule in selected if rule.id in judged for name, sql in rule.sections.items()]
    assert [(rule_id, name) for rule_id, name, sql in sections if sql not in texts] == []
    shared = ("UPDATE _judged", "_key_frame", "INSERT INTO _outcome", "INSERT INTO _stretch", "INSERT INTO verdict")
    assert all(statement in texts for statement in shared)
    assert found == [], "\n".join(map(str, found))


def drives(home: Path) -> list[Drive]:
    """Return a crowded ring road, and logs of the fixtures with junctions, exits and overtakes."""
    ring = home / "ring.xodr"
    ring.write_text(traffic.ring(), encoding="utf-8")
    logs = [(traffic.write_folder(home / "ring", traffic.Shape(40.0, 10, 30), 1), ring)]
    fixtures = ROOT / "fixtures/scenes"
    logs += [(fixtures / f"{log}.mcap", fixtures / f"{road}.xodr") for log, road in LOGS.items()]
    traces = [(read_trace(log, IngestOptions()), road) for log, road in logs]
    return [Drive(trace, MapLibrary(DriveInput(map=road)).find(trace)[0]) for trace, road in traces]


def test_a_join_without_keys_is_seen() -> None:
    with store.connect(threads=1) as con:
        con.execute("CREATE TABLE numbers AS SELECT range AS n FROM range(2000)")
        found: list[Loop] = []
        seen = Explained(con, found, [])
        seen.execute("SELECT count(*) FROM numbers a JOIN numbers b USING (n)")
        seen.execute("SELECT count(*) FROM numbers a CROSS JOIN (VALUES (1), (2)) AS v(i)")
        assert found == []
        seen.execute("SELECT count(*) FROM numbers a JOIN numbers b ON a.n + b.n = 7")
        assert [(loop.left, loop.right) for loop in found] == [(2000, 2000)]
        seen.execute("SELECT count(*) FROM numbers a LEFT JOIN numbers b ON a.n = b.n AND a.n % 2 = 0")
        assert len(found) == 2
