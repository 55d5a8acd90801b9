"""Which faults a mutation test makes of a rule, and what its proof says."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

from drivelint.casefile import mutation, run_cases
from drivelint.casefile.binding_errors import is_valid_sql
from drivelint.casefile.mutants import mutants
from drivelint.catalogue import Rule
from drivelint.errors import WorkerLostError
from tests.casefile.speed_rule import CASES, SPEED, measured_rule, with_cases
from tests.evaluate.packs import AFTER, HOLDS, INVARIANT, write

LOOSE = CASES.replace("13", "10").replace("12", "9").replace(", margin: 0", "")


def faults(rule: Rule) -> list[str]:
    return [mutant.fault for mutant in mutants(rule)]


def test_sense_edge_and_threshold(tmp_path: Path) -> None:
    assert faults(measured_rule(tmp_path)) == [
        "sense > -> <=",
        "sense > -> >=",
        "params.limit * 0.9",
        "params.limit * 1.1",
    ]


def test_a_condition_that_holds_is_turned_round(tmp_path: Path) -> None:
    sql = "SELECT drive_id, ego_id, t_ns, indicator = 'off' AS holds FROM ego_state"
    rule = write(tmp_path, INVARIANT | HOLDS | {"reads": '["ego_state"]'}, {"condition": sql})
    (mutant,) = mutants(rule)
    assert mutant.fault == "NOT holds"
    assert "NOT holds AS holds" in mutant.rule.sections["condition"]


def test_windows_are_halved_and_doubled(tmp_path: Path) -> None:
    invariant = measured_rule(tmp_path, header={"merge_gap_s": "4.0", "exempt_after_s": '"limit"'})
    assert [f for f in faults(invariant) if "_s" in f or "limit" in f] == [
        *("params.limit * 0.5", "params.limit * 2"),
        *("merge_gap_s * 0.5", "merge_gap_s * 2"),
    ]
    assert "merge_gap_s * 2" not in faults(measured_rule(tmp_path)), "the header does not set it"
    condition = "SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id, true AS holds FROM reference_step s"
    reference = "SELECT drive_id, ego_id, t_ns FROM exit_taken"
    later = write(
        tmp_path, AFTER | HOLDS | {"reads": '["exit_taken"]'}, {"reference": reference, "condition": condition}
    )
    assert faults(later) == ["NOT holds", "window_s * 0.5", "window_s * 2"]


def test_every_term_comparison_and_number_of_the_sql(tmp_path: Path) -> None:
    sql = """
WITH near AS (SELECT * FROM pair WHERE clearance_m < 2.5 AND object_id <> 'a' AND abs(clearance_m) >= 1)
SELECT drive_id, e.ego_id, t_ns, e.speed_mps AS observed, 2 * e.limit_mps AS required,
    CASE WHEN e.speed_mps > 30 THEN 'fast' END AS reason
