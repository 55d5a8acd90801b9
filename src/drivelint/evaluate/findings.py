"""Builds the SQL that keeps failing stretches, courses around them and around near misses, and margins."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivelint.evaluate import sql_fragments

if TYPE_CHECKING:
    from drivelint.catalogue import Rule

IS_NEAR_MISS = "round(margin, 6) < near_margin"
"""What makes a kept row a near miss; of a row of outcomes joined to `_rule`."""
MOST_NEAR_MISS_SERIES = 20
"""Near misses of an ego, rule and profile whose course is kept."""
_SERIES = "drive_id, ego_id, object_id, profile, ref_id"


def stretches_sql(rule: Rule) -> str:
    """SQL that appends to `_stretch` the failing runs of `_judged`: close ones as one, but never across a hole."""
    combined = rule.combine != "each"
    follows, order = (
        ("k - lag(k) OVER w <= 1", "t_ns, label") if rule.kind == "invariant" else ("n - lag(n) OVER w = 1", "t_ns")
    )
    failed = ""
    if rule.quantifier == "eventually":
        # its condition may well not hold at steps of a window that is kept, or unknown: no findings there
        who = "" if combined else " AND j.object_id = o.object_id"
        failed = f"""SEMI JOIN (SELECT * FROM _outcome WHERE rule_no = $_no AND verdict = 'fail') o
        ON j.drive_id = o.drive_id AND j.ego_id = o.ego_id AND j.ref_id = o.ref_id AND j.profile = o.profile{who}"""
    return f"""
INSERT INTO _stretch BY NAME
WITH _fails AS (
    SELECT j.*, CASE WHEN {follows} OR t_ns - lag(t_ns) OVER w < $_merge_ns
        THEN 0 ELSE 1 END AS fresh
    FROM _judged j {failed} WHERE NOT holds
    WINDOW w AS (PARTITION BY {_SERIES}, seg ORDER BY {order})
), _runs AS (
    SELECT *, sum(fresh) OVER (PARTITION BY {_SERIES}, seg ORDER BY {order} ROWS UNBOUNDED PRECEDING) AS run FROM _fails
), _worst AS (
    SELECT {_SERIES}, seg, run, min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns, {sql_fragments.deciding_step(rule)} AS worst
        FROM _runs GROUP BY ALL)
SELECT $_no AS rule_no, drive_id, ego_id, {"worst.who" if combined else "object_id"} AS object_id, profile, ref_id,
    t_start_ns, t_end_ns, worst.t AS t_worst_ns, coalesce(worst.code, 'violated') AS code, worst.reason AS reason,
    {sql_fragments.measure_columns(rule, "worst.")}
FROM _worst
"""


def measure_series_sql(rule: Rule) -> str:
    """Return the SQL that appends to `_course` the measure's values around the failing stretches of a rule.

    From 2 s before to 2 s after a stretch and 5 s around its worst step, but at most 30 s from that; thinned to some 150
    steps, of which each is the worst of its share.
    """
    whose = "" if rule.combine != "each" else " AND j.object_id IS NOT DISTINCT FROM s.object_id"
    series = "s.object_id, s.profile, s.ref_id, s.t_start_ns"
    return f"""
