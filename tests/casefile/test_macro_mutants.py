"""Mutants of macros with arguments, judged by the cases of the tables and rules that call them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from drivelint.casefile import commands, macro_mutation
from drivelint.casefile.macro_mutation import MacroMutant, judge_macro_mutants, macro_mutants
from drivelint.casefile.scene import case_database
from drivelint.casefile.table_cases import run_table_cases
from drivelint.errors import ExitCode, RuleError
from drivelint.sql.library import LibraryTable
from drivelint.sql.macro_trees import macro_texts
from tests.casefile.speed_rule import CASES as RULE_CASES
from tests.casefile.speed_rule import SPEED, measured_rule, with_cases

if TYPE_CHECKING:
    from pathlib import Path

    from drivelint.casefile.mutation import MutationResult

SELECT = "SELECT drive_id, ego_id, t_ns, passing_before_m(speed_mps) > 35 AS is_on, 'x' AS mode FROM ego_state"
CASES = """
- name: the distance before a passed actor grows with the speed
  given:
    ego_state: {t_s: 0..0.1 by 0.1, speed_mps: [4.9, 5.1]}
  expect: {t_s: 0..0.1 by 0.1, is_on: [false, true]}
"""


def table(folder_of_cases: Path, cases: str = CASES) -> LibraryTable:
    """Return a table that is named as one of the library, but has a SELECT that calls a macro, and write its cases."""
    (folder_of_cases / "ego_mode.cases.yml").write_text(cases, encoding="utf-8")
    return LibraryTable("ego_mode", "log", folder_of_cases / "ego_mode.sql", "", "", SELECT)


def passing_mutants() -> list[MacroMutant]:
    return [mutant for mutant in macro_mutants() if mutant.macro in {"passing_before_m", "passing_after_m"}]


def judged_counts(results: list[MutationResult]) -> dict[str, tuple[int, tuple[str, ...]]]:
    return {result.rule_id: (result.n, result.survivors) for result in results if result.n}


def test_a_macro_is_changed_where_a_table_calls_it_and_where_another_macro_does(tmp_path: Path) -> None:
    """10 + 5 * 5 m is 35 m: the cases notice both numbers of the inner macro, and no case is short enough for 30 m."""
    found, _ = judge_macro_mutants(passing_mutants(), [table(tmp_path)], [])
    assert judged_counts(found) == {
        "passing_after_m": (4, ()),
        "passing_before_m": (2, ("30.0 * 0.9", "30.0 * 1.1")),
    }


def test_the_macros_are_as_before_afterwards(tmp_path: Path) -> None:
    judge_macro_mutants(passing_mutants(), [table(tmp_path)], [])
    assert all(result.ok for result in run_table_cases(table(tmp_path)))
    assert case_database().execute("SELECT passing_before_m(0), passing_before_m(10)").fetchall() == [(30, 60)]


def test_a_macro_that_nobody_calls_is_named_and_not_judged(tmp_path: Path) -> None:
    mutants = [mutant for mutant in macro_mutants() if mutant.macro == "same_size"]
    results, uncalled = judge_macro_mutants(mutants, [table(tmp_path)], [])
    assert (judged_counts(results), uncalled) == ({}, ["same_size"])


def test_a_listed_survivor_of_an_unknown_macro_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "macros").mkdir()
    entries = '[[survivor]]\nrule = "gone"\nmutant = "2 * 0.9"\nreason = "r"\n'
    (tmp_path / "macros" / "survivors.toml").write_text(entries, encoding="utf-8")
    monkeypatch.setattr(macro_mutation, "folder", lambda _: tmp_path)
    (result,), _ = judge_macro_mutants([], [table(tmp_path)], [])
    assert (result.rule_id, result.ok, result.stale_listed_faults) == ("gone", False, ("2 * 0.9",))


def test_a_rule_judges_the_macros_that_it_calls(tmp_path: Path) -> None:
    """The macro is 75 m at 13 m/s: the boundary of the rule is as in the cases."""
    rule = with_cases(
        measured_rule(tmp_path, SPEED.replace("speed_mps AS", "passing_after_m(speed_mps) - 62 + 0 * speed_mps AS")),
        RULE_CASES,
    )
    mutants = [mutant for mutant in passing_mutants() if mutant.macro == "passing_after_m"]
    assert judged_counts(judge_macro_mutants(mutants, [], [rule])[0]) == {"passing_after_m": (4, ())}


def test_a_mutant_that_is_no_valid_sql_proves_nothing(tmp_path: Path) -> None:
    wrong = MacroMutant("passing_after_m", "no such column", "v_mps + missing")
    assert judged_counts(judge_macro_mutants([wrong], [table(tmp_path)], [])[0]) == {}


def test_cases_that_fail_without_a_mutant_judge_nothing(tmp_path: Path) -> None:
    other = table(tmp_path, CASES.replace("[false, true]", "[true, true]"))
    with pytest.raises(RuleError, match="without any mutant"):
        judge_macro_mutants(passing_mutants(), [other], [])


def test_a_macro_that_is_printed_with_another_meaning_judges_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(macro_mutation, "printed_select", lambda _: "SELECT 0")
    with pytest.raises(RuleError, match="printed by DuckDB"):
        judge_macro_mutants(passing_mutants(), [table(tmp_path)], [])
    assert case_database().execute("SELECT passing_before_m(10)").fetchall() == [(60,)]


def test_every_number_of_the_macros_with_arguments_has_mutants() -> None:
    """A macro without arguments is scaled where it is used: not here as a unit, but inside the macros that call it."""
    faults = {(mutant.macro, mutant.fault) for mutant in macro_mutants()}
    assert {
        ("reach_m", "31.3 * 0.9 #2"),
        ("reach_m", "lost_near_m() * 1.1"),
        ("stopping_factor", "10.0 * 0.9"),
    } <= faults
    assert not {name for name, _ in faults if not macro_texts()[name][0]}


def test_the_command_judges_macros_with_all_tables_only(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(commands, "library_tables", lambda: {"ego_mode": table(tmp_path)})
    monkeypatch.setattr(commands, "_rule_files", lambda _: [])
    monkeypatch.setattr(commands, "macro_mutants", passing_mutants)
    told: list[str] = []
    commands.table_mutation_test(["ego_mode"], told.append)
    assert not any("passing_before_m" in line for line in told)
    assert commands.table_mutation_test(["*"], told.append) == ExitCode.FAILED
    assert any(line.startswith("FAIL passing_before_m: 0 of 2 mutants noticed") for line in told)
