"""Invariants: judged on every step of a grid, one verdict per continuous applicable episode and object.

Groups that are whole and kept are settled by one aggregation without a join; only the others are laid over the grid.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.evaluate import applicability
from drivelint.evaluate.sql_fragments import rule_statement, subject_join
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from drivelint.catalogue import Rule

_SAME = "a.drive_id = b.drive_id AND a.ego_id = b.ego_id AND a.t_ns = b.t_ns"


def has_default_grid(rule: Rule) -> bool:
    """Whether a rule is an invariant that neither brings its own grid nor needs each step looked at."""
    return not (
        rule.kind != "invariant"
        or "applies" in rule.sections
        or applicability.has_conditions(rule)
        or rule.per_profile
        or rule.exempt_after_s != 0
    )


def first_pass_sql(rule: Rule, partial: bool) -> str:
    """Return the SQL that appends to `_group` the groups that pass on all their steps without a gap."""
    return rule_statement(
        "group",
        rule,
        grid="pair" if rule.per_object else "step",
        same_object=" AND g.object_id = s.object_id" if rule.per_object else "",
        todo=subject_join(partial, "g"),
    )


def _grid(rule: Rule, partial: bool, unsettled: bool, check_engagement: bool) -> str:
    """CTEs ending in `_grid`: drive_id, ego_id, t_ns, object_id, label, k, seg, applies, doubt and why (the code and the author's
    reason where it is NULL)."""
    if "applies" not in rule.sections:
        grid = "_pair_grid" if rule.per_object else "_step_grid"
        first = f"_base AS (SELECT *, NULL::VARCHAR AS label, true AS applies, NULL::VARCHAR AS why FROM {grid})"
    else:
        own = rule.columns["applies"]
        who = "object_id" if "object_id" in own else "NULL::VARCHAR AS object_id"
        label = "episode::VARCHAR AS label" if "episode" in own else "NULL::VARCHAR AS label"
        three = "applies" if "applies" in own else "true"
        why = f"min(reason) FILTER (({three}) IS NULL)" if "reason" in own else "NULL::VARCHAR"
        crowd = rule.per_object and "object_id" not in own
        first = f"""_applies AS (
{rule.sections["applies"]}
), _distinct AS (
    SELECT drive_id, ego_id, t_ns, {who}, {label}, CASE WHEN bool_or(coalesce({three}, false)) THEN true
        WHEN bool_or({three} IS NULL) THEN NULL
        ELSE false END AS applies, {why} AS why
    FROM _applies GROUP BY ALL
), _base AS (
    SELECT a.drive_id, a.ego_id, a.t_ns, {"p" if crowd else "a"}.object_id, a.label, b.k, b.seg, a.applies, a.why
    FROM _distinct a LEFT JOIN step b ON {_SAME}
    {"JOIN pair p ON a.drive_id = p.drive_id AND a.ego_id = p.ego_id AND a.t_ns = p.t_ns" if crowd else ""})"""
    keep = ""
    if unsettled:
        keep = " SEMI JOIN (SELECT * FROM _group WHERE rule_no = $_no AND NOT clean) _u"
        keep += " ON a.drive_id = _u.drive_id AND a.ego_id = _u.ego_id"
        keep += " AND a.object_id = _u.object_id" if rule.per_object else ""
    joins = applicability.condition_joins(rule, "a", "a.t_ns", check_engagement)
    if not joins:
        return f"""{first}, _grid AS (SELECT a.*, CASE WHEN a.applies IS NULL THEN 'applies_unknown' END AS doubt
            FROM _base a
    {subject_join(partial, "a")}{keep} WHERE a.applies IS DISTINCT FROM false)"""
    return f"""{first}, _restricted AS (
    SELECT a.* EXCLUDE (applies), a.applies AND {applicability.in_force_sql(rule, check_engagement)} AS applies,
        CASE WHEN a.applies IS NULL THEN 'applies_unknown'
            ELSE {applicability.unknown_reason_sql(rule, check_engagement)} END AS doubt
    FROM _base a
    {joins}
), _grid AS (SELECT a.* FROM _restricted a{subject_join(partial, "a")}{keep} WHERE a.applies IS DISTINCT FROM false)"""


def steps_to_judge_sql(rule: Rule, partial: bool, check_engagement: bool) -> str:
    """Return the SQL for `_asked`: the grid of a rule without a first pass; empty where nothing is to be judged."""
    return statement("judging/asked", grid=_grid(rule, partial, False, check_engagement))


def second_pass_sql(rule: Rule, partial: bool, unsettled: bool, check_engagement: bool) -> str:
    """Return the SQL for `_judged`: every step of the grid, which is what a first pass left unsettled, or `_asked`."""
    same_key = ""
    if rule.per_object:
        # an author's own grid may hold a step at which it is not known which object is meant
        same_key += f" AND g.object_id {'IS NOT DISTINCT FROM' if 'applies' in rule.sections else '='} v.object_id"
    if rule.per_profile:
        same_key += " AND p.profile = v.profile"
    kept = ") SELECT * FROM _steps"
    if rule.exempt_after_s != 0:
        kept = statement("judging/aged", walked=_walked("SELECT * FROM _steps WHERE applies IS DISTINCT FROM false"))
    grid = _grid(rule, partial, True, check_engagement) if unsettled else "_grid AS (SELECT * FROM _asked)"
    return rule_statement("judged_of_grid", rule, grid=grid, same_key=same_key, kept=kept)


def episodes_sql(rule: Rule) -> str:
    """Return the SQL that appends to `_outcome` one row per episode of `_judged`."""
    broken = "SEMI JOIN (FROM _flagged WHERE broken) f USING (drive_id, ego_id, object_id, profile, label)"
    return rule_statement("outcome_of_episodes", rule, walked=_walked(f"SELECT l.* FROM _live l {broken}"))


def _walked(source: str) -> str:
    return statement("judging/walked", source=source)


def lost_objects_sql(rule: Rule, partial: bool, check_engagement: bool) -> str:
    """Return the SQL that appends one unknown row per object whose track ends while it could still have been there."""
    return rule_statement(
        "outcome_of_lost_objects",
        rule,
        condition_joins=applicability.condition_joins(rule, "l", "l.t_from_ns", check_engagement),
        todo=subject_join(partial, "l"),
        in_force=applicability.in_force_sql(rule, check_engagement),
    )
