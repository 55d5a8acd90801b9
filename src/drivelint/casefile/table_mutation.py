"""Judges each mutant of a library table's SELECT by the cases of the table, and counts the mutants that at least one case notices.

A mutant has one comparison reversed, or one constant times 0.9 or 1.1. It is noticed if the rows of a case differ from `expect`. If no
case can notice it, `survivors.toml` in the folder of the table's topic lists it, as it does for rules.
"""

from __future__ import annotations

from contextlib import contextmanager
from threading import Timer
from typing import TYPE_CHECKING, Final

import duckdb

from drivelint.casefile.mutants import mutants_of_select, printed_select
from drivelint.casefile.mutation import SURVIVORS_FILE, MutationResult, read_survivors
from drivelint.casefile.scene import case_database
from drivelint.casefile.table_cases import FilledCases, read_table_cases, rows_difference
from drivelint.errors import RuleError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from drivelint.casefile.table_cases import CompleteCase
    from drivelint.sql.library import LibraryTable

_MOST_SECONDS: Final = 20.0
"""A mutant whose SELECT takes longer is noticed: a reversed comparison can make a recursion endless."""


def judge_table_mutants(table: LibraryTable) -> MutationResult:
    """Judge every mutant of a table's SELECT by the table's cases."""
    listed: tuple[str, ...] = ()
    survivors: list[str] = []
    n, problem = 0, ""
    try:
        entries = read_survivors(table.path.parent / SURVIVORS_FILE)
        listed = tuple(entry.mutant for entry in entries if entry.rule == table.name)
        cases = read_table_cases(table)
        filled = FilledCases(table, cases)
        try:
            if message := first_difference(table, cases, filled, table.select):
                raise RuleError(f"{message} (the table itself: see rules test --table {table.name})")
            if first_difference(table, cases, filled, printed_select(table.select)) != "":
                raise RuleError(
                    f"{table.path}: printed by DuckDB, the SELECT has another meaning: no mutant can be judged"
                )
            for fault, select in mutants_of_select(table.select):
                difference = first_difference(table, cases, filled, select)
                if difference is not None:  # else the mutant is no valid SQL
                    n += 1
                    survivors += [] if difference else [fault]
        finally:
            filled.clear()
    except RuleError as error:
        problem = str(error)
    return MutationResult(table.name, True, n, tuple(survivors), listed, problem)


def first_difference(
    table: LibraryTable, cases: Sequence[CompleteCase], filled: FilledCases, select: str
) -> str | None:
    """Return the first difference of the rows from the expected ones, '' if there is none, or None if the SELECT is not valid."""
    try:
        with _interrupt_after(_MOST_SECONDS):
            rows = filled.rows_by_case(select)
    except duckdb.InterruptException:
        return "takes too long"
    except duckdb.ProgrammingError:
        return None
    except duckdb.Error:
        return "fails on these rows"
    messages = (rows_difference(table.name, case.expected_rows, rows.get(case.numbered.no, [])) for case in cases)
    return next((message for message in messages if message), "")


@contextmanager
def _interrupt_after(seconds: float) -> Iterator[None]:
    timer = Timer(seconds, case_database().interrupt)
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
