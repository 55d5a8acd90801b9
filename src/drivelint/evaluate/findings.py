"""Builds the SQL that stores failing stretches, the measure series around them and around near misses, and margins."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.evaluate.sql_fragments import condition_ctes, rule_statement
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from drivelint.catalogue import Rule


def stretches_sql(rule: Rule) -> str:
    """Return the SQL that appends the failing runs of `_judged` to `_stretch`."""
    invariant = rule.kind == "invariant"
    failed = ""
    if rule.quantifier == "eventually":
        # a window that passes, or is unknown, may have steps that fail: these are no findings
        failed = f"""SEMI JOIN (SELECT * FROM _outcome WHERE rule_no = $_no AND verdict = 'fail') o
        ON j.drive_id = o.drive_id AND j.ego_id = o.ego_id AND j.ref_id = o.ref_id
            AND j.profile = o.profile{_same_object(rule, "o")}"""
    return rule_statement(
        "stretch",
        rule,
        follows="k - lag(k) OVER w <= 1" if invariant else "n - lag(n) OVER w = 1",
        order="t_ns, label" if invariant else "t_ns",
        failed=failed,
        worst_object="w.object_id" if rule.combine == "each" else "worst.who",
        label="label" if invariant else "''",
    )


def measure_series_sql(rule: Rule) -> str:
    """Return the SQL that appends to `_course` the measure's values around the failing stretches of a rule."""
    return statement("judging/course_of_stretches", same_object=_same_object(rule, "s"), expected=_expected(rule, "j."))


def first_pass_measure_series_sql(rule: Rule) -> str:
    """Return the SQL of measure series around near misses for groups that the first pass settled."""
    steps_object = "coalesce(object_id, '')" if rule.per_object else "''"
    return _near(rule, statement("judging/near_groups", condition=condition_ctes(rule), object=steps_object))


def near_miss_measure_series_sql(rule: Rule) -> str:
    """Return the SQL that appends to `_course` the measure's values around near misses of `_outcome`."""
    return _near(rule, statement("judging/near_outcomes", expected=_expected(rule)))


def _near(rule: Rule, misses: str) -> str:
    same_key = _same_object(rule, "s")
    if rule.kind == "invariant":
        same_key += " AND j.label = s.label"
    return statement("judging/course_of_near_misses", misses=misses, same_key=same_key)


def margins_sql(rule: Rule) -> str:
    """Return the SQL that appends every expected step of `_judged` to `_margin`."""
    return statement(
        "judging/margin_of_steps",
        object="object_id" if rule.combine == "each" else "who",
        expected=_expected(rule),
    )


def _same_object(rule: Rule, alias: str) -> str:
    """Return the join condition that rows are about the same object; '' for a rule that combines objects."""
    return f" AND j.object_id = {alias}.object_id" if rule.combine == "each" else ""


def _expected(rule: Rule, alias: str = "") -> str:
    return f"{alias}applies IS DISTINCT FROM false" if rule.kind == "invariant" else "true"