INSERT INTO _course BY NAME
WITH _seen AS (
    SELECT s.*, greatest(t_worst_ns - 30_000_000_000, least(t_worst_ns - 5_000_000_000, t_start_ns - 2_000_000_000)) AS t_from_ns,
        least(t_worst_ns + 30_000_000_000, greatest(t_worst_ns + 5_000_000_000, t_end_ns + 2_000_000_000)) AS t_to_ns
    FROM _stretch s WHERE rule_no = $_no
)
SELECT s.rule_no, s.drive_id, s.ego_id, {series}, false AS near, j.t_ns, {sql_fragments.measure_columns(rule, "j.")}, j.holds
FROM _seen s
JOIN _judged j ON j.drive_id = s.drive_id AND j.ego_id = s.ego_id AND j.profile IS NOT DISTINCT FROM s.profile
    AND j.ref_id IS NOT DISTINCT FROM s.ref_id{whose} AND j.t_ns BETWEEN s.t_from_ns AND s.t_to_ns
{"WHERE j.applies IS DISTINCT FROM false" if rule.kind == "invariant" else ""}
QUALIFY row_number() OVER (
    PARTITION BY s.drive_id, s.ego_id, {series}, (j.t_ns - s.t_from_ns) * 150 // (s.t_to_ns - s.t_from_ns)
    ORDER BY coalesce(j.holds::INTEGER, 1), margin NULLS LAST, j.t_ns
) = 1
"""


def settled_measure_series_sql(rule: Rule) -> str:
    """Return the SQL of near-miss courses for groups that the first pass settled."""
    near = f"""SELECT g.drive_id, g.ego_id, coalesce(g.object_id, '') AS object_id, '' AS profile, NULL::INTEGER AS ref_id, '' AS label,
        g.t_start_ns, g.t_end_ns, g.t_worst_ns, g.margin
    FROM _group g JOIN _rule r USING (rule_no) WHERE rule_no = $_no AND g.clean AND {IS_NEAR_MISS}"""
    who = "coalesce(object_id, '')" if rule.per_object else "''"
    steps = f"""SELECT drive_id, ego_id, {who} AS object_id, '' AS profile, NULL::INTEGER AS ref_id, '' AS label, t_ns,
        observed, required, holds, gain FROM _state"""
    return _near(rule, near, f"{sql_fragments.condition_ctes(rule)}, _steps AS ({steps})", "_steps")


def near_miss_measure_series_sql(rule: Rule) -> str:
    """SQL that appends to `_course` how the measure went around near misses of `_outcome`, the closest per ego and profile."""
    near = f"""SELECT o.drive_id, o.ego_id, coalesce(o.object_id, '') AS object_id, coalesce(o.profile, '') AS profile, o.ref_id,
        coalesce(o.label, '') AS label, o.t_start_ns, o.t_end_ns, o.t_worst_ns, o.margin
    FROM _outcome o JOIN _rule r USING (rule_no) WHERE rule_no = $_no AND o.verdict = 'pass' AND {IS_NEAR_MISS}"""
    return _near(rule, near, "", "_judged")


def _near(rule: Rule, near: str, before: str, steps: str) -> str:
    """SQL that appends to `_course` the steps 5 s around the worst one of each row of `near`; `before`: CTEs that it needs."""
    invariant = rule.kind == "invariant"
    whose = "" if rule.combine != "each" else " AND j.object_id = s.object_id"
    episode = " AND j.label = s.label AND j.applies IS DISTINCT FROM false" if steps == "_judged" and invariant else ""
    series = "s.object_id, s.profile, s.ref_id, s.t_start_ns"
    return f"""
INSERT INTO _course BY NAME
WITH {before + ", " if before else ""}_near AS ({near}
    QUALIFY row_number() OVER (PARTITION BY drive_id, ego_id, profile ORDER BY margin, t_worst_ns, object_id, ref_id)
        <= {MOST_NEAR_MISS_SERIES}
)
SELECT $_no AS rule_no, s.drive_id, s.ego_id, {series}, true AS near, j.t_ns, {sql_fragments.measure_columns(rule, "j.")}, j.holds
FROM _near s
JOIN {steps} j ON j.drive_id = s.drive_id AND j.ego_id = s.ego_id AND j.profile = s.profile
    AND j.ref_id IS NOT DISTINCT FROM s.ref_id{whose}{episode}
    AND j.t_ns BETWEEN s.t_worst_ns - 5_000_000_000 AND s.t_worst_ns + 5_000_000_000
QUALIFY row_number() OVER (
    PARTITION BY s.drive_id, s.ego_id, {series}, (j.t_ns - s.t_worst_ns) // 70_000_000
    ORDER BY coalesce(j.holds::INTEGER, 1), margin NULLS LAST, j.t_ns
) = 1
"""


def margins_sql(rule: Rule) -> str:
    """SQL that appends every expected step of `_judged` to `_margin`."""
    who = "who" if rule.combine != "each" else "object_id"
    return f"""
INSERT INTO _margin BY NAME
SELECT $_no AS rule_no, drive_id, ego_id, profile, {who} AS object_id, ref_id, t_ns,
    {sql_fragments.measure_columns(rule)}, holds
FROM _judged WHERE t_ns IS NOT NULL AND {"applies IS DISTINCT FROM false" if rule.kind == "invariant" else "true"}
"""
