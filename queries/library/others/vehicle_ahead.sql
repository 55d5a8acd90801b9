-- Every vehicle ahead in the running lane that the ego may hit or follow. The first is the nearest one (lead). If the lead is beside the
-- ego's way or drives in the ego's direction, further vehicles count: the nearest one in the ego's way, a nearer one that is heading into
-- it, and the nearest oncoming one, in the lane or in the ego's way beside it.
-- lifetime: part
CREATE TABLE vehicle_ahead (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; no row: it is not known which vehicle is ahead
    object_id VARCHAR,                -- the nearest vehicle ahead in the running lane (lead), and vehicles that the lead may hide: the nearest in the ego's way, a nearer one that is heading into it, and the nearest that comes towards the ego, in the running lane or beside it in the ego's way; NULL: no vehicle, or see known
    nearest BOOLEAN NOT NULL,         -- this vehicle is the lead, or there is none {position}
    known BOOLEAN NOT NULL,           -- false: beyond free_m, an object in the way or an actor without a position or class may be nearer than every vehicle that is seen (nearest), or in the ego's way behind a lead that is beside it {position}
    gap_m DOUBLE,                     -- see lead {position, heading, size}
    speed_mps DOUBLE,                 -- speed of the vehicle along the lane, in either direction {velocity}
    accel_mps2 DOUBLE,                -- acceleration of the vehicle, mean over the 0.5 s up to the step; NULL: not known {velocity}
    ego_speed_mps DOUBLE,             -- the ego's speed {velocity}
    in_lane BOOLEAN,                  -- part of the ego's box is in the running lane {position}
    oncoming BOOLEAN,                 -- the vehicle heads against the corridor {position, heading, velocity}
    across_m DOUBLE,                  -- gap between the two boxes across the corridor; negative: overlap {position, heading, size}
    ego_across_mps DOUBLE,            -- the ego's speed across the corridor, positive towards the vehicle {velocity}
    across_mps DOUBLE,                -- the vehicle's speed across the corridor, positive towards the ego {velocity}
    error_mps DOUBLE NOT NULL,        -- see lead {velocity}
    closing_more_mps DOUBLE NOT NULL, -- by how much faster the two may come nearer than at the recorded speeds, where a velocity is in doubt; infinite: no bound; 0: no doubt {velocity}
    closing_less_mps DOUBLE NOT NULL, -- by how much slower, likewise {velocity}
    joined_ns BIGINT,                 -- of the lead: the time since which it is the lead, if it or the ego changed lanes then. Of another vehicle: the later of its last cut-in and the ego's last lane change; NULL: it was ahead before, or its arrival was not seen {position}
    let_in_ns BIGINT,                 -- joined_ns, if the ego did not change lanes; of a vehicle other than the lead: its last cut-in {position}
    passes_by BOOLEAN,                -- at the present velocities, the two boxes pass each other without contact: where lanes turn or cross, a vehicle ahead along the lane may be out of the way; NULL: the meeting is more than 3 s away, or not known {position}
    grazes BOOLEAN,                   -- it is not known whether the boxes pass without contact: they miss each other by less than the uncertainty of velocities and lane, or overlap by less than that of the headings {position, heading, size}
    free_m DOUBLE,                    -- where known is false: no actor is nearer to the ego's front in its lane than this distance {position, heading, size}
    free_mps DOUBLE                   -- where known is false: upper bound of the speed at which an actor comes nearer: the ego's speed, plus 70 mph unless the actor drives in the ego's direction {velocity}
);