FROM ego_state e
LEFT JOIN near n USING (drive_id, t_ns)
LEFT JOIN step s ON s.drive_id = e.drive_id AND s.t_ns = e.t_ns
WHERE coalesce(n.clearance_m, 0) > standing_mps() * 1e9
UNION ALL
SELECT drive_id, ego_id, t_ns, speed_mps, 0, 'never ' || 7 FROM ego_state WHERE false"""
    rule = measured_rule(tmp_path, sql, {"reads": '["ego_state", "pair", "step"]'}, tables="")
    assert sorted(faults(rule)[2:]) == sorted(
        [
            "@condition WHERE without: clearance_m < 2.5",
            "@condition WHERE without: object_id != 'a'",
            "@condition WHERE without: abs(clearance_m) >= 1",
            "@condition WHERE without: COALESCE(n.clearance_m, 0) > (standing_mps() * 1000000000.0)",
            "@condition WHERE without: CAST('f' AS BOOLEAN)",
            "@condition USING without: drive_id",
            "@condition USING without: t_ns",
            "@condition ON without: s.drive_id = e.drive_id",
            "@condition ON without: s.t_ns = e.t_ns",
            "@condition turned: clearance_m < 2.5",
            "@condition turned: abs(clearance_m) >= 1",
            "@condition turned: COALESCE(n.clearance_m, 0) > (standing_mps() * 1000000000.0)",
            *(f"@condition 2.5 * {factor}" for factor in (0.9, 1.1)),
            *(f"@condition 2 * {factor}" for factor in (0.9, 1.1)),
            *(f"@condition 2 * e.limit_mps * {factor}" for factor in (0.9, 1.1)),
            *(f"@condition standing_mps() * {factor}" for factor in (0.9, 1.1)),
        ]
    )


def test_a_mutant_is_its_fault_and_nothing_else(tmp_path: Path) -> None:
    sql = SPEED.replace("$limit", "2.5") + " WHERE speed_mps > 1 AND lanelet_id IS NOT NULL"
    rule = measured_rule(tmp_path, sql, tables="")
    by_fault = {mutant.fault: mutant.rule.sections["condition"] for mutant in mutants(rule)}
    start = "SELECT drive_id, ego_id, t_ns, speed_mps AS observed, "
    assert by_fault["@condition WHERE without: speed_mps > 1"] == (
        f"{start}2.5 AS required FROM ego_state WHERE (lanelet_id IS NOT NULL)"
    )
    assert by_fault["@condition turned: speed_mps > 1"] == (
        f"{start}2.5 AS required FROM ego_state WHERE ((speed_mps <= 1) AND (lanelet_id IS NOT NULL))"
    )
    assert by_fault["@condition 2.5 * 0.9"].startswith(f"{start}(2.5 * CAST(0.9 AS DOUBLE)) AS required FROM")


def test_a_fault_that_stands_twice_has_two_names(tmp_path: Path) -> None:
    twice = measured_rule(tmp_path, f"{SPEED} WHERE t_ns > 5 UNION ALL {SPEED} WHERE t_ns > 5")
    assert [f for f in faults(twice) if "without" in f] == [
        "@condition WHERE without: t_ns > 5",
        "@condition WHERE without: t_ns > 5 #2",
    ]


def test_good_cases_notice_every_mutant(tmp_path: Path) -> None:
    proof = mutation.judge_mutants(with_cases(measured_rule(tmp_path), CASES))
    assert proof == mutation.MutationResult("pack.rule", True, 4, (), ())
    assert (proof.ok, proof.n_noticed) == (True, 4)


@pytest.mark.ci
def test_a_threshold_that_no_case_is_close_to_is_a_survivor(tmp_path: Path) -> None:
    rule = with_cases(measured_rule(tmp_path), LOOSE)
    proof = mutation.judge_mutants(rule)
    assert proof.survivors == ("sense > -> >=", "params.limit * 0.9")
    assert not proof.ok
    assert "no case notices: params.limit * 0.9" in mutation.result_text(proof)
    assert "with a value between the two numbers" in mutation.result_text(proof)
    assert mutation.summary_line([proof]) == "1 stable rule: 2 of 4 mutants noticed (50.0%)"
    assert mutation.noticed_share([proof]) < mutation.LEAST_NOTICED_SHARE
    assert mutation.summary_line([proof._replace(stable=False)]) == (
        "no stable rule here: only the mutants of stable rules must be noticed"
    )


@pytest.mark.slow
def test_a_listed_survivor_may_live_and_no_other(tmp_path: Path) -> None:
    rule = with_cases(measured_rule(tmp_path), LOOSE)
    entry = '[[survivor]]\nrule = "pack.rule"\nmutant = "{}"\nreason = "a test"\n'
    listed = [entry.format("sense > -> >="), entry.format("params.limit * 0.9")]
    file = rule.path.parent / mutation.SURVIVORS_FILE
    file.write_text(listed[0], encoding="utf-8")
    assert mutation.judge_mutants(rule).unlisted_survivors == ("params.limit * 0.9",)
    file.write_text("".join(listed), encoding="utf-8")
    assert mutation.judge_mutants(rule).ok
    assert mutation.noticed_share([mutation.judge_mutants(rule)]) == 0.5, (
        "what is listed counts as not noticed all the same"
    )
    file.write_text("".join([*listed, entry.format("sense > -> <=")]), encoding="utf-8")
    proof = mutation.judge_mutants(rule)
    assert (proof.ok, proof.stale_listed_faults) == (False, ("sense > -> <=",))
    file.write_text(entry.format("x").replace("pack.rule", "pack.gone"), encoding="utf-8")
    assert mutation.unknown_rule_messages([rule]) == [f"{file}: there is no rule 'pack.gone' here"]


def test_a_mutant_that_is_no_valid_sql_is_not_counted(tmp_path: Path) -> None:
    """Without a key in USING its column is ambiguous, which DuckDB refuses: no case has noticed anything."""
    sql = """
