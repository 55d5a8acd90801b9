-- The actors, and the lanes, around every moment.
INSERT INTO scene BY NAME
WITH state AS (
    SELECT drive_id, ego_id, t_ns, ego_id AS actor_id, x_m, y_m, yaw_rad, speed_mps, accel_mps2, d_m FROM ego_state
    UNION ALL
    SELECT drive_id, ego_id, t_ns, object_id, x_m, y_m, yaw_rad, speed_mps, accel_mps2, d_m FROM pair
),
present AS (
    SELECT m.drive_id, m.ego_id, m.t_ns, m.environment_id, m.ego_id AS actor_id, a.actor_class, e.length_m, e.width_m, e.x_m, e.y_m, e.yaw_rad, e.speed_mps
    FROM _moment m
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    LEFT JOIN actor a ON a.drive_id = m.drive_id AND a.actor_id = m.ego_id
    UNION ALL BY NAME
    SELECT m.drive_id, m.ego_id, m.t_ns, m.environment_id, p.object_id AS actor_id, p.actor_class, p.length_m, p.width_m, p.x_m, p.y_m, p.yaw_rad, p.speed_mps
    FROM _moment m
    JOIN pair p USING (drive_id, ego_id, t_ns)
    WHERE p.x_m IS NOT NULL AND p.y_m IS NOT NULL AND p.distance_m <= m.reach_m
),
way AS (
    SELECT a.drive_id, a.ego_id, a.at_ns AS t_ns, s.actor_id,
        list({
            't_ns': a.t_ns, 'x_m': round(s.x_m, 2), 'y_m': round(s.y_m, 2), 'yaw_rad': round(s.yaw_rad, 3),
            'speed_mps': round(s.speed_mps, 3), 'accel_mps2': round(s.accel_mps2, 2), 'd_m': CASE WHEN p.environment_id IS NOT NULL THEN round(s.d_m, 2) END
        } ORDER BY a.t_ns) AS path
    FROM _around a
    JOIN present p ON p.drive_id = a.drive_id AND p.ego_id = a.ego_id AND p.t_ns = a.at_ns  -- the others are not drawn
    JOIN state s ON s.drive_id = a.drive_id AND s.ego_id = a.ego_id AND s.t_ns = a.t_ns AND s.actor_id = p.actor_id
    WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL
    GROUP BY ALL
),
scene_actors AS (
    SELECT p.drive_id, p.ego_id, p.t_ns, list({
            'actor_id': p.actor_id, 'actor_class': p.actor_class, 'length_m': p.length_m, 'width_m': p.width_m,
            'x_m': round(p.x_m, 3), 'y_m': round(p.y_m, 3), 'yaw_rad': round(p.yaw_rad, 4),
            'speed_mps': round(p.speed_mps, 3), 'path': w.path
        } ORDER BY p.actor_id <> p.ego_id, p.actor_id) AS actors
    FROM present p
    LEFT JOIN way w USING (drive_id, ego_id, t_ns, actor_id)
    GROUP BY ALL
),
extents AS (
    SELECT environment_id, lanelet_id, min(least(left_x_m, right_x_m)) AS x0, max(greatest(left_x_m, right_x_m)) AS x1,
        min(least(left_y_m, right_y_m)) AS y0, max(greatest(left_y_m, right_y_m)) AS y1
    FROM lane_point GROUP BY ALL
),
near_lanelets AS (
    SELECT m.drive_id, m.ego_id, m.t_ns, list(b.lanelet_id ORDER BY b.lanelet_id) AS lanelets
    FROM _moment m
    JOIN extents b ON b.environment_id = m.environment_id AND b.x0 <= m.x_m + m.reach_m AND b.x1 >= m.x_m - m.reach_m
        AND b.y0 <= m.y_m + m.reach_m AND b.y1 >= m.y_m - m.reach_m
    GROUP BY ALL
)
SELECT m.drive_id, m.ego_id, m.t_ns, m.environment_id, round(m.reach_m, 1) AS reach_m, coalesce(n.lanelets, []) AS lanelets, c.actors
FROM _moment m
JOIN scene_actors c USING (drive_id, ego_id, t_ns)
LEFT JOIN near_lanelets n USING (drive_id, ego_id, t_ns)