INSERT INTO vehicle_ahead BY NAME
WITH
lane_summary AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns,
        [
            min({'gap_m': p.gap_m, 'id': p.object_id}) FILTER (is_vehicle(p.actor_class) AND p.across_m < 0).id,
            min({'gap_m': p.gap_m, 'id': p.object_id}) FILTER (is_vehicle(p.actor_class) AND p.soon).id,
            min({'gap_m': p.gap_m, 'id': p.object_id}) FILTER (is_vehicle(p.actor_class) AND p.oncoming AND p.speed_mps <= standing_mps() IS DISTINCT FROM true).id
        ] AS ids,
        min(p.gap_m) FILTER (is_vehicle(p.actor_class)) AS gap_m, max(p.speed_mps) FILTER (is_vehicle(p.actor_class) AND p.oncoming) AS coming_mps,
        coalesce(bool_or(p.oncoming IS DISTINCT FROM false) FILTER (is_vehicle(p.actor_class)), false) AS has_oncoming, min(p.gap_m) FILTER (is_vehicle(p.actor_class) AND p.across_m < 0) AS way_gap_m,
        min(p.gap_m) FILTER (is_vehicle(p.actor_class) IS NULL AND p.outside) AS outside_m,
        min(p.gap_m) FILTER (is_vehicle(p.actor_class) IS DISTINCT FROM true AND p.gap_m < unsure_reach_m(e.speed_mps)) AS unclassified_m
    FROM _lane_ahead p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    GROUP BY ALL
),
hidden_vehicle AS (
    SELECT drive_id, ego_id, t_ns, min(lane_m) FILTER (NOT late) AS least_m, min(lane_m) FILTER (late) AS late_m, bool_and(along) AS along
    FROM hidden
    WHERE vehicle AND ahead IS DISTINCT FROM false AND NOT beside_lane
    GROUP BY ALL
),
further_vehicle AS (
    SELECT l.drive_id, l.ego_id, l.t_ns, l.ego_speed_mps, l.in_lane, unnest(list_distinct(c.ids)) AS object_id
    FROM lead l
    JOIN lane_summary c USING (drive_id, ego_id, t_ns)
),
actor_with_filtered_velocity AS (SELECT DISTINCT drive_id, actor_id FROM quality WHERE check_id = 'velocity_filtered'),
half_second_begin AS (
    SELECT
        drive_id, ego_id, t_ns,
        first_value(t_ns) OVER (PARTITION BY drive_id, ego_id, seg ORDER BY t_ns RANGE BETWEEN 500_000_000 PRECEDING AND CURRENT ROW) AS t_half_second_ns
    FROM step
),
vehicle_or_doubt AS (
    SELECT
        l.drive_id, l.ego_id, l.t_ns, l.object_id, true AS nearest, true AS known, l.gap_m, l.speed_mps, l.accel_mps2, l.ego_speed_mps, l.in_lane, l.oncoming, l.across_m,
        l.ego_across_mps, l.across_mps, l.error_mps, CASE WHEN l.joined THEN l.t_since_ns END AS joined_ns,
        -- If the ego changed into the lane itself, it did not let the lead in.
        CASE WHEN x.t_ns IS NULL THEN joined_ns END AS let_in_ns
    FROM lead l
    LEFT JOIN lane_crossing x ON x.drive_id = l.drive_id AND x.ego_id = l.ego_id AND x.t_ns = l.t_since_ns
    UNION ALL BY NAME
    SELECT
        m.drive_id, m.ego_id, m.t_ns, m.object_id, false AS nearest, true AS known, p.gap_m, p.speed_mps,
        CASE WHEN f.actor_id IS NULL AND b.heading_diff_rad IS NOT NULL AND m.t_ns - h.t_half_second_ns >= least_mean_ns() THEN 1e9 * (p.speed_mps - along_lane_mps(b.speed_mps, b.heading_diff_rad)) / (m.t_ns - h.t_half_second_ns) END AS accel_mps2,
        m.ego_speed_mps, m.in_lane, p.oncoming, p.across_m, p.ego_across_mps, p.across_mps,
        filtered_error_mps() * ((f.actor_id IS NOT NULL)::INTEGER + (g.actor_id IS NOT NULL)::INTEGER) AS error_mps,
        -- greatest() ignores NULL, as intended here.
        greatest(i.t_ns, x.t_ns) AS joined_ns, i.t_ns AS let_in_ns
    FROM further_vehicle m
    JOIN lead l ON l.drive_id = m.drive_id AND l.ego_id = m.ego_id AND l.t_ns = m.t_ns AND l.object_id IS DISTINCT FROM m.object_id
    JOIN _lane_ahead p ON p.drive_id = m.drive_id AND p.ego_id = m.ego_id AND p.t_ns = m.t_ns AND p.object_id = m.object_id
    JOIN half_second_begin h ON h.drive_id = m.drive_id AND h.ego_id = m.ego_id AND h.t_ns = m.t_ns
    LEFT JOIN pair b ON b.drive_id = m.drive_id AND b.ego_id = m.ego_id AND b.t_ns = h.t_half_second_ns AND b.object_id = m.object_id
    LEFT JOIN actor_with_filtered_velocity f ON f.drive_id = m.drive_id AND f.actor_id = m.object_id
    LEFT JOIN actor_with_filtered_velocity g ON g.drive_id = m.drive_id AND g.actor_id = m.ego_id
    ASOF LEFT JOIN cut_in i ON i.drive_id = m.drive_id AND i.ego_id = m.ego_id AND i.object_id = m.object_id AND i.t_ns <= m.t_ns
    ASOF LEFT JOIN lane_crossing x ON x.drive_id = m.drive_id AND x.ego_id = m.ego_id AND x.t_ns <= m.t_ns
    UNION ALL BY NAME
    -- An actor without a position on the corridor, or of unknown class, may be in the ego's way behind a lead that is beside that way.
    SELECT l.drive_id, l.ego_id, l.t_ns, NULL AS object_id, false AS nearest, false AS known, l.ego_speed_mps, l.in_lane, 0.0 AS error_mps,
        least(d.least_m, d.late_m, c.unclassified_m, c.outside_m) AS free_m, l.ego_speed_mps + CASE WHEN d.along AND c.unclassified_m IS NULL AND c.outside_m IS NULL THEN 0.0 ELSE fastest_mps() END AS free_mps
    FROM lead l
    LEFT JOIN lane_summary c USING (drive_id, ego_id, t_ns)
    LEFT JOIN hidden_vehicle d USING (drive_id, ego_id, t_ns)
    WHERE l.object_id IS NOT NULL AND l.in_lane IS DISTINCT FROM false
        AND (least(d.least_m, c.unclassified_m) < coalesce(c.way_gap_m, lead_reach_m(l.ego_speed_mps)) OR c.way_gap_m IS NULL AND d.late_m < lead_reach_m(l.ego_speed_mps))
        -- An ego out of its lane may meet an object that is beside the lane (outside), whatever vehicle is in the lane.
        OR c.outside_m < coalesce(c.way_gap_m, lead_reach_m(l.ego_speed_mps))
    UNION ALL BY NAME
    -- No lead is known: an actor without a position on the corridor, or of unknown class, may be nearer than every vehicle that is seen.
    SELECT
        e.drive_id, e.ego_id, e.t_ns, NULL AS object_id, true AS nearest, false AS known, e.speed_mps AS ego_speed_mps, 0.0 AS error_mps,
        least(d.least_m, d.late_m, c.unclassified_m, c.gap_m) AS free_m,
        e.speed_mps + CASE WHEN d.along AND c.unclassified_m IS NULL AND NOT coalesce(c.has_oncoming, false) THEN 0.0 ELSE greatest(fastest_mps(), c.coming_mps) END AS free_mps
    FROM ego_state e
    ANTI JOIN lead l ON l.drive_id = e.drive_id AND l.ego_id = e.ego_id AND l.t_ns = e.t_ns
    LEFT JOIN lane_summary c USING (drive_id, ego_id, t_ns)
    LEFT JOIN hidden_vehicle d USING (drive_id, ego_id, t_ns)
    WHERE e.front_s_m IS NOT NULL AND c.outside_m IS NULL AND least(d.least_m, d.late_m, c.unclassified_m) IS NOT NULL
),
-- The two boxes in the frame of the ego's box, and their relative motion at the present velocities.
relative_motion AS (
    SELECT
        t.drive_id, t.ego_id, t.t_ns, t.object_id, ttc_s(t.gap_m, t.ego_speed_mps - along_mps(t.speed_mps, t.oncoming)) AS ttc_s,
        east_m * cos(e.yaw_rad) + north_m * sin(e.yaw_rad) AS dx, north_m * cos(e.yaw_rad) - east_m * sin(e.yaw_rad) AS dy, cos(turn_rad) AS c, sin(turn_rad) AS s,
        (o.vx_mps - v.vx_mps) * cos(e.yaw_rad) + (o.vy_mps - v.vy_mps) * sin(e.yaw_rad) AS motion_x_mps,
        (o.vy_mps - v.vy_mps) * cos(e.yaw_rad) - (o.vx_mps - v.vx_mps) * sin(e.yaw_rad) AS motion_y_mps,
        -- If the lane bends before the meeting, the ego may not drive straight on. The two may come nearer by this distance.
        least_apart_m() + abs(t.gap_m * wrap_rad(turn_rad + e.heading_diff_rad - p.heading_diff_rad)) AS room_m,
        e.length_m / 2 AS ego_half_length_m, e.width_m / 2 AS ego_half_width_m, p.length_m / 2 AS object_half_length_m, p.width_m / 2 AS object_half_width_m
    FROM vehicle_or_doubt t
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    JOIN pair p ON p.drive_id = t.drive_id AND p.ego_id = t.ego_id AND p.t_ns = t.t_ns AND p.object_id = t.object_id
    JOIN state_dynamics v ON v.drive_id = t.drive_id AND v.actor_id = t.ego_id AND v.t_ns = t.t_ns
    ASOF JOIN state_dynamics o ON o.drive_id = t.drive_id AND o.actor_id = t.object_id AND o.t_ns <= t.t_ns
    CROSS JOIN LATERAL (SELECT p.x_m - e.x_m AS east_m, p.y_m - e.y_m AS north_m, p.yaw_rad - e.yaw_rad AS turn_rad) f
    WHERE t.gap_m >= 0 AND p.speed_mps IS NOT NULL
),
-- The boxes touch while they overlap along each of the four directions of their sides. This is checked for three sizes: the boxes as they
-- are, with a margin of room_m (see relative_motion), and reduced by least_apart_m.
box_contact AS (
    SELECT drive_id, ego_id, t_ns, object_id, greatest(0.0, w[1].from_s, w[2].from_s, w[3].from_s, w[4].from_s) > least(w[1].to_s, w[2].to_s, w[3].to_s, w[4].to_s) AS is_miss
    FROM (
        SELECT
            drive_id, ego_id, t_ns, object_id,
            [
                time_within(dx, motion_x_mps, m + ego_half_length_m + object_half_length_m * abs(c) + object_half_width_m * abs(s)), time_within(dy, motion_y_mps, m + ego_half_width_m + object_half_length_m * abs(s) + object_half_width_m * abs(c)),
                time_within(dx * c + dy * s, motion_x_mps * c + motion_y_mps * s, m + object_half_length_m + ego_half_length_m * abs(c) + ego_half_width_m * abs(s)),
                time_within(dy * c - dx * s, motion_y_mps * c - motion_x_mps * s, m + object_half_width_m + ego_half_length_m * abs(s) + ego_half_width_m * abs(c))
            ] AS w
        FROM relative_motion CROSS JOIN LATERAL (VALUES (0.0), (room_m), (-least_apart_m())) AS v(m)
        -- Whether the boxes just touch or just miss matters only if the meeting is near.
        WHERE ttc_s < drift_s() AND (m >= 0 OR ttc_s < late_s())
    )
    WHERE w[1] IS NOT NULL AND w[2] IS NOT NULL AND w[3] IS NOT NULL AND w[4] IS NOT NULL
),
miss_check AS (
    SELECT drive_id, ego_id, t_ns, object_id, bool_and(is_miss) AS passes_by, bool_or(is_miss) AND NOT bool_and(is_miss) AS grazes
    FROM box_contact
    GROUP BY drive_id, ego_id, t_ns, object_id
)
SELECT
    t.*, c.passes_by, c.grazes,
    above_mps(v.t_ns, v.most_mps, t.ego_speed_mps)
        + above_mps(o.t_ns, CASE WHEN t.oncoming THEN along.most_mps WHEN NOT t.oncoming THEN -along.least_mps END, along_mps(t.speed_mps, NOT t.oncoming)) AS closing_more_mps,
    above_mps(v.t_ns, -v.least_mps, -t.ego_speed_mps)
        + above_mps(o.t_ns, CASE WHEN t.oncoming THEN -along.least_mps WHEN NOT t.oncoming THEN along.most_mps END, along_mps(t.speed_mps, t.oncoming)) AS closing_less_mps
FROM vehicle_or_doubt t
LEFT JOIN velocity_bound v ON v.drive_id = t.drive_id AND v.ego_id = t.ego_id AND v.t_ns = t.t_ns AND v.object_id IS NULL
LEFT JOIN velocity_bound o ON o.drive_id = t.drive_id AND o.ego_id = t.ego_id AND o.t_ns = t.t_ns AND o.object_id = t.object_id
LEFT JOIN pair b ON b.drive_id = t.drive_id AND b.ego_id = t.ego_id AND b.t_ns = t.t_ns AND b.object_id = o.object_id
CROSS JOIN LATERAL (SELECT along_lane_mps(o.least_mps, b.heading_diff_rad) AS least_mps, o.most_mps) along
LEFT JOIN miss_check c ON c.drive_id = t.drive_id AND c.ego_id = t.ego_id AND c.t_ns = t.t_ns AND c.object_id = t.object_id