SELECT drive_id, ego_id, t_ns, e.speed_mps AS observed, $limit AS required FROM ego_state e JOIN clock USING (drive_id, ego_id)"""
    rule = with_cases(measured_rule(tmp_path, sql, {"reads": '["clock", "ego_state"]'}), CASES)
    assert [fault for fault in faults(rule) if "USING" in fault] == [
        "@condition USING without: drive_id",
        "@condition USING without: ego_id",
    ]
    assert mutation.judge_mutants(rule) == mutation.MutationResult("pack.rule", True, 4, (), ())


def test_sql_that_duckdb_cannot_plan_is_not_valid(tmp_path: Path) -> None:
    """DuckDB binds a LEFT JOIN with a column of a table before the comma, but does not support it."""
    sql = """
SELECT e.drive_id, e.ego_id, e.t_ns, e.speed_mps AS observed, f.factor * $limit AS required
FROM ego_state e, (SELECT 1.0 AS factor) f LEFT JOIN clock c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id"""
    assert not is_valid_sql(measured_rule(tmp_path, sql, {"reads": '["clock", "ego_state"]'}))


def test_a_join_after_a_cross_join_has_mutants_with_the_same_meaning(tmp_path: Path) -> None:
    """DuckDB prints CROSS JOIN as a comma, behind which `e` could not be joined to."""
    sql = """
SELECT e.drive_id, e.ego_id, e.t_ns, e.speed_mps AS observed, f.factor * $limit AS required
FROM ego_state e CROSS JOIN (SELECT 1.0 AS factor) f JOIN clock c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id"""
    rule = with_cases(measured_rule(tmp_path, sql, {"reads": '["clock", "ego_state"]'}), CASES)
    proof = mutation.judge_mutants(rule)
    assert all(is_valid_sql(mutant.rule) for mutant in mutants(rule))
    # its cases of one drive and one ego each are judged beside each other, so that a key that is left out is noticed
    assert (proof.problem, proof.n, proof.n_noticed) == ("", len(faults(rule)), len(faults(rule)))


def test_a_rule_that_breaks_its_own_cases_proves_nothing(tmp_path: Path) -> None:
    proof = mutation.judge_mutants(
        with_cases(measured_rule(tmp_path), CASES.replace("expect: unknown", "expect: pass"))
    )
    assert (proof.ok, proof.n_noticed, proof.n) == (False, 0, 4)
    assert "case 'unknown': expected pass, got unknown" in proof.problem


class RuleThatEndsTheProcess:
    """Stands for a rule whose judging ends the process, as a lack of memory may."""

    def __reduce__(self) -> Any:
        return os._exit, (1,)


@pytest.mark.ci
def test_a_process_that_dies_is_an_error_and_not_waited_for() -> None:
    rules: Any = [RuleThatEndsTheProcess()] * 4
    with pytest.raises(WorkerLostError, match="a process that judged mutants has died"):
        list(mutation.judge_all_mutants(rules, 2))


@pytest.mark.slow
@pytest.mark.sample(1)
@pytest.mark.parametrize(("key", "other_key"), [("drive_id", "ego_id"), ("ego_id", "drive_id")])
def test_a_join_without_a_key_is_noticed_by_cases_of_one_drive_each(tmp_path: Path, key: str, other_key: str) -> None:
    """Both cases are fine only_waivers: only beside each other does the lost key show."""
    sql = f"""
SELECT e.drive_id, e.ego_id, e.t_ns, 20 AS observed, CASE WHEN l.t_to_ns IS NULL THEN e.speed_mps END AS required
FROM ego_state e
LEFT JOIN lost_object l ON l.{other_key} = e.{other_key}"""
    rule = measured_rule(tmp_path, sql, {"reads": '["ego_state", "lost_object"]'}, tables="")
    with_cases(
        rule,
        """
- name: clean
  given: {ego_state: {t_s: 0..1 by 0.1, speed_mps: 12}}
  expect: pass
- name: unknown, somebody was lost
  given: {ego_state: {t_s: 0..1 by 0.1, speed_mps: 12}, lost_object: {object_id: b, t_from_s: 0, t_to_s: 1, code: lost_near_ego}}
  expect: unknown
""",
    )
    alone, beside = {r.name: r for r in run_cases(rule) if r.name != "kinds of case"}, mutation.judge_mutants(rule)
    assert [name for name, result in alone.items() if not result.ok] == ["all cases together"]
    assert f"does each join have {key}?" in alone["all cases together"].message
    assert "case 'clean': expected pass, got unknown" in beside.problem
