"""The engine against a slow, obvious evaluator: random grids with NULLs, lost rows, holes and truncated windows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import duckdb
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from drivelint.casefile.scene import insert_rows
from drivelint.evaluate import evaluate
from drivelint.sql import store
from tests.evaluate import naive
from tests.evaluate.packs import AFTER, BEFORE, EXECUTION, INVARIANT, MEASURE, PLACE_BEFORE, write

if TYPE_CHECKING:
    from drivelint.catalogue import Rule

GAP, PERIOD, WINDOW = 250, 100, 700
PHASES = (Phase.explicit, Phase.generate)  # a failure names its one small subject: there is nothing to shrink
CONDITION = """SELECT drive_id, ego_id, t_ns, speed_mps AS observed, 0 AS required, in_junction AS applies
FROM ego_state WHERE with_direction"""
REFERENCE = "SELECT drive_id, ego_id, t_ns, occurrence FROM exit_taken"
READS = {"reads": '["ego_state"]'}
READS_BOTH = {"reads": '["ego_state", "exit_taken"]'}


@pytest.fixture(scope="module")
def con() -> duckdb.DuckDBPyConnection:
    con = store.open_without_creating_tables()
    con.execute("SET threads=2")
    store.create_tables(con)
    store.create_macros(con)
    return con


@pytest.fixture(scope="module")
def rules(tmp_path_factory: pytest.TempPathFactory) -> list[Rule]:
    folder = tmp_path_factory.mktemp("rules")
    window = {"window_s": str(WINDOW / 1e9)}
    eventually = {"quantifier": '"eventually"'}
    at = {"reference": REFERENCE, "condition": CONDITION}
    anchor = "SELECT ref_id, unnest([t_ns - 300, t_ns, t_ns + 300]) AS t_ns FROM reference"
    wet = '[applies]\nweather = ["wet", "ice"]'
    return [
        write(folder, INVARIANT | MEASURE | READS, {"condition": CONDITION}, name="invariant_wet", tables=wet),
        write(folder, EXECUTION | MEASURE | READS_BOTH, at, name="execution_wet", tables=wet),
        write(folder, AFTER | MEASURE | READS_BOTH | window, at, name="after_wet", tables=wet),
        write(
            folder, INVARIANT | MEASURE | READS | {"merge_gap_s": "3e-7"}, {"condition": CONDITION}, name="invariant"
        ),
        write(folder, EXECUTION | MEASURE | READS_BOTH, at, name="execution"),
        write(folder, BEFORE | MEASURE | READS_BOTH | window, at, name="before"),
        write(folder, AFTER | MEASURE | READS_BOTH | window, at, name="after"),
        write(folder, BEFORE | MEASURE | READS_BOTH | window | eventually, at, name="before-eventually"),
        write(folder, AFTER | MEASURE | READS_BOTH | window | eventually, at, name="after-eventually"),
        write(folder, PLACE_BEFORE | MEASURE | READS_BOTH, at | {"anchor": anchor}, name="place"),
        write(
            folder, PLACE_BEFORE | MEASURE | READS_BOTH | eventually, at | {"anchor": anchor}, name="place-eventually"
        ),
    ]


WAYS = (100, 100, 100, 100, 200, 250, 251, 900)  # to the next sample: continuous up to 250
PRESENT = (True, True, True, True, True, False)  # the condition returns a row
APPLIES = (True, True, True, True, False, None)
VALUES = (3.0, 3.0, 2.0, 2.0, 1.0, 0.0, -1.0, None)
ENGAGED = (True, True, True, True, True, False, None)
WEATHER = (True, True, True, False, None)
WORD = {True: "wet", False: "dry", None: None}
# one draw per step keeps hypothesis quick
STEP = st.integers(0, len(WAYS) * len(PRESENT) * len(APPLIES) * len(VALUES) * len(ENGAGED) * len(WEATHER) - 1)
# most subjects are never driven by hand; times that are steps are as likely as others
SUBJECT = st.tuples(
    st.lists(STEP, min_size=1, max_size=25),
    st.lists(st.one_of(st.integers(-500, 3500), st.integers(0, 20).map(lambda k: 100 * k)), max_size=4, unique=True),
    st.sampled_from((False, False, True)),
)


def scene(numbers: list[int], *, by_hand: bool) -> list[naive.Step]:
    t = 0
    rows: list[tuple[int, bool, bool | None, float | None, bool | None, bool | None]] = []
    for number in numbers:
        rest, way = divmod(number, len(WAYS))
        rest, present = divmod(rest, len(PRESENT))
        rest, applies = divmod(rest, len(APPLIES))
        rest, engaged = divmod(rest, len(ENGAGED))
        level, weather = divmod(rest, len(WEATHER))
        driven = ENGAGED[engaged] if by_hand else True
        rows.append((t, PRESENT[present], APPLIES[applies], VALUES[level], driven, WEATHER[weather]))
        t += WAYS[way]
    segs = naive.segments([row[0] for row in rows], GAP)
    return [
        naive.Step(t, seg, present, applies, value, engaged, wet)
        for (t, present, applies, value, engaged, wet), seg in zip(rows, segs, strict=True)
    ]


def load(con: duckdb.DuckDBPyConnection, subjects: list[tuple[list[naive.Step], list[int]]]) -> None:
    """Fill the tables with one ego per subject."""
    con.execute(
        ";".join(
            f"DELETE FROM {table}"
            for table in ("clock", "step", "ego_state", "ego_condition", "exit_taken", "verdict", "finding", "margin")
        )
    )
    tables: dict[str, list[dict[str, Any]]] = {
        name: [] for name in ("clock", "step", "ego_state", "ego_condition", "exit_taken")
    }
    for n, (steps, references) in enumerate(subjects):
        who = {"drive_id": "d", "ego_id": f"e{n:03d}"}
        times = {"period_ns": PERIOD, "max_gap_ns": GAP, "t_start_ns": steps[0].t, "t_end_ns": steps[-1].t}
        tables["clock"].append(who | times)
        tables["step"] += [who | {"t_ns": s.t, "k": k, "seg": s.seg} for k, s in enumerate(steps)]
        given = (
            {"t_ns": s.t, "speed_mps": s.value, "in_junction": s.applies, "with_direction": s.present} for s in steps
        )
        tables["ego_state"] += [who | row for row in given]
        conditions = ({"t_ns": s.t, "engaged": s.engaged, "weather": WORD[s.wet]} for s in steps)
        tables["ego_condition"] += [who | row for row in conditions]
        tables["exit_taken"] += [who | {"occurrence": i, "t_ns": t} for i, t in enumerate(references)]
    for table, rows in tables.items():
        insert_rows(con, table, rows)


def expect(rule: str, steps: list[naive.Step], references: list[int]) -> list[naive.Outcome]:
    rule, _, wet = rule.partition("_")
    if rule == "invariant":
        found = naive.invariant(steps, GAP, PERIOD, wet_only=bool(wet))
    else:
        kind, _, word = rule.partition("-")
        eventually = word == "eventually"
        found = []
        for t in sorted(references):
            if kind == "execution":
                found.append(naive.points(steps, [t]))
            elif kind == "place":
                found.append(naive.points(steps, [t - 300, t, t + 300], eventually=eventually))
            else:
                a, b = (t - WINDOW, t) if kind == "before" else (t, t + WINDOW)
                found.append(naive.window(steps, a, b, GAP, eventually=eventually))
            found[-1] = naive.occasion(steps, t, found[-1], wet_only=bool(wet), physical=kind == "place")
    code = "not_engaged" if all(s.engaged is False for s in steps) else "not_triggered"
    return found or [naive.Outcome(-1, -1, "not_applicable", code, None, 0, 0)]


@pytest.mark.ci
@settings(max_examples=10, deadline=None, derandomize=True, phases=PHASES)
@given(subjects=st.lists(SUBJECT, min_size=15, max_size=25))
def test_the_engine_and_a_naive_evaluator_agree(
    con: duckdb.DuckDBPyConnection, rules: list[Rule], subjects: list[Any]
) -> None:
    scenes = [(scene(rows, by_hand=by_hand), references) for rows, references, by_hand in subjects]
    load(con, scenes)
    evaluate(con, rules)
    outcomes, runs = _outcomes(con), _runs(con)
    for n, (steps, references) in enumerate(scenes):
        ego = f"e{n:03d}"
        for rule in rules:
            wanted = expect(rule.id.removeprefix("pack."), steps, references)
            assert outcomes[ego, rule.id] == wanted, (rule.id, steps, references)
        assert runs.get(ego, []) == naive.stretches(steps, 300), steps


@pytest.mark.ci
@settings(max_examples=3, deadline=None, derandomize=True, phases=PHASES)
@given(subjects=st.lists(SUBJECT, min_size=15, max_size=25))
def test_asking_for_margins_changes_no_verdict(
    con: duckdb.DuckDBPyConnection, rules: list[Rule], subjects: list[Any]
) -> None:
    load(con, [(scene(rows, by_hand=by_hand), references) for rows, references, by_hand in subjects])
    evaluate(con, rules)
    first = con.execute("SELECT * FROM verdict ORDER BY ALL").fetchall()
    con.execute("DELETE FROM verdict; DELETE FROM finding")
    evaluate(con, rules, margins=True)
    assert con.execute("SELECT * FROM verdict ORDER BY ALL").fetchall() == first
    margins = "SELECT rule_id, ego_id, count(*), count(holds) FROM margin GROUP BY ALL ORDER BY ALL"
    verdicts = """SELECT rule_id, ego_id, sum(n_expected)::BIGINT AS n, sum(n_judged)::BIGINT
        FROM verdict WHERE reason_code <> 'log_hole' OR n_judged > 0 GROUP BY ALL HAVING n > 0 ORDER BY ALL"""
    kept = {row[:2]: row[2:] for row in con.execute(verdicts).fetchall()}
    seen = {row[:2]: row[2:] for row in con.execute(margins).fetchall()}
    assert {key: seen[key] for key in kept if key[0] == "pack.invariant"} == {
        key: n for key, n in kept.items() if key[0] == "pack.invariant"
    }
    assert seen.keys() >= kept.keys()


def _outcomes(con: duckdb.DuckDBPyConnection) -> dict[tuple[str, str], list[naive.Outcome]]:
    rows = con.execute(
        """SELECT ego_id, rule_id, coalesce(t_start_ns, -1), coalesce(t_end_ns, -1), verdict, reason_code, t_worst_ns,
            n_expected, n_judged
        FROM verdict ORDER BY ego_id, rule_id, occurrence"""
    ).fetchall()
    found: dict[tuple[str, str], list[naive.Outcome]] = {}
    for ego, rule, *values in rows:
        found.setdefault((ego, rule), []).append(naive.Outcome(*values))
    return found


def _runs(con: duckdb.DuckDBPyConnection) -> dict[str, list[tuple[int, int]]]:
    rows = con.execute(
        "SELECT ego_id, t_start_ns, t_end_ns FROM finding WHERE rule_id = 'pack.invariant' ORDER BY ego_id, occurrence"
    ).fetchall()
    found: dict[str, list[tuple[int, int]]] = {}
    for ego, start, end in rows:
        found.setdefault(ego, []).append((start, end))
    return found
