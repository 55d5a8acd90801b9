"""Builds the SQL that decides whether a rule is in force: its header's conditions and the automated driver's engagement.

Engagement costs nothing if it is not declared: `_watched` names the subjects with a step at which the automated driver does not drive, or
may not; for all others every step is engaged.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.drive import conditions

if TYPE_CHECKING:
    from drivelint.catalogue import Rule

ROUNDING_MPS = 0.01
"""Speed limits are kilometres or miles per hour, rounded in one place and not in another: 50 km/h is 13.89 or 13.8889 m/s."""
ENGAGED = "(w.ego_id IS NULL OR e.engaged)"


def has_conditions(rule: Rule) -> bool:
    """Whether the rule's header names any condition."""
    return bool(rule.applies.restricting) or rule.applies.restricts_speed_limit


def fragments(rule: Rule, alias: str, time: str, check_engagement: bool) -> dict[str, str]:
    """Return the fragments about rows with these keys and time.

    `in_force`: whether the rule is in force there, true, false or NULL: one condition that is false settles it. `doubt`: the reason code
    of the first condition that is not known, or NULL. `condition_joins`: the joins that they need, and with `check_engagement` `ENGAGED`.
    """
    terms = _terms(rule, check_engagement)
    whens = " ".join(f"WHEN ({term}) IS NULL THEN '{name}_unknown'" for name, term in terms.items())
    same = "{0}.drive_id = {1}.drive_id AND {0}.ego_id = {1}.ego_id"
    joins = f"LEFT JOIN ego_condition e ON {same.format('e', alias)} AND e.t_ns = {time}" if terms else ""
    if check_engagement:
        joins += f" LEFT JOIN _watched w ON {same.format('w', alias)}"
    return {
        "in_force": " AND ".join(terms.values()) or "true",
        "doubt": f"CASE {whens} END" if terms else "NULL::VARCHAR",
        "condition_joins": joins,
    }


def bound_values(rule: Rule) -> dict[str, object]:
    """Return the values that the conditions bind."""
    least, most = rule.applies.limit_min_mps, rule.applies.limit_max_mps
    values: dict[str, object] = {
        "_limit_min": None if least is None else least - ROUNDING_MPS,
        "_limit_max": None if most is None else most + ROUNDING_MPS,
    }
    for name, words in rule.applies.restricting.items():
        values[f"_is_{name}"] = conditions.with_narrower_values(words)
        values[f"_may_{name}"] = conditions.broader_values(words)
    return values


def _terms(rule: Rule, check_engagement: bool) -> dict[str, str]:
    """Return condition -> its three-valued SQL, the driver's engagement first."""
    found = {"engaged": ENGAGED} if check_engagement else {}
    for name in rule.applies.restricting:
        found[name] = (
            f"CASE WHEN list_contains($_is_{name}, e.{name}) THEN true "
            f"WHEN e.{name} IS NOT NULL AND NOT list_contains($_may_{name}, e.{name}) THEN false END"
        )
    limits = ((">= $_limit_min", rule.applies.limit_min_mps), ("<= $_limit_max", rule.applies.limit_max_mps))
    if rule.applies.restricts_speed_limit:
        found["limit"] = " AND ".join(f"e.limit_mps {bound}" for bound, mps in limits if mps is not None)
    return found
