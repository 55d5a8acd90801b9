"""Runs the commands for authors of rules: create a rule, test rules by their cases, test cases by mutants.

An invalid rule is refused with `file:line: message`, and the other rules are still tested. Unlike `check`, these commands do not load
the shipped rules if a folder is given, so the folder may contain copies of shipped rules.
"""

from __future__ import annotations

import os
import re
from contextlib import suppress
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Final

import duckdb

from drivelint.casefile import mutation, run_cases
from drivelint.casefile.binding_errors import unknown_columns
from drivelint.casefile.macro_mutation import judge_macro_mutants, macro_mutants
from drivelint.casefile.scene import case_database
from drivelint.casefile.table_cases import run_table_cases
from drivelint.casefile.table_mutation import judge_table_mutants
from drivelint.catalogue import read_rule
from drivelint.catalogue.check import error_message, line_of_error
from drivelint.catalogue.load import rule_files, rule_id_of
from drivelint.catalogue.rule_file import PACK_NAME, RULE_NAME, in_order_of_lines
from drivelint.errors import ExitCode, RuleError, UsageError
from drivelint.evaluate import query_plans
from drivelint.phrases import hint
from drivelint.resources import folder
from drivelint.sql.library import library_tables

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path
    from threading import Event

    from drivelint.casefile import CaseResult
    from drivelint.catalogue import Rule
    from drivelint.sql.library import LibraryTable

    Say = Callable[[str], None]

_CHANGED_FILES_CHECK_PERIOD_S: Final = 0.5
"""The time between two checks of `repeat_tests_on_changes` for changed files."""


def write_new_rule(rule_id: str, root: Path, kind: str) -> tuple[Path, Path]:
    """Write a small runnable rule of this kind and its cases into `<root>/<pack>/`, for an author to edit.

    Return both paths. Errors: `UsageError` if the id is not valid or belongs to a shipped rule, or if one of the files exists.
    """
    pack, dot, name = rule_id.partition(".")
    if not (dot and PACK_NAME.fullmatch(pack) and RULE_NAME.fullmatch(name)):
        raise UsageError(
            f"{rule_id!r} is no rule id: write PACK.NAME in lower-case letters, digits, '-' and '_' (and '.' in the name), "
            "such as mine.r124.speed"
        )
    shipped = folder("queries") / "assertions" / pack / f"{name}.sql"
    if shipped.exists():
        raise UsageError(f"rule {rule_id} is shipped already ({shipped}): give yours another name or pack")
    sql = root / pack / f"{name}.sql"
    cases = sql.with_suffix(".cases.yml")
    for file in (sql, cases):
        if file.exists():
            raise UsageError(f"{file} is there already: nothing was written")
    try:
        sql.parent.mkdir(parents=True, exist_ok=True)
        for file, suffix in ((sql, ".sql"), (cases, ".cases.yml")):
            text = (folder("queries") / "skeletons" / f"{kind}{suffix}").read_text(encoding="utf-8")
            with file.open("x", encoding="utf-8") as output:
                output.write(text)
    except OSError as error:
        raise UsageError(f"{sql.parent}: cannot write there: {error.strerror}") from error
    return sql, cases


def case_test(root: Path | None, rule_globs: Sequence[str], print_line: Say) -> ExitCode:
    """Judge each rule by its cases, and print a line for each rule and for each failed case.

    Return USAGE if a rule or its cases were refused, else FAILED if a case failed.
    """
    code = ExitCode.OK
    for rule in _read_selected_rules(root, rule_globs):
        try:
            if isinstance(rule, RuleError):
                raise rule
            results = run_cases(rule)
        except RuleError as error:
            print_line(f"REFUSED {error}")
            code = ExitCode.USAGE
            continue
        code = max(code, _print_results(rule.id, results, "checks", print_line))
    return code


def _print_results(name: str, results: Sequence[CaseResult], noun: str, print_line: Say) -> ExitCode:
    """Print a line for a rule or table, and one for each failed case; return FAILED if a case failed."""
    failed = [f"     {result.message}" for result in results if not result.ok]
    first = f"{'FAIL' if failed else 'ok  '} {name}: {len(results) - len(failed)} of {len(results)} {noun}"
    print_line("\n".join([first, *failed]))
    return ExitCode.FAILED if failed else ExitCode.OK


