"""Reads and runs `<rule>.cases.yml`, the regression cases beside every rule.

The file is a list of cases. Each case gives a small scene as rows of tables, and states the expected verdicts:

    - name: faster than the limit            # shows: violation, if the name does not say it
      given:
        step: {t_s: 0..10 by 0.1}
        ego_state: {t_s: 0..10 by 0.1, speed_mps: {else: 12, 5.0..5.3: 14}, limit_mps: 13.4}
      params: {tolerance_mps: 0.2}           # optional
      missing: [indicator]                   # signals that the log lacks; other required signals are present
      expect: [{verdict: fail, t_worst_s: 5.0, margin: -0.6}]
      findings: 1                            # optional

* `given`: for each table, a block or a list of blocks. A column is a scalar (broadcast), a list, a range `a..b by c`
  (both ends included) or `a..b` (spread over the block's length), or by time `{else: v, 5.0..5.3: w, 7.2: u}`. `t_s`
  in seconds may replace `t_ns`. Columns that must not be NULL have defaults (drive 'd', ego 'e'); other columns are
  NULL.
* `step`: only `t_s` is needed. Without this table, the steps are the times in tables with a row per step, or else the
  times of events. `clock` and the other columns of `step` are computed (a gap is longer than 2.5 median periods); a
  block such as `clock: {max_gap_s: 1}` replaces the computed value.
* `ego_condition`: the conditions that rules with `[applies]` need. In rows without `engaged`, and at steps without a
  row, the automated driver drives (`engaged: true`); other conditions that are not given are not known.
* `expect`: one verdict, which every row must have, or a list of all rows in order of time, profile and object. Each row
  has the columns to compare (`t_worst_s` for `t_worst_ns`; a part of `reason` is enough). Numbers must agree to the
  written decimals, at least two: 12 means 12.00.
* The cases of a rule must show `clean`, `violation`, `boundary`, `not_applicable` and `unknown`. A case shows the
  categories in its name, or in `shows:`.
"""

from __future__ import annotations

import json
import re
from contextlib import contextmanager
from decimal import Decimal
from math import isinf
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from drivelint.casefile import merged_cases
from drivelint.casefile.case_list import parse_cases_file
from drivelint.casefile.scene import Row, column_and_factor, complete_scene, refuse_wrong_word
from drivelint.catalogue.check import collect_problems, raise_problems
from drivelint.catalogue.rule_file import in_order_of_lines
from drivelint.catalogue.rule_words import parameter_problem
from drivelint.errors import RuleError
from drivelint.phrases import nearest_word
from drivelint.reasons.reason_text import code_and_nested_codes
from drivelint.sql.words import vocabularies

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from collections.abc import Set as AbstractSet
    from pathlib import Path

    from drivelint.catalogue import Rule

CATEGORIES = ("clean", "violation", "boundary", "not_applicable", "unknown")


class CaseResult(NamedTuple):
    """The result of one case: its name, whether the outcome is as expected, and the difference if not."""

    name: str
    ok: bool
    message: str


