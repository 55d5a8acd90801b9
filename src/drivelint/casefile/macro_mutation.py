"""Judges each mutant of a macro by the cases of all tables and rules that call it, and counts the mutants that at least one case notices.

The mutants of a table or rule scale a macro without arguments where it is used. These mutants change a number or a comparison inside a
macro with arguments. If no case can notice one, `survivors.toml` beside the macros lists it under the name of the macro.
"""

from __future__ import annotations

from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import duckdb

from drivelint.casefile import case_location, first_unexpected_merged_case, numbered_cases, read_cases
from drivelint.casefile.merged_cases import judge, merge_cases, mergeable_groups
from drivelint.casefile.mutants import mutants_of_select, printed_select
from drivelint.casefile.mutation import SURVIVORS_FILE, MutationResult, read_survivors
from drivelint.casefile.scene import case_database
from drivelint.casefile.table_cases import FilledCases, read_table_cases
from drivelint.casefile.table_mutation import first_difference
from drivelint.errors import RuleError
from drivelint.resources import folder
from drivelint.sql.macro_trees import macro, macro_texts
from drivelint.sql.syntax import syntax_tree, walk

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
    from contextlib import AbstractContextManager

    from drivelint.casefile import Case
    from drivelint.casefile.merged_cases import NumberedCase, Scene
    from drivelint.catalogue import Rule
    from drivelint.sql.library import LibraryTable

    CaseDifference = Callable[[], str | None]
    """Returns the first difference of the cases from what they expect; '' if there is none, None if the SQL is not valid."""


class MacroMutant(NamedTuple):
    """A macro with one deliberate fault: its name, a text that identifies the fault, and its value."""

    macro: str
    fault: str
    value: str


def macro_mutants() -> list[MacroMutant]:
    """Return the mutants of all macros with arguments: comparisons reversed, and thresholds times 0.9 and 1.1."""
    return [
        MacroMutant(name, fault, select.removeprefix("SELECT "))
        for name, (parameters, value) in macro_texts().items()
        if parameters.strip() and macro(name) is not None
        for fault, select in mutants_of_select(f"SELECT {value}")
    ]


def judge_macro_mutants(
    mutants: Sequence[MacroMutant], tables: Sequence[LibraryTable], rules: Sequence[Rule]
) -> tuple[list[MutationResult], list[str]]:
    """Judge the mutants by the cases of the tables and rules that call the macro.

    Return a result for each macro, and the macros that no table or rule calls: their mutants cannot be judged. Errors: `RuleError` for a
    table or rule that fails its own cases.
    """
    remaining, judged_macros, valid = list(mutants), set[str](), set[MacroMutant]()
    for macros, cases in _users(tables, rules):
        judged_macros |= macros
        own_mutants = [mutant for mutant in remaining if mutant.macro in macros]
        if not own_mutants:
            continue
        with cases as difference:
            if message := difference():
                raise RuleError(f"{message} (without any mutant: see rules test)")
            if message := _difference_with(
                {mutant.macro: _printed_value(mutant.macro) for mutant in own_mutants}, difference
            ):
                raise RuleError(f"{message} (printed by DuckDB, a macro has another meaning: no mutant can be judged)")
            differences = {mutant: _difference_with({mutant.macro: mutant.value}, difference) for mutant in own_mutants}
        valid |= {mutant for mutant in own_mutants if differences[mutant] is not None}
        remaining = [mutant for mutant in remaining if not differences.get(mutant)]
    entries = read_survivors(folder("queries") / "macros" / SURVIVORS_FILE)
    names = dict.fromkeys([*(mutant.macro for mutant in mutants), *(entry.rule for entry in entries)])
    results = [
        MutationResult(
            name,
            True,
            sum(mutant.macro == name for mutant in valid),
            tuple(mutant.fault for mutant in remaining if mutant.macro == name and mutant in valid),
            tuple(entry.mutant for entry in entries if entry.rule == name),
        )
        for name in names
        if name in judged_macros or name not in macro_texts()
    ]
    return results, sorted({mutant.macro for mutant in mutants} - judged_macros)


def _users(
    tables: Sequence[LibraryTable], rules: Sequence[Rule]
) -> Iterator[tuple[frozenset[str], AbstractContextManager[CaseDifference]]]:
    """Yield the macros that each table and rule calls, and its cases."""
    for table in tables:
        yield _called_macros([table.select]), _cases_of_table(table)
    for rule in rules:
        yield _called_macros(rule.sections.values()), _cases_of_rule(rule)


def _called_macros(queries: Collection[str]) -> frozenset[str]:
    """Return the macros that SELECTs call, and the macros that these call."""
    macros: set[str] = set()
    todo = list(queries)
    while todo:
        calls = {
            node["function_name"].lower()
            for node, _ in walk(syntax_tree(todo.pop()))
            if node.get("class") == "FUNCTION"
        }
        new = (calls & macro_texts().keys()) - macros
        macros |= new
        todo += [f"SELECT {macro_texts()[name][1]}" for name in new if macro(name) is not None]
    return frozenset(macros)


@contextmanager
def _cases_of_table(table: LibraryTable) -> Iterator[CaseDifference]:
    cases = read_table_cases(table)
    filled = FilledCases(table, cases)
    try:
        yield partial(first_difference, table, cases, filled, table.select)
    finally:
        filled.clear()


@contextmanager
def _cases_of_rule(rule: Rule) -> Iterator[CaseDifference]:
    cases = read_cases(rule)
    groups = mergeable_groups(numbered_cases(rule, cases), "drive_id")
    yield partial(_difference_of_rule, rule, cases, [(group, merge_cases(group, "drive_id")) for group in groups])


def _difference_of_rule(
    rule: Rule, cases: Sequence[Case], groups: Sequence[tuple[list[NumberedCase], Scene]]
) -> str | None:
    for group, scene in groups:
        outcome = judge([rule], scene, group[0].params)[rule.id]
        if all(row["verdict"] == "error" for row in outcome.verdicts):
            return None
        if wrong := first_unexpected_merged_case(cases, group, outcome):
            return f"{case_location(rule, wrong[0])}: {wrong[1]}"
    return ""


def _difference_with(values: Mapping[str, str], difference: CaseDifference) -> str | None:
    """Return the difference of the cases if macros have these values; None if the SQL is then not valid."""
    try:
        for name, value in values.items():
            _replace_macro(name, value)
        return difference()
    except duckdb.ProgrammingError:
        return None
    finally:
        for name in values:
            _replace_macro(name, macro_texts()[name][1])


def _printed_value(name: str) -> str:
    return printed_select(f"SELECT {macro_texts()[name][1]}").removeprefix("SELECT ")


def _replace_macro(name: str, value: str) -> None:
    case_database().execute(f"CREATE OR REPLACE MACRO {name}({macro_texts()[name][0]}) AS {value}")