def table_case_test(table_globs: Sequence[str], print_line: Say) -> ExitCode:
    """Run the cases of the library tables, and print a line for each table and each failed case.

    Return USAGE if cases cannot be used or are missing, else FAILED if a case failed. Errors: `UsageError` for a name that no table has.
    """
    code = ExitCode.OK
    for table in _selected_tables(table_globs):
        try:
            results = run_table_cases(table)
        except RuleError as error:
            print_line(f"REFUSED {error}")
            code = ExitCode.USAGE
            continue
        code = max(code, _print_results(table.name, results, "cases", print_line))
    return code


def table_mutation_test(table_globs: Sequence[str], print_line: Say) -> ExitCode:
    """Judge the mutants of the library tables by their cases, and print a line for each table and each survivor.

    With the glob `*`, also the mutants of the macros with arguments, by the cases of all tables and shipped rules.
    Return FAILED if a mutant survives that is not listed, or cases are missing. Errors: as those of `table_case_test`, and `RuleError`
    if the cases cannot judge macros, because some fail without any mutant.
    """
    results = []
    for table in _selected_tables(table_globs):
        results.append(judge_table_mutants(table))
        print_line(mutation.result_text(results[-1]))
    print_line(mutation.summary_line(results, "table"))
    if "*" in table_globs:
        shipped = [read_rule(file) for file in _rule_files(None)]
        macros, uncalled = judge_macro_mutants(macro_mutants(), list(library_tables().values()), shipped)
        for result in macros:
            print_line(mutation.result_text(result))
        if uncalled:
            print_line(f"not judged, because no table and no rule calls them: {', '.join(uncalled)}")
        print_line(mutation.summary_line(macros, "macro"))
        results += macros
    return ExitCode.OK if all(result.ok for result in results) else ExitCode.FAILED


def _selected_tables(table_globs: Sequence[str]) -> list[LibraryTable]:
    for glob in table_globs:
        if not any(fnmatchcase(name, glob) for name in library_tables()):
            raise UsageError(f"--table {glob}: no library table has this name; {hint(glob, library_tables())}")
    return [table for table in library_tables().values() if any(fnmatchcase(table.name, glob) for glob in table_globs)]


def repeat_tests_on_changes(
    test: Callable[[Path | None, Sequence[str], Say], ExitCode],
    root: Path | None,
    rule_globs: Sequence[str],
    print_line: Say,
    stop: Event,
) -> ExitCode:
    """Test the rules, then, until `stop` is set, each rule whose file or cases change; return the code of the last test."""
    code, before = test(root, rule_globs, print_line), _change_times(root)
    print_line("waiting for changes; press Ctrl-C to end")
    while not stop.wait(_CHANGED_FILES_CHECK_PERIOD_S):
        now = _change_times(root)
        changed_files = {_rule_file_of(file) for file, _ in now.items() ^ before.items()}
        before = now
        for file in sorted(file for file in changed_files if file.is_file() and _is_selected(file, rule_globs)):
            code = test(file, (), print_line)
    return code


def _change_times(root: Path | None) -> dict[Path, int]:
    """Return the times of the last change of all files of rules and cases; a file that is being replaced is left out."""
    times = {}
    for file in _rule_files(root):
        for path in (file, file.with_suffix(".cases.yml")):
            with suppress(OSError):
                times[path] = path.stat().st_mtime_ns
    return times


