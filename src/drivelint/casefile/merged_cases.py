"""Judges cases together, as drives of one database or as egos of one drive.

A case must give the same rows alone and among other cases; a rule whose join lacks `drive_id` or `ego_id` mixes cases, and fails here.
Besides, several variants of a rule can be judged on tables that are filled once.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

from drivelint.casefile.scene import Row, case_database, insert_rows
from drivelint.evaluate import evaluate
from drivelint.sql.declarations import column_comments

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from drivelint.catalogue import Rule

MERGE_KEYS = {"drive_id": "drives of one database", "ego_id": "egos of one drive"}
"""The key columns that distinguish merged cases, and the meaning of the cases in the merged scene, in words."""

_NUMBERED_COLUMNS = ("drive_id", "ego_id", "environment_id")
_FINDING_ORDER = "drive_id, ego_id, t_start_ns, profile NULLS LAST, object_id NULLS LAST, occurrence"
_VERDICT_ORDER = (
    "drive_id, ego_id, coalesce(t_ref_ns, t_start_ns) NULLS LAST, profile NULLS LAST, object_id NULLS LAST, occurrence"
)

Scene = dict[str, list[Row]]


class CaseOutcome(NamedTuple):
    """The outcome of one rule for one case: verdict rows, in the order of `expect`, and finding rows."""

    verdicts: list[Row]
    findings: list[Row]


class NumberedCase(NamedTuple):
    """One case with its number among the cases judged together, its tables and its parameters."""

    no: int
    scene: Scene
    params: Mapping[str, Any]


def judge(rules: Sequence[Rule], scene: Scene, params: Mapping[str, Any]) -> dict[str, CaseOutcome]:
    """Fill the tables with a scene, judge it by all rules, and return the outcomes by rule id.

    Errors: `RuleError` for a value that does not fit its column.
    """
    con = case_database()
    tables = [*scene, "verdict", "finding", "margin"]
    try:
        for table, rows in scene.items():
            insert_rows(con, table, rows)
        evaluate(con, rules, {rule.id: params for rule in rules})
        outcomes = {rule.id: CaseOutcome([], []) for rule in rules}
        for row in con.execute(f"FROM verdict ORDER BY {_VERDICT_ORDER}").to_arrow_table().to_pylist():
            outcomes[row["rule_id"]].verdicts.append(row)
        for row in con.execute(f"FROM finding ORDER BY {_FINDING_ORDER}").to_arrow_table().to_pylist():
            outcomes[row["rule_id"]].findings.append(row)
        return outcomes
    finally:
        con.execute(";".join(f"DELETE FROM {table}" for table in tables))


def mergeable_groups(members: Sequence[NumberedCase], key: str) -> list[list[NumberedCase]]:
    """Group the cases that can be judged together as different drives (`key` is `drive_id`) or egos (`ego_id`).

    The cases of a group have the same parameters, and the same rows in tables without the key.
    """
    groups: dict[str, list[NumberedCase]] = {}
    for member in members:
        shared = {t: rows for t, rows in member.scene.items() if not _may_hold_several_cases(t, member.scene, key)}
        groups.setdefault(repr((sorted(member.params.items()), sorted(shared.items()))), []).append(member)
    return list(groups.values())


def _may_hold_several_cases(table: str, scene: Scene, key: str) -> bool:
    """Return whether one table can contain the rows of several cases, distinguished by the key."""
    names = {name for row in scene[table] for name in row}
    if key == "drive_id":
        return key in names or _is_map_table(table)
    egos = {row["ego_id"] for row in scene["clock"]}
    # also if its rows are about actors that are all egos
    return key in names or ("actor_id" in names and {row.get("actor_id") for row in scene[table]} <= egos)


@cache
def _is_map_table(table: str) -> bool:
    return "environment_id" in column_comments()[table] and "drive_id" not in column_comments()[table]


def merge_cases(cases: Sequence[NumberedCase], key: str) -> Scene:
    """Return the tables of all cases as one scene, in which the case's number precedes each key."""
    scene: Scene = {}
    for member in cases:
        for table, rows in member.scene.items():
            if not rows:
                scene.setdefault(table, [])
            elif _may_hold_several_cases(table, member.scene, key):
                scene.setdefault(table, []).extend(_row_with_case_number(row, table, key, member.no) for row in rows)
            else:
                scene[table] = rows  # the same rows in every case
    return scene


def _row_with_case_number(row: Row, table: str, key: str, case_number: int) -> Row:
    marked = dict(row)
    keys = (key, "environment_id") if key == "drive_id" else (key if key in row else "actor_id",)
    if _is_map_table(table):
        marked.setdefault("environment_id", "")
    for name in keys:
        if marked.get(name) is not None:
            marked[name] = f"{case_number}:{marked[name]}"
    return marked


def outcome_of_case(outcome: CaseOutcome, case_number: int) -> CaseOutcome:
    """Return the rows of case `case_number` from an outcome of merged cases, with the original keys."""
    mark = f"{case_number}:"
    case_outcome = CaseOutcome([], [])
    for rows, case_rows in zip(outcome, case_outcome, strict=True):
        for row in rows:
            marked = {name: row[name] for name in _NUMBERED_COLUMNS if isinstance(row.get(name), str)}
            if any(text.startswith(mark) for text in marked.values()):
                case_rows.append(row | {name: text.removeprefix(mark) for name, text in marked.items()})
    return case_outcome
