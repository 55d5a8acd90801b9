"""Builds the SQL that decides whether a rule is in force, by the conditions in its header and the automated driver's engagement.

The table `_watched` has the subjects with a step at which the automated driver does not drive, or possibly does not. All others are
engaged at every step, and need no check.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.drive import conditions

if TYPE_CHECKING:
    from drivelint.catalogue import Rule

ROUNDING_MPS = 0.01
"""The tolerance for speed limits, which are converted from km/h or mph and may be rounded: 50 km/h is 13.89 or 13.8889 m/s."""
ENGAGED_SQL = "(w.ego_id IS NULL OR e.engaged)"


def has_conditions(rule: Rule) -> bool:
    """Return whether the rule's header contains any condition."""
    return bool(rule.applies.restricted_conditions) or rule.applies.has_speed_limit_condition


def condition_sql_fragments(rule: Rule, alias: str, time_sql: str, check_engagement: bool) -> dict[str, str]:
    """Return SQL fragments for the rows of the table `alias` at `time_sql` (an SQL expression).

    `in_force`: whether the rule is in force: false if any condition is false, else NULL if any is unknown. `doubt`: the reason code of the
    first unknown condition, or NULL. `condition_joins`: the joins that these fragments need, and with `check_engagement` those that
    `ENGAGED_SQL` needs.
    """
    terms = _sql_by_condition(rule, check_engagement)
    whens = " ".join(f"WHEN ({term}) IS NULL THEN '{name}_unknown'" for name, term in terms.items())
    same = "{0}.drive_id = {1}.drive_id AND {0}.ego_id = {1}.ego_id"
    joins = f"LEFT JOIN ego_condition e ON {same.format('e', alias)} AND e.t_ns = {time_sql}" if terms else ""
    if check_engagement:
        joins += f" LEFT JOIN _watched w ON {same.format('w', alias)}"
    return {
        "in_force": " AND ".join(terms.values()) or "true",
        "doubt": f"CASE {whens} END" if terms else "NULL::VARCHAR",
        "condition_joins": joins,
    }


def parameters_of_conditions(rule: Rule) -> dict[str, object]:
    """Return parameter name -> value, for the parameters in the conditions' SQL."""
    least, largest = rule.applies.limit_min_mps, rule.applies.limit_max_mps
    values: dict[str, object] = {
        "_limit_min": None if least is None else least - ROUNDING_MPS,
        "_limit_max": None if largest is None else largest + ROUNDING_MPS,
    }
    for name, words in rule.applies.restricted_conditions.items():
        values[f"_is_{name}"] = conditions.with_narrower_values(words)
        values[f"_may_{name}"] = conditions.broader_values(words)
    return values


def _sql_by_condition(rule: Rule, check_engagement: bool) -> dict[str, str]:
    """Return condition -> its SQL (true, false or NULL), with the automated driver's engagement first."""
    sql = {"engaged": ENGAGED_SQL} if check_engagement else {}
    for name in rule.applies.restricted_conditions:
        sql[name] = (
            f"CASE WHEN list_contains($_is_{name}, e.{name}) THEN true "
            f"WHEN e.{name} IS NOT NULL AND NOT list_contains($_may_{name}, e.{name}) THEN false END"
        )
    limits = ((">= $_limit_min", rule.applies.limit_min_mps), ("<= $_limit_max", rule.applies.limit_max_mps))
    if rule.applies.has_speed_limit_condition:
        sql["limit"] = " AND ".join(f"e.limit_mps {bound}" for bound, mps in limits if mps is not None)
    return sql