def mutation_test(root: Path | None, rule_globs: Sequence[str], print_line: Say) -> ExitCode:
    """Judge each rule's mutants by its cases, and print the counts and the mutants that no case noticed.

    Return USAGE if a rule was refused, else FAILED if a mutant of a stable rule survives without being listed, or a list is outdated.
    """
    rules_and_errors = list(_read_selected_rules(root, rule_globs))
    errors = [error for error in rules_and_errors if isinstance(error, RuleError)]
    rules = [rule for rule in rules_and_errors if not isinstance(rule, RuleError)]
    for error in errors:
        print_line(f"REFUSED {error}")
    results = []
    for result in mutation.judge_all_mutants(rules, os.cpu_count() or 1):
        print_line(mutation.result_text(result))
        results.append(result)
    is_part = bool(rule_globs) or (root is not None and root.is_file())
    strange = [] if is_part or errors else mutation.unknown_rule_messages(rules)
    for line in strange:
        print_line(f"FAIL {line}")
    print_line(mutation.summary_line(results))
    enough = is_part or mutation.noticed_share(results) >= mutation.LEAST_NOTICED_SHARE
    good = enough and not strange and all(result.ok for result in results)
    return ExitCode.USAGE if errors else ExitCode.OK if good else ExitCode.FAILED


def _read_selected_rules(root: Path | None, rule_globs: Sequence[str]) -> Iterator[Rule | RuleError]:
    """Yield the rules of a folder (None: the shipped rules) that `rule_globs` selects; for an invalid rule, yield the error.

    `root` may also be the file of one rule, or of its cases. Errors: `UsageError` if `rule_globs` selects no rule.
    """
    files = _rule_files(root)
    selected_files = [file for file in files if _is_selected(file, rule_globs)]
    if not selected_files:
        raise UsageError(f"--rules {', '.join(rule_globs)}: none of the {len(files)} rules here has such an id")
    for file in selected_files:
        try:
            rule = read_rule(file)
        except RuleError as error:
            problems = [*str(error).split("\n"), *(unknown_columns(file) if file.is_file() else ())]
            yield RuleError("\n".join(in_order_of_lines(list(dict.fromkeys(problems)), file)))
            continue
        try:
            _check_query_plans(rule)
        except RuleError as error:
            yield error
        else:
            yield rule


def _rule_files(root: Path | None) -> Sequence[Path]:
    """Return the rule files of a folder, or of a file of a rule or its cases. Errors: `UsageError` for another file, and for a table."""
    library = (folder("queries") / "library").resolve()
    if root is not None and library in (root.resolve(), *root.resolve().parents):
        name = "'*'" if root.is_dir() else _rule_file_of(root).stem
        raise UsageError(f"{root}: the library has tables, not rules: drivelint rules test --table {name}")
    if root is None or not root.is_file():
        return rule_files(root or folder("queries") / "assertions")
    if not _rule_file_of(root).is_file():
        raise UsageError(f"{root}: neither a rule nor the cases of a rule: name PACK/NAME.sql, or a folder of packs")
    return [_rule_file_of(root)]


def _rule_file_of(file: Path) -> Path:
    """Return the rule's file, given that file or the file of the rule's cases."""
    return file.with_name(file.name.removesuffix(".cases.yml").removesuffix(".sql") + ".sql")


def _is_selected(file: Path, rule_globs: Sequence[str]) -> bool:
    return not rule_globs or any(fnmatchcase(rule_id_of(file), name) for name in rule_globs)


def _check_query_plans(rule: Rule) -> None:
    """Raise `RuleError` if the rule's SQL does not fit the tables, or has a join that compares every row with every other row."""
    try:
        plans = query_plans(case_database(), rule)
    except duckdb.Error as error:
        line = line_of_error(error, rule.path.read_text(encoding="utf-8"))
        first = f"{rule.path}:{line or 1}: {error_message(error)}"
        raise RuleError("\n".join(in_order_of_lines(unknown_columns(rule.path) or [first], rule.path))) from error
    for plan in plans:
        _, join, below = plan.partition("BLOCKWISE_NL_JOIN")
        tables = " and ".join(name for name in rule.reads if re.search(rf"\.{name}\b", below)) or "two tables"
        if join:
            raise RuleError(
                f"{rule.path}:1: a join of {tables} compares every row with every other (BLOCKWISE_NL_JOIN): join on keys, and move "
                "what is no comparison into a WHERE or into branches of a UNION ALL; in a LEFT JOIN each inequality must have columns "
                "of one table on each side; for a state since a time use ASOF LEFT JOIN"
            )
