-- Steps at which "nobody is coming" cannot be claimed: a vehicle is present without a position, moves off every lane nearer than the
-- corridor reaches, or its track begins or ends where it must have been on the road. Of one that comes in over the far end of the map
-- it is known that it was beyond it until then; while the ego was far from there, that has a reason of its own, as has one that was met already.
WITH blind AS (
    SELECT drive_id, ego_id, t_ns, object_id, 'has no position (or no fresh one)' AS reason
    FROM pair
    WHERE may_be_vehicle(actor_class) AND (x_m IS NULL OR y_m IS NULL)
),
off_lane AS (
    SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, 'moves off the lanes' AS reason
    FROM (
        SELECT * FROM pair
        WHERE may_be_vehicle(actor_class) AND distance_m < corridor_ahead_m() AND (speed_mps IS NULL OR speed_mps > standing_mps())
    ) p
    ANTI JOIN (SELECT drive_id, actor_id, t_ns FROM lane_occupancy WHERE drivable) o
        ON o.drive_id = p.drive_id AND o.actor_id = p.object_id AND o.t_ns = p.t_ns
),
incomplete AS (
    SELECT drive_id, ego_id, t_ns, object_id, CASE WHEN yaw_rad IS NULL THEN 'has no heading' ELSE 'has no size' END AS reason
    FROM pair
    WHERE may_be_vehicle(actor_class) AND x_m IS NOT NULL AND (yaw_rad IS NULL OR length_m IS NULL OR width_m IS NULL)
),
edge AS (
    SELECT drive_id, ego_id, object_id, actor_class, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns FROM pair GROUP BY ALL
),
-- a vehicle that was on its way along the corridor when its track ended or began: as long as it would take to meet the ego
ended AS (
    SELECT
        e.drive_id, e.ego_id, e.object_id, p.t_ns + 1 AS t_from_ns, p.t_ns + reach.ns AS t_to_ns,
        CASE WHEN p.front_s_m < s.rear_s_m AND abs(p.heading_diff_rad) > 2 * pi() / 3 AND p.speed_mps > standing_mps()
            THEN 'was lost behind, driving away' ELSE 'was lost from the log nearby'
        END AS reason
    FROM edge e
    JOIN clock c USING (drive_id, ego_id)
    JOIN data_log g USING (drive_id)
    JOIN pair p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.object_id = e.object_id AND p.t_ns = e.t_last_ns
    JOIN ego_state s ON s.drive_id = e.drive_id AND s.ego_id = e.ego_id AND s.t_ns = e.t_last_ns
    CROSS JOIN LATERAL (SELECT unseen_ns(p.distance_m, p.speed_mps, s.speed_mps) AS ns) reach
    WHERE may_be_vehicle(e.actor_class) AND e.t_last_ns + c.max_gap_ns < c.t_end_ns
        AND (p.distance_m IS NULL OR p.distance_m < lost_near_m() OR p.distance_m < g.sensor_range_m
            OR (p.s_m > s.s_m AND abs(p.heading_diff_rad) > pi() / 2))
),
far_end AS (
    SELECT r.drive_id, r.ego_id, r.chain_id, r.last.end_m AS end_m
    FROM (
        SELECT drive_id, ego_id, chain_id, max({'end_m': s_start_m + length_m, 'id': lanelet_id}) AS last FROM corridor GROUP BY ALL
    ) r
    JOIN data_log g USING (drive_id)
    JOIN lane_next n ON n.environment_id = g.environment_id AND n.lanelet_id = r.last.id
    WHERE n.ahead_id IS NULL
),
began AS (
    SELECT
        e.drive_id, e.ego_id, e.object_id, p.t_ns - reach.ns AS t_from_ns, p.t_ns - 1 AS t_to_ns, 'appeared in the log nearby' AS reason,
        -- a sample earlier it was not on the map yet
        CASE WHEN abs(p.heading_diff_rad) > pi() / 2 AND p.front_s_m + p.speed_mps * c.max_gap_ns / 1e9 >= f.end_m THEN f.end_m END AS end_m,
        s.chain_id
    FROM edge e
    JOIN clock c USING (drive_id, ego_id)
    JOIN data_log g USING (drive_id)
    JOIN pair p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.object_id = e.object_id AND p.t_ns = e.t_first_ns
    JOIN ego_state s ON s.drive_id = e.drive_id AND s.ego_id = e.ego_id AND s.t_ns = e.t_first_ns
    LEFT JOIN far_end f ON f.drive_id = s.drive_id AND f.ego_id = s.ego_id AND f.chain_id = s.chain_id
    CROSS JOIN LATERAL (SELECT unseen_ns(p.distance_m, p.speed_mps, s.speed_mps) AS ns) reach
    WHERE may_be_vehicle(e.actor_class) AND e.t_first_ns > c.t_start_ns + c.max_gap_ns
        -- what comes into a finite sensor's range at its edge was outside it before
        AND (p.distance_m IS NULL OR p.distance_m < lost_near_m() OR p.distance_m < 0.8 * g.sensor_range_m
            OR (g.sensor_range_m IS NULL AND p.s_m > s.s_m AND abs(p.heading_diff_rad) > pi() / 2))
),
outside AS (
    SELECT
        t.drive_id, t.ego_id, st.t_ns, t.object_id,
        CASE WHEN e.chain_id = t.chain_id AND t.end_m - e.front_s_m >= beyond_map_m() THEN 'came in over the end of the map' ELSE t.reason END AS reason
    FROM (FROM ended UNION ALL BY NAME FROM began) t
    JOIN step st ON st.drive_id = t.drive_id AND st.ego_id = t.ego_id AND st.t_ns >= t.t_from_ns AND st.t_ns <= t.t_to_ns
    LEFT JOIN ego_state e ON e.drive_id = st.drive_id AND e.ego_id = st.ego_id AND e.t_ns = st.t_ns
)
SELECT drive_id, ego_id, t_ns, object_id, min(reason) AS reason
FROM (SELECT * FROM blind UNION ALL SELECT * FROM off_lane UNION ALL SELECT * FROM incomplete UNION ALL SELECT * FROM outside)
GROUP BY ALL
