"""The cases of several rules in one database: to evaluate takes a third of a second, whatever the number of rules and cases."""

from __future__ import annotations

import json
from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from drivelint.casefile import Case, case_location, numbered_cases, outcome_difference, read_cases
from drivelint.casefile.merged_cases import (
    _FINDING_ORDER,
    _VERDICT_ORDER,
    CaseOutcome,
    NumberedCase,
    _may_hold_several_cases,
    merge_cases,
    mergeable_groups,
    outcome_of_case,
)
from drivelint.casefile.scene import Row, case_database, insert_rows
from drivelint.evaluate import evaluate
from drivelint.reasons.reason_text import code_and_nested_codes

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.catalogue import Rule

KEY = "drive_id"


class CasesTogether(NamedTuple):
    """The first case of a rule that came out otherwise than it expects, with the difference, and all reason codes of the rule."""

    problem: str
    codes: set[str]


class _Group(NamedTuple):
    """Cases of one rule that can share a database."""

    rule: Rule
    cases: Mapping[int, Case]
    members: list[NumberedCase]

    @property
    def what_all_share(self) -> str:
        """The rows that are not of one drive, as text: groups that differ in them cannot share a database."""
        scene = self.members[0].scene
        return repr(
            sorted((table, rows) for table, rows in scene.items() if not _may_hold_several_cases(table, scene, KEY))
        )


def judged_together(rules: Sequence[Rule]) -> dict[str, CasesTogether]:
    """Judge all cases of these rules by all of them, as drives of as few databases as can be; return rule id -> its own cases' outcome.

    Errors: `RuleError` for a case that cannot be understood.
    """
    scenes: dict[tuple[int, str], list[_Group]] = defaultdict(list)
    n_cases = 0
    for rule in rules:
        cases = dict(enumerate(read_cases(rule), n_cases))
        members = [each._replace(no=n_cases + each.no) for each in numbered_cases(rule, list(cases.values()))]
        for turn, group in enumerate(mergeable_groups(members, KEY)):  # a rule has one set of parameters at a time
            found = _Group(rule, cases, group)
            scenes[turn, found.what_all_share].append(found)
        n_cases += len(cases)
    told = {rule.id: CasesTogether("", set()) for rule in rules}
    for groups in scenes.values():
        for asked, outcome in zip(groups, _outcomes(groups), strict=True):
            before = told[asked.rule.id]
            told[asked.rule.id] = CasesTogether(
                before.problem or _problem(asked, outcome), before.codes | _codes(outcome)
            )
    return told


def _outcomes(groups: Sequence[_Group]) -> list[CaseOutcome]:
    scene = merge_cases([member for group in groups for member in group.members], KEY)
    con = case_database()
    try:
        for table, rows in scene.items():
            insert_rows(con, table, rows)
        evaluate(con, [group.rule for group in groups], {group.rule.id: group.members[0].params for group in groups})
        return [
            CaseOutcome(_rows("verdict", _VERDICT_ORDER, group), _rows("finding", _FINDING_ORDER, group))
            for group in groups
        ]
    finally:
        con.execute(";".join(f"DELETE FROM {table}" for table in (*scene, "verdict", "finding", "margin")))


def _rows(table: str, order: str, group: _Group) -> list[Row]:
    """Return the rows of a rule about its own cases."""
    rows = case_database().execute(f"FROM {table} WHERE rule_id = ? ORDER BY {order}", [group.rule.id])
    own = {str(member.no) for member in group.members}
    return [row for row in rows.to_arrow_table().to_pylist() if row["drive_id"].partition(":")[0] in own]


def _problem(group: _Group, outcome: CaseOutcome) -> str:
    for member in group.members:
        case = group.cases[member.no]
        if message := outcome_difference(case, outcome_of_case(outcome, member.no)):
            return f"{case_location(group.rule, case)}: among the cases of other rules: {message}"
    return ""


def _codes(outcome: CaseOutcome) -> set[str]:
    rows = [row for row in (*outcome.verdicts, *outcome.findings) if row["cause_code"] is not None]
    return {
        code for row in rows for code in code_and_nested_codes(row["cause_code"], json.loads(row["cause_args"] or "{}"))
    }
