-- Actors whose track ends or begins while the log continues, near enough to matter, and the steps at which they may still be on the road.
-- `near`: when seen, the actor was close, within the sensor's range, or coming towards the ego. While it is not seen, it may be anywhere on
-- the road. If its position is in doubt when it is last or first seen, it may have been near.
-- lifetime: part
CREATE TABLE _unseen (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which the log does not have the object
    object_id VARCHAR NOT NULL,       -- an actor whose track ends before this step or begins after it, near enough to matter
    near BOOLEAN NOT NULL,            -- when seen, the object was close, within the sensor's range or coming towards the ego: it may be anywhere on the road {position}
    code VARCHAR NOT NULL,            -- [unseen_cause]
    ahead_m DOUBLE,                   -- if the object entered or left the map over its far end: distance from the ego's front to that end; NULL: it did not {position}
    behind_m DOUBLE,                  -- if it entered or left the map over its near end: distance from the ego's rear to that end; NULL: it did not {position}
    off_ahead_m DOUBLE,               -- if it entered or left the map over any end, of any road, and so is not on the ego's corridor: distance from the ego's front to the corridor's far end; NULL: it did not {position}
    off_behind_m DOUBLE               -- in the same case: distance from the ego's rear to the corridor's near end; NULL: as off_ahead_m {position}
);

INSERT INTO _unseen BY NAME
WITH track_edge AS (
    SELECT e.drive_id, e.ego_id, e.object_id, v.lost, v.t_ns, c.max_gap_ns
    FROM (SELECT drive_id, ego_id, object_id, actor_class, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns FROM pair GROUP BY ALL) e
    JOIN clock c USING (drive_id, ego_id)
    CROSS JOIN LATERAL (VALUES (true, e.t_last_ns), (false, e.t_first_ns)) AS v(lost, t_ns)
    WHERE CASE WHEN v.lost THEN v.t_ns + c.max_gap_ns < c.t_end_ns ELSE v.t_ns > c.t_start_ns + c.max_gap_ns END
),
-- occasion: track_edge
-- The ends of the ego's corridor, and the ends of the map ahead of the ego and behind it.
map_end AS (
    SELECT
        r.drive_id, r.ego_id, r.chain_id, CASE WHEN n.ahead_id IS NULL THEN r.last_lanelet.end_m END AS end_m, CASE WHEN f.behind_id IS NULL THEN r.first_lanelet.begin_m END AS begin_m,
        r.last_lanelet.end_m AS corridor_end_m, r.first_lanelet.begin_m AS corridor_begin_m
    FROM (
        SELECT
            drive_id, ego_id, chain_id, max({'end_m': s_start_m + length_m, 'id': lanelet_id}) AS last_lanelet, min({'begin_m': s_start_m, 'id': lanelet_id}) AS first_lanelet
        FROM _corridor
        GROUP BY ALL
    ) r
    JOIN data_log g USING (drive_id)
    JOIN lane_next n ON n.environment_id = g.environment_id AND n.lanelet_id = r.last_lanelet.id
    JOIN lane_next f ON f.environment_id = g.environment_id AND f.lanelet_id = r.first_lanelet.id
),
-- Samples whose position is in doubt, and steps of egos for which this is so.
doubted_place AS (
    SELECT DISTINCT st.drive_id, st.ego_id, d.actor_id, st.t_ns
    FROM doubt d
    JOIN step st ON st.drive_id = d.drive_id AND st.t_ns BETWEEN d.t_from_ns AND d.t_to_ns
    WHERE doubts_place(d.quantity)
),
-- Tracks that end or begin at an end of the map: along the actor's own lane, the next sample (or the one before) lies beyond the map, and
-- no adjacent lane continues.
track_at_map_end AS (
    SELECT e.drive_id, e.ego_id, e.object_id, e.lost
    FROM track_edge e
    JOIN data_log g USING (drive_id)
    JOIN state_dynamics s ON s.drive_id = e.drive_id AND s.actor_id = e.object_id AND s.t_ns = e.t_ns
    JOIN lane_occupancy o ON o.drive_id = e.drive_id AND o.actor_id = e.object_id AND o.t_ns = e.t_ns AND o.drivable
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
    JOIN lane_next w ON w.environment_id = n.environment_id AND w.lanelet_id = n.lanelet_id
    CROSS JOIN LATERAL (SELECT (abs(o.heading_diff_rad) < pi() / 2) = e.lost AS is_onwards) x
    CROSS JOIN LATERAL (SELECT s.length_m / 2 + s.speed_mps * e.max_gap_ns / 1e9 AS m) r
    GROUP BY ALL
    HAVING bool_and(coalesce(
        CASE WHEN x.is_onwards THEN w.map_ends AND n.length_m - o.s_m <= r.m ELSE w.map_begins AND o.s_m <= r.m END, false
    ))
),
sighting AS (
    SELECT
        e.drive_id, e.ego_id, e.object_id, e.lost, p.t_ns, s.chain_id, credible.distance_m, p.speed_mps, s.speed_mps AS ego_speed_mps, g.sensor_range_m,
        credible.front_s_m, credible.rear_s_m, s.rear_s_m AS ego_rear_m, p.s_m > s.s_m AS is_ahead, abs(p.heading_diff_rad) > pi() / 2 AS is_towards,
        abs(p.heading_diff_rad) > 2 * pi() / 3 AND p.speed_mps > standing_mps() AS oncoming, p.speed_mps * e.max_gap_ns / 1e9 AS sample_way_m, m.end_m, m.begin_m,
        r.road, r.offset_m, d.object_id IS NOT NULL AND credible.is_placed AS is_off_map
    FROM track_edge e
    JOIN data_log g USING (drive_id)
    JOIN pair p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.object_id = e.object_id AND p.t_ns = e.t_ns
    JOIN ego_state s ON s.drive_id = e.drive_id AND s.ego_id = e.ego_id AND s.t_ns = e.t_ns
    LEFT JOIN map_end m ON m.drive_id = s.drive_id AND m.ego_id = s.ego_id AND m.chain_id = s.chain_id
    LEFT JOIN _ego_road r ON r.drive_id = s.drive_id AND r.ego_id = s.ego_id AND r.chain_id = s.chain_id
    LEFT JOIN track_at_map_end d ON d.drive_id = e.drive_id AND d.ego_id = e.ego_id AND d.object_id = e.object_id AND d.lost = e.lost
    LEFT JOIN doubted_place a ON a.drive_id = e.drive_id AND a.ego_id = e.ego_id AND a.actor_id = e.object_id AND a.t_ns = e.t_ns
    LEFT JOIN doubted_place b ON b.drive_id = e.drive_id AND b.ego_id = e.ego_id AND b.actor_id = e.ego_id AND b.t_ns = e.t_ns
    CROSS JOIN LATERAL (SELECT a.t_ns IS NULL AND b.t_ns IS NULL AS is_placed) q
    CROSS JOIN LATERAL (
        SELECT q.is_placed, CASE WHEN q.is_placed THEN p.distance_m END AS distance_m, CASE WHEN q.is_placed THEN p.front_s_m END AS front_s_m, CASE WHEN q.is_placed THEN p.rear_s_m END AS rear_s_m
    ) credible
    ANTI JOIN _track_off_level l ON l.drive_id = e.drive_id AND l.ego_id = e.ego_id AND l.object_id = e.object_id AND l.lost = e.lost
),
judged_sighting AS (
    SELECT
        *,
        CASE
            WHEN lost AND front_s_m < ego_rear_m AND oncoming THEN 'lost_behind' WHEN lost THEN 'lost' ELSE 'appeared'
        END AS code,
        -- An object that enters a finite sensor range at its edge was outside the range before.
        coalesce(
            distance_m IS NULL OR distance_m < lost_near_m() OR distance_m < CASE WHEN lost THEN 1.0 ELSE 0.8 END * sensor_range_m
            OR ((lost OR sensor_range_m IS NULL) AND is_ahead AND is_towards),
            false
        ) AS near,
        -- One sample earlier, or later, the object was not on the map.
        CASE WHEN is_towards <> lost AND front_s_m + sample_way_m >= end_m THEN end_m END AS beyond_end_m,
        CASE WHEN is_towards = lost AND rear_s_m - sample_way_m <= begin_m THEN begin_m END AS beyond_begin_m
    FROM sighting
)
SELECT
    t.drive_id, t.ego_id, st.t_ns, t.object_id, t.near AND abs(st.t_ns - t.t_ns) <= horizon.near_horizon_ns AS near,
    CASE WHEN x.ahead_m >= beyond_map_m() OR least(x.off_ahead_m, x.off_behind_m) >= beyond_map_m() THEN 'beyond_map' ELSE t.code END AS code,
    x.ahead_m, x.behind_m, x.off_ahead_m, x.off_behind_m
