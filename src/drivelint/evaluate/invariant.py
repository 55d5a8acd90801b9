"""Builds the SQL of invariants, which are judged at every step of a grid: one verdict per continuous applicable episode and object.

A group is the steps of one ego (and one object). A first pass settles complete groups that pass, by one aggregation; only the others are
joined with the grid.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from drivelint.evaluate import applicability
from drivelint.evaluate.sql_fragments import deciding_step_sql, rule_statement, subject_join_sql
from drivelint.sql.statements import statement

if TYPE_CHECKING:
    from drivelint.catalogue import Rule

StepSelection = Literal["all", "unsettled", "asked"]
"""The steps to judge: all of a rule's grid, those of the groups that the first pass did not settle, or those of the table `_asked`."""


def has_default_grid(rule: Rule) -> bool:
    """Return whether a rule is an invariant with the default grid, whose groups the first pass can settle."""
    return not (
        rule.kind != "invariant"
        or "applies" in rule.sections
        or applicability.has_conditions(rule)
        or rule.per_profile
        or rule.exempt_after_s != 0
    )


def first_pass_sql(rule: Rule, skips_subjects: bool) -> str:
    """Return the SQL that appends the groups to `_group`, `clean` if they pass at all their steps without a gap."""
    return rule_statement(
        "group",
        rule,
        grid="pair" if rule.per_object else "step",
        same_object=" AND g.object_id = s.object_id" if rule.per_object else "",
        todo=subject_join_sql(skips_subjects, "g"),
        deciding_step=deciding_step_sql(rule),
    )


def first_pass_measure_series_sql(rule: Rule) -> str:
    """Return the SQL that appends the measure's values around near misses to `_course`, for groups that the first pass settled."""
    return rule_statement(
        "course_of_near_groups",
        rule,
        object="coalesce(object_id, '')" if rule.per_object else "''",
    )


def _grid_sql(rule: Rule, skips_subjects: bool, unsettled: bool, check_engagement: bool) -> str:
    """Return CTEs of which the last is `_step_to_judge`; `unsettled`: only the groups that the first pass did not settle."""
    keep = ""
    if unsettled:
        keep = " SEMI JOIN (SELECT * FROM _group WHERE rule_no = $_no AND NOT clean) _u"
        keep += " ON a.drive_id = _u.drive_id AND a.ego_id = _u.ego_id"
        keep += " AND a.object_id = _u.object_id" if rule.per_object else ""
    return statement(
        "judging/grid",
        base=_grid_of_all_steps_sql(rule),
        todo=subject_join_sql(skips_subjects, "a"),
        unsettled=keep,
        **applicability.condition_sql_fragments(rule, "a", "a.t_ns", check_engagement),
    )


def _grid_of_all_steps_sql(rule: Rule) -> str:
    if "applies" not in rule.sections:
        return statement("judging/grid_by_default", grid="_pair_grid" if rule.per_object else "_step_grid")
    columns = rule.columns["applies"]
    three = "applies" if "applies" in columns else "true"
    crowd = rule.per_object and "object_id" not in columns
    return statement(
        "judging/grid_of_author",
        author=rule.sections["applies"],
        author_object="object_id" if "object_id" in columns else "NULL::VARCHAR",
        label="episode::VARCHAR" if "episode" in columns else "NULL::VARCHAR",
        applies=three,
        why=f"min(reason) FILTER (({three}) IS NULL)" if "reason" in columns else "NULL::VARCHAR",
        object="p.object_id" if crowd else "a.object_id",
        objects="JOIN pair p ON a.drive_id = p.drive_id AND a.ego_id = p.ego_id AND a.t_ns = p.t_ns" if crowd else "",
    )


def steps_to_judge_sql(rule: Rule, skips_subjects: bool, check_engagement: bool) -> str:
    """Return the SQL for `_asked`: the steps to judge of a rule without a first pass."""
    return statement("judging/asked", grid=_grid_sql(rule, skips_subjects, False, check_engagement))


def judged_steps_sql(rule: Rule, skips_subjects: bool, check_engagement: bool, steps: StepSelection) -> str:
    """Return the SQL that judges these steps of the grid and appends them to `_judged`."""
    same_key = ""
    if rule.per_object:
        # in an author's grid, the object of a step may be NULL: unknown
        same_key += f" AND g.object_id {'IS NOT DISTINCT FROM' if 'applies' in rule.sections else '='} v.object_id"
    if rule.per_profile:
        same_key += " AND p.profile = v.profile"
    rest = ") SELECT * FROM _steps"
    if rule.exempt_after_s != 0:
        source = "SELECT * FROM _steps WHERE applies IS DISTINCT FROM false"
        numbered = statement("judging/steps_with_episode", source=source)
        rest = statement("judging/aged", steps_with_episode=numbered)
    grid = "_step_to_judge AS (SELECT * FROM _asked)"
    if steps != "asked":
        grid = _grid_sql(rule, skips_subjects, steps == "unsettled", check_engagement)
    return rule_statement("judged_of_grid", rule, grid=grid, same_key=same_key, kept=rest)


def insert_unknowns_of_lost_objects_sql(rule: Rule, skips_subjects: bool, check_engagement: bool) -> str:
    """Return the SQL that appends one unknown outcome per object that may have been present after its track ended."""
    return rule_statement(
        "outcome_of_lost_objects",
        rule,
        todo=subject_join_sql(skips_subjects, "l"),
        **applicability.condition_sql_fragments(rule, "l", "l.t_from_ns", check_engagement),
    )
