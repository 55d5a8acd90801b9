-- The nearest vehicle ahead in the running lane, or the certainty that there is none: a step at which somebody without a place, or of no
-- known class, may be nearer, or the ego itself has no place, has no row.
WITH
ahead AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns,
        min({
            'gap_m': p.gap_m, 'object_id': p.object_id, 'speed_mps': p.speed_mps, 'actor_class': p.actor_class, 'oncoming': p.oncoming,
            'across_m': p.across_m, 'ego_across_mps': p.ego_across_mps, 'across_mps': p.across_mps
        }) FILTER (is_vehicle(p.actor_class)) AS near,
        min(p.gap_m) FILTER (is_vehicle(p.actor_class) IS DISTINCT FROM true AND p.gap_m < unsure_reach_m(e.speed_mps)) AS unsure_m
    FROM lane_ahead p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    WHERE p.outside IS DISTINCT FROM true
    GROUP BY ALL
),
filtered AS (SELECT DISTINCT drive_id, actor_id FROM quality WHERE check_id = 'velocity_filtered'),
doubt AS (
    SELECT drive_id, ego_id, t_ns, min(lane_m) FILTER (NOT late) AS least_m, min(lane_m) FILTER (late) AS late_m
    FROM hidden
    WHERE vehicle AND ahead IS DISTINCT FROM false
    GROUP BY ALL
),
told AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, st.k, st.seg, e.chain_id, e.speed_mps AS ego_speed_mps, a.near,
        first_value(e.t_ns) OVER (
            PARTITION BY e.drive_id, e.ego_id, st.seg ORDER BY e.t_ns RANGE BETWEEN 500_000_000 PRECEDING AND CURRENT ROW
        ) AS t_half_ns,
        lag(e.t_ns) OVER (PARTITION BY e.drive_id, e.ego_id ORDER BY st.k) AS t_before_ns,
        lag(st.seg) OVER (PARTITION BY e.drive_id, e.ego_id ORDER BY st.k) = st.seg AS goes_on,
        e.front_s_m IS NOT NULL AND coalesce(least(d.least_m, a.unsure_m) >= coalesce(a.near.gap_m, lead_reach_m(e.speed_mps)), true)
            -- up to the one that is seen the lane is in plain view
            AND coalesce(a.near.gap_m IS NOT NULL OR d.late_m >= lead_reach_m(e.speed_mps), true) AS known
    FROM ego_state e
    JOIN step st USING (drive_id, ego_id, t_ns)
    LEFT JOIN ahead a USING (drive_id, ego_id, t_ns)
    LEFT JOIN doubt d USING (drive_id, ego_id, t_ns)
),
run AS (
    SELECT
        *,
        sum((NOT coalesce(same, false))::INTEGER) OVER (PARTITION BY drive_id, ego_id ORDER BY k ROWS UNBOUNDED PRECEDING) AS n
    FROM (
        SELECT
            *,
            goes_on AND lag(known) OVER (PARTITION BY drive_id, ego_id ORDER BY k)
                AND near.object_id IS NOT DISTINCT FROM lag(near.object_id) OVER (PARTITION BY drive_id, ego_id ORDER BY k) AS same
        FROM told
    )
    WHERE known
),
begun AS (
    SELECT drive_id, ego_id, n, min(t_ns) AS t_since_ns, min(k) AS k FROM run WHERE near.object_id IS NOT NULL GROUP BY ALL
),
-- where the nearest one was one step before it became that; half a second ago how fast
past AS (
    SELECT r.drive_id, r.ego_id, r.t_ns, p.t_ns AS t_past_ns, CASE WHEN p.heading_diff_rad IS NOT NULL THEN along_lane_mps(p.speed_mps, p.heading_diff_rad) END AS speed_mps, p.rear_s_m, p.d_m, p.lat_half_m, p.half_width_m
    FROM (
        SELECT drive_id, ego_id, t_ns, near.object_id AS object_id, unnest(list_distinct([t_half_ns, t_before_ns])) AS t_past_ns FROM run WHERE near.object_id IS NOT NULL
    ) r
    JOIN pair p ON p.drive_id = r.drive_id AND p.ego_id = r.ego_id AND p.t_ns = r.t_past_ns AND p.object_id = r.object_id
),
-- ahead already, with its centre in the lane or in the ego's way, or not: one that only reached over the line joins as it comes in
origin AS (
    SELECT b.drive_id, b.ego_id, b.n,
        NOT (p.rear_s_m >= e.front_s_m AND in_lane(p.d_m, p.lat_half_m, p.half_width_m) AND (abs(p.d_m) <= p.half_width_m OR abs(p.d_m - e.d_m) < p.lat_half_m + e.lat_half_m)) AS joined
    FROM begun b
    JOIN run r ON r.drive_id = b.drive_id AND r.ego_id = b.ego_id AND r.t_ns = b.t_since_ns
    JOIN past p ON p.drive_id = r.drive_id AND p.ego_id = r.ego_id AND p.t_ns = r.t_ns AND p.t_past_ns = r.t_before_ns
    JOIN ego_state e ON e.drive_id = r.drive_id AND e.ego_id = r.ego_id AND e.t_ns = r.t_before_ns
    WHERE r.goes_on
)
SELECT
    r.drive_id, r.ego_id, r.t_ns, r.near.object_id AS object_id, r.near.actor_class AS actor_class, r.near.gap_m AS gap_m,
    r.near.speed_mps AS speed_mps,
    -- a mean over half a second; less than 0.4 s of it at the log's begin is none
    CASE WHEN f.actor_id IS NULL AND r.t_ns - r.t_half_ns >= 400_000_000 THEN 1e9 * (r.near.speed_mps - h.speed_mps) / (r.t_ns - r.t_half_ns) END AS accel_mps2,
    r.ego_speed_mps, x.left_in_m < 0 AND x.right_in_m < 0 AS in_lane, r.near.oncoming AS oncoming,
    r.near.across_m AS across_m, r.near.ego_across_mps AS ego_across_mps, r.near.across_mps AS across_mps,
    filtered_error_mps() * ((f.actor_id IS NOT NULL)::INTEGER + (g.actor_id IS NOT NULL)::INTEGER) AS error_mps,
    b.t_since_ns, CASE WHEN b.k = 0 THEN false ELSE o.joined END AS joined
FROM run r
LEFT JOIN ego_corridor x ON x.drive_id = r.drive_id AND x.ego_id = r.ego_id AND x.chain_id = r.chain_id AND x.t_ns = r.t_ns
LEFT JOIN past h ON h.drive_id = r.drive_id AND h.ego_id = r.ego_id AND h.t_ns = r.t_ns AND h.t_past_ns = r.t_half_ns
LEFT JOIN begun b ON b.drive_id = r.drive_id AND b.ego_id = r.ego_id AND b.n = r.n
LEFT JOIN filtered f ON f.drive_id = r.drive_id AND f.actor_id = r.near.object_id
LEFT JOIN filtered g ON g.drive_id = r.drive_id AND g.actor_id = r.ego_id
LEFT JOIN origin o ON o.drive_id = r.drive_id AND o.ego_id = r.ego_id AND o.n = r.n