class Case(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """One case as written in the file."""

    name: str
    given_tables: dict[str, Any] = msgspec.field(name="given")
    expect: str | list[dict[str, Any]]
    shows: str | tuple[str, ...] = ()
    params: dict[str, Any] = {}
    missing_signals: tuple[str, ...] = msgspec.field(default=(), name="missing")
    findings: int | None = None
    line: int = 0
    """The case's line in the file, set by the reader."""

    def categories(self) -> set[str]:
        """Return the categories that this case shows: those in `shows`, or else those of `CATEGORIES` in its name."""
        names = {self.shows} if isinstance(self.shows, str) else set(self.shows)
        words = re.sub(r"[\s_-]+", "_", self.name.lower())
        return names or {name for name in CATEGORIES if re.search(rf"(^|_){name}(_|$)", re.sub(r"[^a-z_]", "", words))}


def read_cases(rule: Rule) -> list[Case]:
    """Read the rule's cases.

    Errors: `RuleError` if the file is missing, is not YAML, or is not a valid list of cases.
    """
    file = cases_path(rule)
    if not file.exists():
        raise RuleError(
            f"{file}:1: rule {rule.id} has no cases; write clean, violation, boundary, not applicable and unknown"
        )
    cases, problems = parse_cases_file(file, Case)
    problems += _case_problems(rule, cases)
    if problems:
        for case in cases:
            with collect_problems(problems), _add_location_to_errors(rule, case):
                merged_cases.judge([], complete_scene(rule, case.given_tables, case.missing_signals), {})
    raise_problems(in_order_of_lines(problems, file))
    return cases


def _case_problems(rule: Rule, cases: Sequence[Case]) -> list[str]:
    """Return the problems of the cases without those of their scenes, each with file, line and case."""
    problems: list[str] = []
    case_by_name: dict[str, Case] = {}
    for case in cases:
        first = case_by_name.setdefault(case.name, case)
        if first is not case:
            place = f"{cases_path(rule)}:{case.line}"
            problems.append(f"{place}: case {case.name!r} has the name of the case in line {first.line}")
        with collect_problems(problems), _add_location_to_errors(rule, case):
            raise_problems([*_unknown_names(rule, case), *_wrong_words(rule, case)])
    return problems


def _unknown_names(rule: Rule, case: Case) -> Iterator[str]:
    """Yield the parameters and missing signals of a case that the rule does not have."""
    param_names = ", ".join(rule.params) or "none"
    for name in sorted(case.params.keys() - rule.params.keys()):
        near = nearest_word(name, rule.params)
        advice = f"did you mean {near!r}?" if near else f"it has: {param_names}"
        yield f"params: {rule.id} has no parameter {name!r}; {advice}"
    if "capability" not in rule.reads:
        idle = [signal for signal in case.missing_signals if signal not in rule.requires]
        yield from (f"missing: {rule.id} does not require {signal!r}" for signal in idle if not _signal_problem(signal))


def _wrong_words(rule: Rule, case: Case) -> Iterator[str]:
    """Yield the unknown words in `expect` or `missing`, and in parameters that the rule compares with a column of words."""
    expected_rows = [{"verdict": case.expect}] if isinstance(case.expect, str) else case.expect
    for row in expected_rows:
        for name, value in row.items():
            try:
                refuse_wrong_word("verdict", column_and_factor("verdict", name, "expect")[0], value, "expect")
            except RuleError as error:
                yield str(error)
    for name, value in case.params.items():
        if problem := parameter_problem(rule.sections, name, value):
            yield f"params.{name}: {problem}"
    for signal in case.missing_signals:
        if problem := _signal_problem(signal):
            yield f"missing: {problem}"


def _signal_problem(signal: str) -> str | None:
    return vocabularies()["signal"].problem(signal)


def cases_path(rule: Rule) -> Path:
    """Return the file of a rule's cases."""
    return rule.path.with_suffix(".cases.yml")


def run_cases(rule: Rule) -> list[CaseResult]:
    """Run the rule's cases and return their results, in order, and results about all cases together.

    If all cases pass alone, they are judged together, as drives of one database and as egos of one drive, and must give the same
    outcomes. Two more results state whether the cases show all categories, and all reasons that the rule can give.

    Errors: `RuleError` for a cases file that cannot be read.
    """
    cases = read_cases(rule)
    results: list[CaseResult] = []
    problems: list[str] = []
    for case in cases:
        with collect_problems(problems):
            results.append(run_case(rule, case))
    raise_problems(problems)
    if all(result.ok for result in results):  # else judging them together gives no new information
        mixed, codes = first_problem_and_reason_codes_of_merged_cases(rule, cases)
        never = unused_reasons_message(rule, codes)
        results += [CaseResult("all cases together", not mixed, mixed), CaseResult("reasons", not never, never)]
    problem = coverage_problem(cases)
    return [*results, CaseResult("kinds of case", not problem, problem and f"{cases_path(rule)}:{problem}")]


def unused_reasons_message(rule: Rule, codes: AbstractSet[str]) -> str:
    """Return a message with the reasons that the rule's SQL can give but no case gave (`codes`: reasons in the cases); '' for none."""
    never = sorted(rule.reason_codes - codes)
    return f"{cases_path(rule)}:1: no case has the reason {', '.join(never)}" if never else ""


def coverage_problem(cases: Sequence[Case]) -> str:
    """Return the first problem with the cases' categories as `LINE: message`; '' if they show every category."""
    for case in cases:
        if unknown := sorted(case.categories() - set(CATEGORIES)):
            return f"{case.line}: shows: {unknown[0]!r} is not one of {', '.join(CATEGORIES)}"
    shown_names = {name for case in cases for name in case.categories()}
    if lacking := [name for name in CATEGORIES if name not in shown_names]:
        return f"1: no case shows: {', '.join(lacking)}"
    honest = {"clean": "pass", "violation": "fail", "not_applicable": "not_applicable", "unknown": "unknown"}
    for case in cases:
        verdicts = {case.expect} if isinstance(case.expect, str) else {row.get("verdict") for row in case.expect}
        for name in sorted(case.categories() & honest.keys()):
            if honest[name] not in verdicts:
                return f"{case.line}: case {case.name!r} shows {name} but expects no {honest[name]}"
    return ""


def run_case(rule: Rule, case: Case) -> CaseResult:
    """Judge one case by this rule alone, and compare the outcome with `expect`. Errors: `RuleError` with file, line and case."""
    with _add_location_to_errors(rule, case):
        message = outcome_difference(case, judge_case(rule, case))
    of_pairs = rule.kind == "invariant" and rule.per_object and "applies" not in rule.sections
    if message and of_pairs and "pair" not in case.given_tables:
        message += (
            "; without @applies, an invariant about objects is judged for the actors of pair, and this case has none"
        )
    return CaseResult(case.name, not message, message and f"{case_location(rule, case)}: {message}")


def case_location(rule: Rule, case: Case) -> str:
    """Return the location of a case: file, line and name."""
    return f"{cases_path(rule)}:{case.line}: case {case.name!r}"


@contextmanager
def _add_location_to_errors(rule: Rule, case: Case) -> Iterator[None]:
    """Add the location of the case to errors raised inside."""
    try:
        yield
    except RuleError as error:
        where = case_location(rule, case)
        raise RuleError("\n".join(f"{where}: {line}" for line in str(error).split("\n"))) from error


def outcome_difference(case: Case, outcome: merged_cases.CaseOutcome) -> str:
    """Return how an outcome differs from what the case expects, in one line; '' if it does not."""
    message = _row_difference(case.expect, outcome.verdicts)
    if not message and case.findings not in {None, len(outcome.findings)}:
        message = f"expected {case.findings} findings, got {len(outcome.findings)}"
    return message


def judge_case(rule: Rule, case: Case) -> merged_cases.CaseOutcome:
    """Judge one case alone. Errors: `RuleError` for tables, columns or values that cannot be understood."""
    return merged_cases.judge([rule], complete_scene(rule, case.given_tables, case.missing_signals), case.params)[
        rule.id
    ]


def numbered_cases(rule: Rule, cases: Sequence[Case]) -> list[merged_cases.NumberedCase]:
    """Return the scenes of all cases, to be judged together. Errors: `RuleError` with file, line and case."""
    numbered = []
    for no, case in enumerate(cases):
        with _add_location_to_errors(rule, case):
            scene = complete_scene(rule, case.given_tables, case.missing_signals)
            numbered.append(merged_cases.NumberedCase(no, scene, case.params))
    return numbered


def first_unexpected_merged_case(
    cases: Sequence[Case], numbered: Sequence[merged_cases.NumberedCase], outcome: merged_cases.CaseOutcome
) -> tuple[Case, str] | None:
    """Return the first merged case whose outcome differs from what the case expects, and the difference; None if all agree."""
    outcomes = ((cases[member.no], merged_cases.outcome_of_case(outcome, member.no)) for member in numbered)
    return next(((case, message) for case, rows in outcomes if (message := outcome_difference(case, rows))), None)


def first_problem_and_reason_codes_of_merged_cases(rule: Rule, cases: Sequence[Case]) -> tuple[str, set[str]]:
    """Judge all cases of a rule in one database; return the first problem ('' for none), and all reason codes.

    For each key column of `MERGE_KEYS`, the cases are merged and judged once, and this column distinguishes them. Errors: `RuleError`.
    """
    numbered = numbered_cases(rule, cases)
    codes: set[str] = set()
    for key, where in merged_cases.MERGE_KEYS.items():
        for group in merged_cases.mergeable_groups(numbered, key):
            outcome = merged_cases.judge([rule], merged_cases.merge_cases(group, key), group[0].params)[rule.id]
            for row in [*outcome.verdicts, *outcome.findings]:
                if row["cause_code"] is not None:
                    codes.update(code_and_nested_codes(row["cause_code"], json.loads(row["cause_args"] or "{}")))
            if wrong := first_unexpected_merged_case(cases, group, outcome):
                case, message = wrong
                return f"{case_location(rule, case)}: as one of {where}: {message}; does each join have {key}?", codes
    return "", codes


def _row_difference(expect: str | Sequence[Mapping[str, Any]], rows: Sequence[Row]) -> str:
    """Return how the rows differ from `expect`, in one line; '' if they do not."""
    got = "; ".join(_row_text(row) for row in rows)
    if isinstance(expect, str):
        wrong = [row for row in rows if row["verdict"] != expect]
        return f"expected {expect}, got {got}" if wrong or not rows else ""
    if len(expect) != len(rows):
        return f"expected {len(expect)} rows, got {len(rows)}: {got}"
    for n, (expected_row, row) in enumerate(zip(expect, rows, strict=True)):
        for name, value in expected_row.items():
            column, scale = column_and_factor("verdict", name, "expect")
            same = value in row[column] if name == "reason" else is_same_value(value, row[column], scale)
            if not same:
                row_value = row[column] if scale == 1 or row[column] is None else row[column] / scale
                return f"row {n}: expected {name} = {value!r}, got {row_value!r}: {_row_text(row)}"
    return ""


def is_same_value(expected_value: Any, actual_value: Any, scale: int) -> bool:
    """Return whether a value agrees with an expected one to its written decimals, at least two. `scale`: of the expected value."""
    if (
        isinstance(expected_value, bool)
        or expected_value is None
        or actual_value is None
        or isinstance(expected_value, str)
    ):
        return bool(expected_value == actual_value)
    if scale != 1 or isinstance(actual_value, int):
        return bool(round(Decimal(str(expected_value)) * scale) == actual_value)
    if isinf(expected_value):
        return bool(expected_value == actual_value)
    exponent = Decimal(str(expected_value)).as_tuple().exponent
    decimals = max(2, -exponent if isinstance(exponent, int) else 2)
    return abs(float(expected_value) - float(actual_value)) <= 0.5 * 10.0**-decimals + 1e-9


def _row_text(row: Row) -> str:
    names = " ".join(str(row[c]) for c in ("profile", "object_id") if row[c] is not None)
    return f"{row['verdict']} ({row['reason_code']}{', ' + names if names else ''}: {row['reason']})"
