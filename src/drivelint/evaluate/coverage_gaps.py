"""Makes a rule unknown where a gap in the ego's data may hide an occasion of the rule."""

from __future__ import annotations

from typing import Final

LEAST_GAP_S: Final = 1.0
"""Our default: shorter than this hides no occasion whole; what is cut by it is unknown in the rule's own tables."""

CREATE_GAPS = f"""
CREATE OR REPLACE TEMP TABLE _blind AS
WITH _state AS (
    SELECT s.drive_id, s.ego_id, s.t_ns, s.k, n.signal,
        CASE n.signal WHEN 'indicator' THEN e.indicator IS NULL
            ELSE e.x_m IS NULL OR e.y_m IS NULL OR e.yaw_rad IS NULL END AS lacks
    FROM step s
    LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
    CROSS JOIN (SELECT DISTINCT signal FROM _needs WHERE signal IN ('indicator', 'registration')) n
), _run AS (
    SELECT *, k - row_number() OVER (PARTITION BY drive_id, ego_id, signal, lacks ORDER BY k) AS run,
        bool_or(NOT lacks) OVER (PARTITION BY drive_id, ego_id, signal) AS ever
    FROM _state
), _stretches AS (
    SELECT drive_id, ego_id, signal, min(t_ns) AS a_ns, max(t_ns) AS b_ns FROM _run WHERE lacks AND ever
    GROUP BY drive_id, ego_id, signal, run
    UNION ALL
    SELECT drive_id, ego_id, NULL, lag(t_last_ns) OVER (PARTITION BY drive_id, ego_id ORDER BY seg), t_first_ns FROM _segment
)
SELECT * FROM _stretches WHERE b_ns - a_ns >= {round(LEAST_GAP_S * 1e9)}
"""
"""Stretches of the ego's time without a position or heading (for rules that require a registration), without a known
indicator (for rules that require that), or without any step: a hole in the log (`signal` NULL, for rules with reference
points; an invariant has its own row for a hole that it reaches). Where nothing of the kind is ever known the signal is
missing altogether, and the rule is not run."""

GAP_OUTCOMES = """
SELECT b.rule_no, b.drive_id, b.ego_id, min(b.a_ns) AS t_start_ns, min({'a': b.a_ns, 'b': b.b_ns}).b AS t_end_ns, 'unknown' AS verdict,
    min({'a': b.a_ns, 'code': CASE signal WHEN 'indicator' THEN 'indicator_unknown' WHEN 'registration' THEN 'ego_not_placed'
        ELSE 'log_hole' END}).code AS code,
    why(min({'a': b.a_ns, 'code': CASE signal WHEN 'indicator' THEN 'indicator_gap' WHEN 'registration' THEN 'ego_place_gap'
            ELSE 'log_gap' END}).code,
        {'from_ns': min(b.a_ns), 'to_ns': min({'a': b.a_ns, 'b': b.b_ns}).b, 'n_more': nullif(count(*) - 1, 0)}) AS reason
FROM (
    SELECT r.rule_no, b.*, s.max_gap_ns, s.start_ns
    FROM _blind b
    JOIN _subject s ON s.drive_id = b.drive_id AND s.ego_id = b.ego_id
    JOIN _rule r ON b.signal IS NULL AND r.kind <> 'invariant'
        OR EXISTS (FROM _needs n WHERE n.rule_no = r.rule_no AND n.signal = b.signal)
) b
LEFT JOIN _watched w ON w.drive_id = b.drive_id AND w.ego_id = b.ego_id
LEFT JOIN (
    SELECT rule_no, drive_id, ego_id, bool_and(code IN ('other_nation', 'outside_conditions')) AS elsewhere FROM _kept GROUP BY ALL
) k ON k.rule_no = b.rule_no AND k.drive_id = b.drive_id AND k.ego_id = b.ego_id
ANTI JOIN _kept u ON u.rule_no = b.rule_no AND u.drive_id = b.drive_id AND u.ego_id = b.ego_id
    AND (u.verdict = 'error' OR u.verdict = 'unknown' AND coalesce(
        u.t_start_ns <= b.b_ns + b.max_gap_ns AND u.t_end_ns >= b.a_ns - b.max_gap_ns, true))
WHERE w.never IS DISTINCT FROM true AND k.elsewhere IS DISTINCT FROM true
GROUP BY b.rule_no, b.drive_id, b.ego_id
"""
"""One outcome per rule and subject for the stretches that no unknown row of the rule speaks of. None where the rule's
conditions never held, or the automated driver never drives."""
