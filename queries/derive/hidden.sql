-- Whoever is or may be there and has no place in the corridor, with the least distance that he can have: from where he was seen last and
-- where he is seen next, nobody comes faster than 60 m/s. Who moves off the lanes has a place as long as the corridor reaches past him.
WITH unseen AS (
    SELECT drive_id, ego_id, t_ns, object_id, actor_class FROM pair WHERE x_m IS NULL OR y_m IS NULL
    UNION ALL
    SELECT u.drive_id, u.ego_id, u.t_ns, u.object_id, a.actor_class
    FROM unplaced u
    JOIN actor a ON a.drive_id = u.drive_id AND a.actor_id = u.object_id
    WHERE u.reason IN (
        'was lost from the log nearby', 'was lost behind, driving away', 'appeared in the log nearby', 'came in over the end of the map'
    )
),
seen AS (
    SELECT p.drive_id, p.ego_id, p.object_id, p.t_ns, p.distance_m
    FROM (SELECT DISTINCT drive_id, ego_id, object_id FROM unseen) u
    JOIN pair p ON p.drive_id = u.drive_id AND p.ego_id = u.ego_id AND p.object_id = u.object_id
    WHERE p.distance_m IS NOT NULL
),
bounded AS (
    SELECT
        u.*,
        -- greatest() leaves out the one that is not there, as it should here
        greatest(
            b.distance_m - unseen_closing_mps() * (u.t_ns - b.t_ns) / 1e9,
            a.distance_m - unseen_closing_mps() * (a.t_ns - u.t_ns) / 1e9
        ) AS distance_m
    FROM unseen u
    ASOF LEFT JOIN seen b ON b.drive_id = u.drive_id AND b.ego_id = u.ego_id AND b.object_id = u.object_id AND b.t_ns <= u.t_ns
    ASOF LEFT JOIN seen a ON a.drive_id = u.drive_id AND a.ego_id = u.ego_id AND a.object_id = u.object_id AND a.t_ns >= u.t_ns
),
incomplete AS (
    SELECT drive_id, ego_id, t_ns, object_id, actor_class, distance_m, x_m, y_m
    FROM pair
    WHERE x_m IS NOT NULL AND y_m IS NOT NULL AND (yaw_rad IS NULL OR length_m IS NULL OR width_m IS NULL)
),
reach AS (
    SELECT drive_id, ego_id, chain_id, min(s_start_m) AS begin_m, max(s_start_m + length_m) AS end_m FROM corridor GROUP BY ALL
),
-- off the lanes, and further away than the corridor reaches: it may be on the road that the map does not have
beyond AS (
    SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, p.actor_class, p.distance_m, p.x_m, p.y_m
    FROM unplaced u
    JOIN pair p ON p.drive_id = u.drive_id AND p.ego_id = u.ego_id AND p.t_ns = u.t_ns AND p.object_id = u.object_id
    JOIN ego_state e ON e.drive_id = u.drive_id AND e.ego_id = u.ego_id AND e.t_ns = u.t_ns
    JOIN reach r ON r.drive_id = e.drive_id AND r.ego_id = e.ego_id AND r.chain_id = e.chain_id
    WHERE u.reason = 'moves off the lanes' AND p.s_m IS NULL AND p.distance_m > least(r.end_m - e.s_m, e.s_m - r.begin_m)
),
-- where the lanes of a chain do not meet: an end without a link though the map goes on, and holes between one and the next
last_piece AS (
    SELECT
        c.drive_id, c.ego_id, c.chain_id, c.seq, c.seq = max(c.seq) OVER (PARTITION BY c.drive_id, c.ego_id, c.chain_id) AS is_last,
        g.environment_id, c.lanelet_id, c.s_start_m + c.length_m AS end_m,
        p.x1_m AS x_m, p.y1_m AS y_m, p.tx1 AS tx, p.ty1 AS ty, p.hw1_m AS half_width_m
    FROM corridor c
    JOIN data_log g USING (drive_id)
    JOIN lane_segment p ON p.environment_id = g.environment_id AND p.lanelet_id = c.lanelet_id AND p.slack1_m > 0
),
hole AS (
    -- who is straight on from there is ahead, if only the link is missing
    SELECT e.*, 'inf'::DOUBLE AS hole_m
    FROM last_piece e
    JOIN lane_next n ON n.environment_id = e.environment_id AND n.lanelet_id = e.lanelet_id
    WHERE e.is_last AND n.ahead_id IS NULL
    UNION ALL
    SELECT e.*, along0(f.x0_m, f.y0_m, e.x_m, e.y_m, e.tx, e.ty) AS hole_m
    FROM last_piece e
    JOIN corridor c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.chain_id = e.chain_id AND c.seq = e.seq + 1
    JOIN lane_segment f ON f.environment_id = e.environment_id AND f.lanelet_id = c.lanelet_id AND f.k = 0
    WHERE hole_m > f.slack0_m
),
ahead_of AS (SELECT *, unnest(range(floor(end_m / 500)::BIGINT - 2, floor(end_m / 500)::BIGINT + 1)) AS bucket FROM hole),
in_hole AS (
    SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, p.actor_class, p.distance_m, p.x_m, p.y_m
    FROM ego_state e
    JOIN ahead_of l ON l.drive_id = e.drive_id AND l.ego_id = e.ego_id AND l.chain_id = e.chain_id AND l.bucket = floor(e.s_m / 500)::BIGINT
    JOIN pair p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.t_ns = e.t_ns
    WHERE p.s_m IS NULL AND e.s_m < l.end_m AND along0(p.x_m, p.y_m, l.x_m, l.y_m, l.tx, l.ty) > 0
        AND along0(p.x_m, p.y_m, l.x_m, l.y_m, l.tx, l.ty) <= l.hole_m
        AND abs((p.y_m - l.y_m) * l.tx - (p.x_m - l.x_m) * l.ty) < l.half_width_m + 1
)
SELECT
    drive_id, ego_id, t_ns, object_id, actor_class, may_be_vehicle(actor_class) AS vehicle,
    greatest(0.0::DOUBLE, coalesce(distance_m, 0.0) - two_half_boxes_m()) AS least_m, NULL::BOOLEAN AS ahead
FROM bounded
UNION ALL
SELECT
    h.drive_id, h.ego_id, h.t_ns, h.object_id, h.actor_class, may_be_vehicle(h.actor_class),
    greatest(0.0::DOUBLE, coalesce(h.distance_m, 0.0) - two_half_boxes_m()),
    CASE WHEN h.distance_m > two_half_boxes_m() THEN (h.x_m - e.x_m) * cos(e.yaw_rad) + (h.y_m - e.y_m) * sin(e.yaw_rad) > 0 END
FROM (SELECT * FROM incomplete UNION ALL SELECT * FROM beyond UNION SELECT * FROM in_hole) h
JOIN ego_state e USING (drive_id, ego_id, t_ns)