FROM judged_sighting t
CROSS JOIN LATERAL (
    SELECT unseen_ns(t.distance_m, t.speed_mps, t.ego_speed_mps, 20.0) AS horizon_ns, unseen_ns(t.distance_m, t.speed_mps, t.ego_speed_mps, 10.0) AS near_horizon_ns
) horizon
JOIN step st ON st.drive_id = t.drive_id AND st.ego_id = t.ego_id
    AND CASE WHEN t.lost THEN st.t_ns > t.t_ns AND st.t_ns <= t.t_ns + horizon.horizon_ns ELSE st.t_ns < t.t_ns AND st.t_ns >= t.t_ns - horizon.horizon_ns END
LEFT JOIN ego_state e ON e.drive_id = st.drive_id AND e.ego_id = st.ego_id AND e.t_ns = st.t_ns
LEFT JOIN _ego_road r ON r.drive_id = e.drive_id AND r.ego_id = e.ego_id AND r.chain_id = e.chain_id
LEFT JOIN map_end m ON m.drive_id = e.drive_id AND m.ego_id = e.ego_id AND m.chain_id = e.chain_id
CROSS JOIN LATERAL (SELECT CASE WHEN r.road = t.road THEN t.offset_m - r.offset_m END AS shift_m, CASE WHEN r.chain_id = t.chain_id THEN 0.0 ELSE lane_station_error_m() END AS station_error_m) y
CROSS JOIN LATERAL (
    SELECT
        t.beyond_end_m + y.shift_m - y.station_error_m - e.front_s_m AS ahead_m, e.rear_s_m - t.beyond_begin_m - y.shift_m - y.station_error_m AS behind_m,
        -- An object that is not on the map is on no lane of the corridor.
        CASE WHEN t.is_off_map AND e.rear_s_m > m.corridor_begin_m AND e.front_s_m < m.corridor_end_m THEN m.corridor_end_m - e.front_s_m END AS off_ahead_m,
        CASE WHEN t.is_off_map AND e.rear_s_m > m.corridor_begin_m AND e.front_s_m < m.corridor_end_m THEN e.rear_s_m - m.corridor_begin_m END AS off_behind_m
) x
WHERE t.near OR t.distance_m < reach_m(t.speed_mps, t.ego_speed_mps)
