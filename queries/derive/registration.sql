-- Does the trace fit the map? Checked before any blame: on a lane for at least 80 % of the steps, with the traffic for at least 60 % of
-- those in motion (steps of an overtake in the opposing lane left out: a short drive may be little else), and in the median within 1.2 m of the centre line (half a lane: a map shifted by one lane keeps 100 % on a lane).
WITH away AS (
    SELECT DISTINCT x.drive_id, x.ego_id, st.t_ns
    FROM excursion x
    JOIN step st ON st.drive_id = x.drive_id AND st.ego_id = x.ego_id AND st.t_ns >= x.t0_ns AND st.t_ns <= x.t_end_ns
    WHERE x.over_against
),
counted AS (
    SELECT
        st.drive_id, st.ego_id,
        count(s.x_m) AS n_steps,
        count(e.lanelet_id) AS n_on_lane,
        count(*) FILTER (e.lanelet_id IS NOT NULL AND s.speed_mps > 1 AND x.t_ns IS NULL) AS n_moving,
        count(*) FILTER (e.with_direction AND s.speed_mps > 1 AND x.t_ns IS NULL) AS n_with_direction,
        quantile_disc(abs(e.d_m), 0.5) AS lateral_median_m
    FROM step st
    JOIN state_dynamics s ON s.drive_id = st.drive_id AND s.actor_id = st.ego_id AND s.t_ns = st.t_ns
    LEFT JOIN ego_lane e ON e.drive_id = st.drive_id AND e.ego_id = st.ego_id AND e.t_ns = st.t_ns
    LEFT JOIN away x ON x.drive_id = st.drive_id AND x.ego_id = st.ego_id AND x.t_ns = st.t_ns
    GROUP BY ALL
),
judged AS (
    SELECT
        c.*, g.environment_id IS NULL AS no_map,
        CASE
            WHEN g.environment_id IS NULL THEN 'no map'
            WHEN n_steps = 0 THEN 'the ego has no position'
            WHEN n_on_lane < 0.8 * n_steps THEN 'the ego is on a lane of the map in only ' || n_on_lane || ' of ' || n_steps || ' steps: wrong map, offset or frame?'
            WHEN n_with_direction < 0.6 * n_moving THEN 'the ego drives against its lane''s direction in ' || (n_moving - n_with_direction) || ' of ' || n_moving || ' moving steps: wrong handedness or frame?'
            WHEN lateral_median_m > 1.2 THEN 'half of the time the ego is more than ' || round(lateral_median_m, 2)::VARCHAR || ' m from its lane''s centre line: map offset?'
        END AS trouble
    FROM counted c JOIN data_log g USING (drive_id)
)
SELECT
    drive_id, ego_id, n_steps, n_on_lane, n_moving, n_with_direction, lateral_median_m, trouble IS NULL AS ok,
    coalesce(trouble, 'on a lane in ' || n_on_lane || ' of ' || n_steps || ' steps, with the traffic in ' || n_with_direction || ' of ' || n_moving || ' moving ones')
        AS reason
FROM judged
