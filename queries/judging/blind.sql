-- Stretches of the ego's time without a position or heading (for rules that require a registration), without a known
-- indicator (for rules that require that), or without any step: a hole in the log (`signal` NULL, for rules with reference
-- points; an invariant has its own row for a hole that it reaches). Where nothing of the kind is ever known the signal is
-- missing altogether, and the rule is not run.
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
-- our default: what is shorter hides no occasion whole; what is cut by it is unknown in the rule's own tables
SELECT * FROM _stretches WHERE b_ns - a_ns >= 1_000_000_000
