"""The cases beside the tables of the library: all pass, every public table has some, and the runner says what is wrong where."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from drivelint.casefile import commands, mutation, table_cases, table_mutation
from drivelint.errors import ExitCode, RuleError, UsageError
from drivelint.sql.library import LibraryTable, library_tables

if TYPE_CHECKING:
    from pathlib import Path

TOPICS = sorted({table.topic for table in library_tables().values()})
SELECT = "SELECT drive_id, ego_id, t_ns, speed_mps > 2.0 AS is_on, 'automated_driving' AS mode FROM ego_state WHERE speed_mps >= 0.5"
CASES = """
- name: two speeds
  given:
    ego_state: {t_s: 0..0.3 by 0.1, speed_mps: [0.4, 0.6, 1.9, 2.1]}
  expect: {t_s: 0.1..0.3 by 0.1, is_on: {else: false, 0.3: true}}
"""


def table(folder: Path, cases: str = CASES, select: str = SELECT) -> LibraryTable:
    """Return a table that is named as one of the library, but has another SELECT, and write its cases."""
    (folder / "ego_mode.cases.yml").write_text(cases, encoding="utf-8")
    return LibraryTable("ego_mode", "log", folder / "ego_mode.sql", "", "", select)


@pytest.mark.sample(4, ci=9)
@pytest.mark.parametrize("topic", TOPICS)
def test_cases_of_the_library_pass(topic: str) -> None:
    tables = [
        each for each in library_tables().values() if each.topic == topic and table_cases.cases_file(each).exists()
    ]
    wrong = [result.message for each in tables for result in table_cases.run_table_cases(each) if not result.ok]
    assert tables
    assert wrong == []


def test_every_public_table_has_cases() -> None:
    public = [each for each in library_tables().values() if not each.is_private]
    assert [each.name for each in public if not table_cases.cases_file(each).exists()] == []


def test_every_cases_file_belongs_to_a_table() -> None:
    (some, *_) = library_tables().values()
    files = (some.path.parents[1]).glob("*/*.cases.yml")
    assert [file for file in files if not file.with_name(file.name.replace(".cases.yml", ".sql")).exists()] == []


def test_rows_that_agree_pass(tmp_path: Path) -> None:
    (result,) = table_cases.run_table_cases(table(tmp_path))
    assert (result.name, result.ok, result.message) == ("two speeds", True, "")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("0.3: true", "0.2: true"), "expected is_on: true, got false"),
        (("{else: false, 0.3: true}", "null"), "expected is_on: null, got false: {drive_id: d, ego_id: e, t_s: 0.1, "),
        (("0.1..0.3 by 0.1", "[0.1, 0.2, 0.35]"), "expected t_s: 0.35, got 0.3: "),
        (("0.1..0.3", "0..0.3"), "expected 4 rows, got 3"),
        (("expect: {t_s: 0.1..0.3 by 0.1, is_on: {else: false, 0.3: true}}", "expect: []"), "expected 0 rows, got 3"),
    ],
)
def test_rows_that_differ_are_told(tmp_path: Path, change: tuple[str, str], message: str) -> None:
    (result,) = table_cases.run_table_cases(table(tmp_path, CASES.replace(*change)))
    assert not result.ok
    assert message in result.message
    assert result.message.startswith(f"{tmp_path / 'ego_mode.cases.yml'}:2: case 'two speeds': ")


def test_null_in_a_column_that_is_declared_not_null_is_told(tmp_path: Path) -> None:
    select = SELECT.replace("'automated_driving' AS mode", "NULL AS mode")
    (result,) = table_cases.run_table_cases(table(tmp_path, CASES, select))
    assert "mode is declared NOT NULL, but is NULL: {drive_id: d, ego_id: e, t_s: 0.1" in result.message


def test_every_case_is_a_drive_of_its_own(tmp_path: Path) -> None:
    """A SELECT that mixes drives gives other rows for two cases than for one."""
    select = SELECT.replace("FROM ego_state", "FROM ego_state QUALIFY").replace(
        "QUALIFY WHERE speed_mps >= 0.5", "WHERE speed_mps >= 0.5 QUALIFY t_ns = min(t_ns) OVER ()"
    )
    first = CASES.replace("0.1..0.3 by 0.1, is_on: {else: false, 0.3: true}", "0.1, is_on: false")
    later = first.replace("two speeds", "later").replace("t_s: 0..0.3", "t_s: 1..1.3").replace("t_s: 0.1,", "t_s: 1.1,")
    assert [result.ok for result in table_cases.run_table_cases(table(tmp_path, first, select))] == [True]
    assert [result.ok for result in table_cases.run_table_cases(table(tmp_path, first + later, select))] == [
        True,
        False,
    ]


def test_a_select_from_a_table_that_there_is_not_is_refused(tmp_path: Path) -> None:
    wrong = table(tmp_path, select=SELECT.replace("ego_state", "ego_stat"))
    with pytest.raises(RuleError, match=r"ego_mode\.sql: there is no table 'ego_stat': did you mean 'ego_state'\?"):
        table_cases.run_table_cases(wrong)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("ego_state:", "lead:"), "given: ego_mode does not read 'lead'; it reads ego_state"),
        (("speed_mps: [", "sped_mps: ["), "given: ego_state has no column 'sped_mps'; did you mean 'speed_mps'?"),
        (("is_on: {", "is_onn: {"), "expect has no column 'is_onn'; did you mean 'is_on'?"),
        (("given:", "givn:"), "unknown field `givn`; did you mean 'given'?"),
    ],
)
def test_what_cannot_be_understood_is_refused(tmp_path: Path, change: tuple[str, str], message: str) -> None:
    with pytest.raises(RuleError) as refused:
        table_cases.run_table_cases(table(tmp_path, CASES.replace(*change)))
    assert str(refused.value).startswith(f"{tmp_path / 'ego_mode.cases.yml'}:2: case 'two speeds'")
    assert message in str(refused.value)


def test_an_empty_table_of_one_case_leaves_the_rows_of_the_others(tmp_path: Path) -> None:
    empty = "\n- name: no step\n  given: {ego_state: []}\n  expect: []\n"
    assert [result.ok for result in table_cases.run_table_cases(table(tmp_path, CASES + empty))] == [True, True]


def test_a_table_without_cases_is_refused(tmp_path: Path) -> None:
    alone = table(tmp_path)
    table_cases.cases_file(alone).unlink()
    with pytest.raises(RuleError, match="table ego_mode has no cases: write some in this file"):
        table_cases.read_table_cases(alone)


def test_mutants_that_no_case_notices_survive(tmp_path: Path) -> None:
    """0.4 and 0.6 notice neither 0.45 nor 0.55; 1.9 and 2.1 notice both 1.8 and 2.2."""
    found = table_mutation.judge_table_mutants(table(tmp_path))
    assert (found.n, found.problem) == (6, "")
    assert found.survivors == ("0.5 * 0.9", "0.5 * 1.1")
    near = CASES.replace("0.4, 0.6", "0.48, 0.52")
    assert table_mutation.judge_table_mutants(table(tmp_path, near)).survivors == ()


def test_listed_survivors_are_no_failure(tmp_path: Path) -> None:
    entries = [
        f'[[survivor]]\nrule = "ego_mode"\nmutant = "0.5 * {factor}"\nreason = "r"\n' for factor in ("0.9", "1.1")
    ]
    (tmp_path / "survivors.toml").write_text("\n".join(entries), encoding="utf-8")
    found = table_mutation.judge_table_mutants(table(tmp_path))
    assert found.ok
    assert found.n_noticed == 4


def test_a_table_that_fails_its_cases_has_a_problem(tmp_path: Path) -> None:
    found = table_mutation.judge_table_mutants(table(tmp_path, CASES.replace("0.3: true", "0.2: true")))
    assert "the table itself" in found.problem
    assert not found.ok


@pytest.mark.parametrize("printed_sql", ["SELECT FROM", "FROM ego_mode"])
def test_a_select_that_is_printed_with_another_meaning_has_a_problem(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, printed_sql: str
) -> None:
    """DuckDB prints a comma for CROSS JOIN: all mutants of such a SELECT were invalid, and counted as none."""
    monkeypatch.setattr(table_mutation, "printed_select", lambda _: printed_sql)
    found = table_mutation.judge_table_mutants(table(tmp_path))
    assert "printed by DuckDB, the SELECT has another meaning" in found.problem
    assert not found.ok


def test_a_table_without_cases_is_no_success_of_a_glob(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    lacking = LibraryTable("ego_mode", "log", tmp_path / "ego_mode.sql", "", "", SELECT)
    monkeypatch.setattr(
        commands, "library_tables", lambda: {"ego_mode": lacking, "ego_lane": library_tables()["ego_lane"]}
    )
    told: list[str] = []
    assert commands.table_case_test(["ego_*"], told.append) == ExitCode.USAGE
    assert "table ego_mode has no cases" in told[0]
    assert commands.table_mutation_test(["ego_*"], told.append) == ExitCode.FAILED


def test_commands_tell_each_table() -> None:
    told: list[str] = []
    assert commands.table_case_test(["ego_lane"], told.append) == ExitCode.OK
    assert told == ["ok   ego_lane: 13 of 13 cases"]
    assert commands.table_mutation_test(["ego_lane"], told.append) == ExitCode.OK
    assert told[1:] == ["ok   ego_lane: 11 of 11 mutants noticed", "1 table: 11 of 11 mutants noticed (100.0%)"]
    with pytest.raises(UsageError, match="did you mean 'ego_lane'"):
        commands.table_case_test(["ego_lan"], told.append)


@pytest.mark.parametrize(
    ("path", "name"), [("others/cut_in.sql", "cut_in"), ("others/cut_in.cases.yml", "cut_in"), ("others", "'\\*'")]
)
def test_who_tests_a_table_as_a_rule_is_told_how(path: str, name: str) -> None:
    (some, *_) = library_tables().values()
    with pytest.raises(UsageError, match=f"the library has tables, not rules: drivelint rules test --table {name}$"):
        commands.case_test(some.path.parents[1] / path, (), print)


def test_a_second_place_with_the_same_words_is_explained(tmp_path: Path) -> None:
    select = SELECT.replace("speed_mps > 2.0", "speed_mps >= 0.5")
    cases = CASES.replace("{else: false, 0.3: true}", "true")
    said = mutation.result_text(table_mutation.judge_table_mutants(table(tmp_path, cases, select)))
    assert "#2\n     #2 and so on: another place of the SQL with the same words\n     add a case" in said
    once = mutation.result_text(table_mutation.judge_table_mutants(table(tmp_path)))
    assert "#2" not in once
