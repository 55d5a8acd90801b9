-- Stretches in which an ego's log lacks something. `signal` is `registration` where position or heading is missing, `indicator` where its
-- state is missing, NULL for a hole without any step, `lost` for a lost stretch of the log, whether or not the ego has steps there. Holes matter
-- only to rules with reference points: invariants get their own row, see outcome_of_holes.sql. If a signal is missing in the whole log, the rule
-- is not run at all.
CREATE OR REPLACE TEMP TABLE _blind AS
WITH _step_signal AS (
    SELECT s.drive_id, s.ego_id, s.t_ns, s.k, n.signal,
        CASE n.signal WHEN 'indicator' THEN e.indicator IS NULL
            ELSE e.x_m IS NULL OR e.y_m IS NULL OR e.yaw_rad IS NULL END AS lacks
    FROM step s
    LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
    CROSS JOIN (SELECT DISTINCT signal FROM _needs WHERE signal IN ('indicator', 'registration')) n
), _run AS (
    SELECT *, k - row_number() OVER (PARTITION BY drive_id, ego_id, signal, lacks ORDER BY k) AS run,
        bool_or(NOT lacks) OVER (PARTITION BY drive_id, ego_id, signal) AS ever
    FROM _step_signal
), _stretches AS (
    SELECT drive_id, ego_id, signal, min(t_ns) AS a_ns, max(t_ns) AS b_ns FROM _run WHERE lacks AND ever
    GROUP BY drive_id, ego_id, signal, run
    UNION ALL
    SELECT drive_id, ego_id, NULL, lag(t_last_ns) OVER (PARTITION BY drive_id, ego_id ORDER BY seg), t_first_ns FROM _segment
)
-- Our default: a shorter stretch cannot hide a whole occasion. An occasion that it cuts is unknown in the tables that the rule reads.
SELECT * FROM _stretches WHERE b_ns - a_ns >= 1_000_000_000
UNION ALL
-- Even the shortest lost stretch may hold the only states of an actor.
SELECT s.drive_id, s.ego_id, 'lost', greatest(l.t_from_ns, s.t_start_ns), least(l.t_to_ns, s.t_end_ns)
FROM _subject s JOIN lost_time l ON l.drive_id = s.drive_id AND l.t_from_ns < s.t_end_ns AND l.t_to_ns > s.t_start_ns
