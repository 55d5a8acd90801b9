-- The nearest vehicle ahead of the ego in the running lane. A row without an object means that there is no vehicle. A step has no row if an
-- object in the ego's way is nearer, if an actor of unknown class, or without a position on the corridor, may be nearer, or if the ego
-- itself has no position on it.
-- lifetime: part
CREATE TABLE lead (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR,                -- the nearest vehicle ahead in the running lane (without a map: in the strip that the ego's box sweeps). Not counted: a vehicle in passed_by; one that crosses the lane on its own path through a junction; one of the next lane that reaches over the line beside the ego's path without coming nearer to it; one beside the ego's box. No row: not known; to know that nobody is within N m, use vehicle_ahead.free_m; NULL: no vehicle
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    gap_m DOUBLE,                     -- distance from bumper to bumper along the corridor; negative: the two boxes overlap {position, heading, size}
    speed_mps DOUBLE,                 -- speed of the lead along the lane, in either direction {velocity}
    accel_mps2 DOUBLE,                -- acceleration of the lead, mean over the 0.5 s up to the step; NULL: not known {velocity}
    ego_speed_mps DOUBLE,             -- the ego's speed {velocity}
    in_lane BOOLEAN,                  -- part of the ego's box is in the running lane: the ego follows, and does not overtake beside the lead {position}
    oncoming BOOLEAN,                 -- the lead heads against the corridor {position, heading, velocity}
    across_m DOUBLE,                  -- gap between the two boxes across the corridor; negative: overlap {position, heading, size}
    ego_across_mps DOUBLE,            -- the ego's speed across the corridor, positive towards the lead {velocity}
    across_mps DOUBLE,                -- the lead's speed across the corridor, positive towards the ego {velocity}
    error_mps DOUBLE NOT NULL,        -- error bound of the speed difference: 0.25 m/s for each of the two speeds that was derived by a filter (quality velocity_filtered), else 0 {velocity}
    t_since_ns BIGINT,                -- first step of the unbroken stretch in which this vehicle has been the lead {position}
    joined BOOLEAN                    -- the stretch began with a lane change of the ego or the lead, or when a vehicle beside the ego got ahead; false: the lead was ahead in the lane before (further away, or behind another vehicle), or the log begins there {position}
);

INSERT INTO lead BY NAME
WITH
ahead AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns,
        min({
            'gap_m': p.gap_m, 'object_id': p.object_id, 'speed_mps': p.speed_mps, 'actor_class': p.actor_class, 'oncoming': p.oncoming,
            'across_m': p.across_m, 'ego_across_mps': p.ego_across_mps, 'across_mps': p.across_mps
        }) FILTER (is_vehicle(p.actor_class)) AS nearest,
        min(p.gap_m) FILTER (is_vehicle(p.actor_class) IS DISTINCT FROM true AND p.gap_m < unsure_reach_m(e.speed_mps)) AS unclassified_m
    FROM _lane_ahead p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    WHERE p.outside IS DISTINCT FROM true
    GROUP BY ALL
),
actor_with_filtered_velocity AS (SELECT DISTINCT drive_id, actor_id FROM quality WHERE check_id = 'velocity_filtered'),
hidden_vehicle AS (
    SELECT drive_id, ego_id, t_ns, min(lane_m) FILTER (NOT late) AS least_m, min(lane_m) FILTER (late) AS late_m
    FROM hidden
    WHERE vehicle AND ahead IS DISTINCT FROM false AND NOT beside_lane
    GROUP BY ALL
),
lead_step AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, st.k, st.seg, e.chain_id, e.speed_mps AS ego_speed_mps, a.nearest,
        first_value(e.t_ns) OVER (
            PARTITION BY e.drive_id, e.ego_id, st.seg ORDER BY e.t_ns RANGE BETWEEN 500_000_000 PRECEDING AND CURRENT ROW
        ) AS t_half_second_ns,
        lag(e.t_ns) OVER (PARTITION BY e.drive_id, e.ego_id ORDER BY st.k) AS t_before_ns,
        lag(st.seg) OVER (PARTITION BY e.drive_id, e.ego_id ORDER BY st.k) = st.seg AS is_continuous,
        e.front_s_m IS NOT NULL AND coalesce(least(d.least_m, a.unclassified_m) >= coalesce(a.nearest.gap_m, lead_reach_m(e.speed_mps)), true)
            -- Up to a vehicle that is seen, the lane is in plain view.
            AND coalesce(a.nearest.gap_m IS NOT NULL OR d.late_m >= lead_reach_m(e.speed_mps), true) AS known
    FROM ego_state e
    JOIN step st USING (drive_id, ego_id, t_ns)
    LEFT JOIN ahead a USING (drive_id, ego_id, t_ns)
    LEFT JOIN hidden_vehicle d USING (drive_id, ego_id, t_ns)
),
lead_run AS (
    SELECT
        *,
        sum((NOT coalesce(is_same, false))::INTEGER) OVER (PARTITION BY drive_id, ego_id ORDER BY k ROWS UNBOUNDED PRECEDING) AS run_no
    FROM (
        SELECT
            *,
            is_continuous AND lag(known) OVER (PARTITION BY drive_id, ego_id ORDER BY k)
                AND nearest.object_id IS NOT DISTINCT FROM lag(nearest.object_id) OVER (PARTITION BY drive_id, ego_id ORDER BY k) AS is_same
        FROM lead_step
    )
    WHERE known
),
run_begin AS (
    SELECT drive_id, ego_id, run_no, min(t_ns) AS t_since_ns, min(k) AS k FROM lead_run WHERE nearest.object_id IS NOT NULL GROUP BY ALL
),
-- The place and the speed of the nearest vehicle one step earlier and half a second earlier.
earlier_place AS (
    SELECT r.drive_id, r.ego_id, r.t_ns, p.t_ns AS t_earlier_ns, CASE WHEN p.heading_diff_rad IS NOT NULL THEN along_lane_mps(p.speed_mps, p.heading_diff_rad) END AS speed_mps, p.rear_s_m, p.d_m, p.lat_half_m, p.half_width_m
    FROM (
        SELECT drive_id, ego_id, t_ns, nearest.object_id AS object_id, unnest(list_distinct([t_half_second_ns, t_before_ns])) AS t_earlier_ns FROM lead_run WHERE nearest.object_id IS NOT NULL
    ) r
    JOIN pair p ON p.drive_id = r.drive_id AND p.ego_id = r.ego_id AND p.t_ns = r.t_earlier_ns AND p.object_id = r.object_id
),
-- Whether the vehicle joined: one step earlier, it was not ahead with its centre in the lane or in the ego's way. A vehicle that only
-- reached over the line joins when its centre enters the lane.
run_origin AS (
    SELECT b.drive_id, b.ego_id, b.run_no,
        NOT (p.rear_s_m >= e.front_s_m AND in_lane(p.d_m, p.lat_half_m, p.half_width_m) AND (abs(p.d_m) <= p.half_width_m OR abs(p.d_m - e.d_m) < p.lat_half_m + e.lat_half_m)) AS joined
    FROM run_begin b
    JOIN lead_run r ON r.drive_id = b.drive_id AND r.ego_id = b.ego_id AND r.t_ns = b.t_since_ns
    JOIN earlier_place p ON p.drive_id = r.drive_id AND p.ego_id = r.ego_id AND p.t_ns = r.t_ns AND p.t_earlier_ns = r.t_before_ns
    JOIN ego_state e ON e.drive_id = r.drive_id AND e.ego_id = r.ego_id AND e.t_ns = r.t_before_ns
    WHERE r.is_continuous
)
SELECT
    r.drive_id, r.ego_id, r.t_ns, r.nearest.object_id AS object_id, r.nearest.actor_class AS actor_class, r.nearest.gap_m AS gap_m,
    r.nearest.speed_mps AS speed_mps,
    -- Mean over half a second. Less than least_mean_ns, at the start of the log, is not enough.
    CASE WHEN f.actor_id IS NULL AND r.t_ns - r.t_half_second_ns >= least_mean_ns() THEN 1e9 * (r.nearest.speed_mps - h.speed_mps) / (r.t_ns - r.t_half_second_ns) END AS accel_mps2,
    r.ego_speed_mps, x.left_in_m < 0 AND x.right_in_m < 0 AS in_lane, r.nearest.oncoming AS oncoming,
    r.nearest.across_m AS across_m, r.nearest.ego_across_mps AS ego_across_mps, r.nearest.across_mps AS across_mps,
    filtered_error_mps() * ((f.actor_id IS NOT NULL)::INTEGER + (g.actor_id IS NOT NULL)::INTEGER) AS error_mps,
    b.t_since_ns, CASE WHEN b.k = 0 THEN false ELSE o.joined END AS joined
FROM lead_run r
LEFT JOIN ego_corridor x ON x.drive_id = r.drive_id AND x.ego_id = r.ego_id AND x.chain_id = r.chain_id AND x.t_ns = r.t_ns
LEFT JOIN earlier_place h ON h.drive_id = r.drive_id AND h.ego_id = r.ego_id AND h.t_ns = r.t_ns AND h.t_earlier_ns = r.t_half_second_ns
LEFT JOIN run_begin b ON b.drive_id = r.drive_id AND b.ego_id = r.ego_id AND b.run_no = r.run_no
LEFT JOIN actor_with_filtered_velocity f ON f.drive_id = r.drive_id AND f.actor_id = r.nearest.object_id
LEFT JOIN actor_with_filtered_velocity g ON g.drive_id = r.drive_id AND g.actor_id = r.ego_id
LEFT JOIN run_origin o ON o.drive_id = r.drive_id AND o.ego_id = r.ego_id AND o.run_no = r.run_no
