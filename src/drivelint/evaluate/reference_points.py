"""Builds the SQL of rules with reference points: executions, preconditions and postconditions.

The first statement finds the reference points; without any, no other statement runs. The next ones find the points to judge
(`_reference_step`), and left-join the condition's rows to them on keys only (`_judged`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.evaluate import applicability
from drivelint.evaluate.sql_fragments import rule_statement, step_by_rank_sql, subject_join_sql
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drivelint.catalogue import Rule


def references_sql(rule: Rule, columns: Sequence[str], skips_subjects: bool) -> str:
    """Return the SQL for `reference`: the author's reference points of the subjects to judge, numbered in the order of all columns."""
    columns_of_rule = [c.replace('"', '""') for c in columns if c not in {"drive_id", "ego_id", "t_ns", "object_id"}]
    rest = [f'"{c}" NULLS LAST' for c in columns_of_rule]
    object_order = ["object_id NULLS LAST"] if "object_id" in columns else []
    return statement(
        "judging/reference",
        reference=rule.sections["reference"],
        todo=subject_join_sql(skips_subjects, "r"),
        order=", ".join(["drive_id", "ego_id", "t_ns NULLS LAST", *object_order, *rest]),
    )


def time_windows_sql(rule: Rule, has_object_column: bool, check_engagement: bool) -> str:
    """Return the SQL that appends each reference point to `_occasion`, with its window and whether the rule applies there."""
    has_window = rule.subtype != "physical"
    return statement(
        "judging/occasion",
        own_object="r.object_id" if has_object_column else "NULL",
        crowd="true" if rule.per_object and not has_object_column else "false",
        at_point="false" if rule.subtype in {"temporal", "physical"} else "true",
        start="r.t_ns - $_window_ns" if has_window and rule.kind == "precondition" else "r.t_ns",
        end="r.t_ns + $_window_ns" if has_window and rule.kind == "postcondition" else "r.t_ns",
        **applicability.condition_sql_fragments(rule, "r", "r.t_ns", check_engagement),
    )


def window_steps_sql(rule: Rule) -> str | None:
    """Return the SQL that appends to `_window_step` the steps of windows, or the anchors; None for references judged at their time."""
    if rule.subtype == "temporal":
        return statement("judging/window_step_of_windows")
    if rule.subtype == "physical":
        return statement("judging/window_step_of_anchors", anchor=rule.sections["anchor"])
    return None


def judged_steps_sql(rule: Rule, has_object_column: bool, check_engagement: bool) -> str:
    """Return the SQL that appends every expected point to `_judged`, judged or not; combined over objects if the rule requires it."""
    points = "SELECT *, false AS nobody, NULL::DOUBLE AS sensor_range_m, NULL::VARCHAR AS lost FROM reference_step"
    if rule.per_object and not has_object_column:
        points = statement("judging/points_with_objects")
    same_key = " AND g.ref_id = v.ref_id" if rule.has_column("ref_id") else ""
    same_key += " AND g.object_id IS NOT DISTINCT FROM v.object_id" if rule.per_object else ""
    same_key += " AND p.profile = v.profile" if rule.per_profile else ""
    human, why_human, joins = "false", "NULL", ""
    if check_engagement:
        human = f"({applicability.ENGAGED_SQL}) IS DISTINCT FROM true"
        why_human = "CASE WHEN NOT e.engaged THEN 'not_engaged' ELSE 'engaged_unknown' END"
        joins = applicability.condition_sql_fragments(rule, "g", "g.t_ns", check_engagement)["condition_joins"]
    series = ", _point AS (SELECT *, object_id AS who, 1 AS n_same FROM _expected)"
    if rule.combine != "each":
        object_fields = "'who': object_id, 'gain': gain, "
        decides = (
            step_by_rank_sql(2, 0, 1, "", object_fields)
            if rule.combine == "all"
            else step_by_rank_sql(0, 2, 1, "-", object_fields)
        )
        series = statement("judging/combined_objects", deciding_object=decides)
    return rule_statement(
        "judged_of_references",
        rule,
        points=points,
        human=human,
        why_human=why_human,
        same_key=same_key,
        condition_joins=joins,
        series=series,
    )
