-- Every actor that is or may be there and has no place in the corridor, with the least distance that it can have: from where it was seen
-- last and where it is seen next it comes no nearer than 60 m/s and its tyres allow; what drives along the road, the ego's way or against it,
-- neither turns round nor backs. Where the log is taken to have whoever is in plain view
-- (data_log.in_sight), one that is not recorded for a while is not there. An actor off the lanes has a place as long as the corridor reaches
-- past it.
WITH nowhere AS (
    SELECT drive_id, ego_id, t_ns, object_id, actor_class, off_level FROM pair WHERE x_m IS NULL OR y_m IS NULL
),
sample AS (
    SELECT s.drive_id, s.actor_id, s.t_ns
    FROM state_dynamics s
    SEMI JOIN nowhere n ON n.drive_id = s.drive_id AND n.object_id = s.actor_id
),
missing AS (
    -- a sample without a place says that it is there
    SELECT
        n.drive_id, n.ego_id, n.t_ns, n.object_id, n.actor_class, NOT n.off_level AND n.t_ns - s.t_ns > c.max_gap_ns AS unrecorded,
        NULL::DOUBLE AS ahead_m, NULL::DOUBLE AS behind_m, NULL::DOUBLE AS off_ahead_m, NULL::DOUBLE AS off_behind_m
    FROM nowhere n
    JOIN clock c USING (drive_id, ego_id)
    ASOF LEFT JOIN sample s ON s.drive_id = n.drive_id AND s.actor_id = n.object_id AND s.t_ns <= n.t_ns
    UNION ALL
    SELECT u.drive_id, u.ego_id, u.t_ns, u.object_id, a.actor_class, true, u.ahead_m, u.behind_m, u.off_ahead_m, u.off_behind_m
    FROM unseen u
    JOIN road_user a ON a.drive_id = u.drive_id AND a.actor_id = u.object_id
),
seen AS (
    SELECT
        p.drive_id, p.ego_id, p.object_id, p.t_ns, p.distance_m, p.x_m, p.y_m, half_box_m(p.length_m, p.width_m) AS half_m,
        CASE WHEN p.actor_class = 'pedestrian' THEN 0.0 ELSE p.speed_mps * cos(p.yaw_rad) END AS vx_mps,
        CASE WHEN p.actor_class = 'pedestrian' THEN 0.0 ELSE p.speed_mps * sin(p.yaw_rad) END AS vy_mps,
        -- along the road, of what drives the ego's way (1), or moves against it (-1)
        CASE
            WHEN p.actor_class IS NOT DISTINCT FROM 'pedestrian' THEN NULL
            WHEN abs(p.heading_diff_rad) < pi() / 4
                THEN {'road': r.road, 'chain_id': r.chain_id, 'way': 1, 'front_m': p.front_s_m + r.offset_m, 'rear_m': p.rear_s_m + r.offset_m, 'v_mps': p.speed_mps}
            WHEN abs(p.heading_diff_rad) > 3 * pi() / 4 AND p.speed_mps > moves_mps() AND is_vehicle(p.actor_class)
                THEN {'road': r.road, 'chain_id': r.chain_id, 'way': -1, 'front_m': p.front_s_m + r.offset_m, 'rear_m': p.rear_s_m + r.offset_m, 'v_mps': p.speed_mps}
        END AS along
    FROM (SELECT DISTINCT drive_id, ego_id, object_id FROM missing) u
    JOIN pair p ON p.drive_id = u.drive_id AND p.ego_id = u.ego_id AND p.object_id = u.object_id
    JOIN ego_state e ON e.drive_id = p.drive_id AND e.ego_id = p.ego_id AND e.t_ns = p.t_ns
    LEFT JOIN ego_road r ON r.drive_id = e.drive_id AND r.ego_id = e.ego_id AND r.chain_id = e.chain_id
    WHERE p.distance_m IS NOT NULL
),
-- from where it was seen last and where it is seen next: how far it is at least, straight on and braking or turning as hard as tyres do
sighted AS (
    SELECT
        m.*, b.t_ns AS t_before_ns, a.t_ns AS t_after_ns, r.road, e.speed_mps, e.front_s_m + r.offset_m AS front_m, e.rear_s_m + r.offset_m AS rear_m, e.length_m, e.width_m, e.combination_m, coalesce(greatest(b.half_m, a.half_m), half_box_m(NULL, NULL)) AS half_m,
        coalesce(
            g.in_sight AND m.unrecorded AND coalesce(b.t_ns, a.t_ns) IS NOT NULL
            AND (b.t_ns IS NULL OR m.t_ns > tb.plain_ns) AND (a.t_ns IS NULL OR m.t_ns < ta.plain_ns), false
        ) AS late,
        CASE WHEN b.along.road = r.road THEN b.along END AS before, CASE WHEN a.along.road = r.road THEN a.along END AS after,
        CASE WHEN b.along.chain_id = r.chain_id THEN 0.0 ELSE lanes_apart_m() END AS before_apart_m,
        CASE WHEN a.along.chain_id = r.chain_id THEN 0.0 ELSE lanes_apart_m() END AS after_apart_m,
        b.distance_m - unseen_closing_mps() * (m.t_ns - b.t_ns) / 1e9 AS before_m, a.distance_m - unseen_closing_mps() * (a.t_ns - m.t_ns) / 1e9 AS after_m,
        (m.t_ns - b.t_ns) / 1e9 AS before_s, (a.t_ns - m.t_ns) / 1e9 AS after_s,
        b.x_m + b.vx_mps * before_s - e.x_m AS before_x_m, b.y_m + b.vy_mps * before_s - e.y_m AS before_y_m, a.x_m - a.vx_mps * after_s - e.x_m AS after_x_m, a.y_m - a.vy_mps * after_s - e.y_m AS after_y_m
    FROM missing m
    ASOF LEFT JOIN seen b ON b.drive_id = m.drive_id AND b.ego_id = m.ego_id AND b.object_id = m.object_id AND b.t_ns <= m.t_ns
    ASOF LEFT JOIN seen a ON a.drive_id = m.drive_id AND a.ego_id = m.ego_id AND a.object_id = m.object_id AND a.t_ns >= m.t_ns
    JOIN ego_state e ON e.drive_id = m.drive_id AND e.ego_id = m.ego_id AND e.t_ns = m.t_ns
    JOIN data_log g ON g.drive_id = m.drive_id
    LEFT JOIN ego_road r ON r.drive_id = e.drive_id AND r.ego_id = e.ego_id AND r.chain_id = e.chain_id
    LEFT JOIN track_end tb ON tb.drive_id = m.drive_id AND tb.ego_id = m.ego_id AND tb.object_id = m.object_id AND tb.lost AND tb.t_ns = b.t_ns
    LEFT JOIN track_end ta ON ta.drive_id = m.drive_id AND ta.ego_id = m.ego_id AND ta.object_id = m.object_id AND NOT ta.lost AND ta.t_ns = a.t_ns
),
-- between which stations it can be
stretch AS (
    SELECT
        *,
        -- greatest() and least() leave out what is not there, as they should here
        greatest(
            before.rear_m - before_apart_m + CASE before.way WHEN 1 THEN drives_least_m(before.v_mps, before_s) ELSE -drives_most_m(before.v_mps, before_s) END,
            after.rear_m - after_apart_m + CASE after.way WHEN 1 THEN -drives_most_m(after.v_mps, after_s) ELSE drives_least_m(after.v_mps, after_s) END
        ) AS from_m,
        least(
            before.front_m + before_apart_m + CASE before.way WHEN 1 THEN drives_most_m(before.v_mps, before_s) ELSE -drives_least_m(before.v_mps, before_s) END,
            after.front_m + after_apart_m + CASE after.way WHEN 1 THEN -drives_least_m(after.v_mps, after_s) ELSE drives_most_m(after.v_mps, after_s) END
        ) AS to_m
    FROM sighted
),
bounded AS (
    SELECT
        drive_id, ego_id, t_ns, object_id, actor_class, late, t_before_ns, t_after_ns, road, speed_mps, coalesce(before, after) IS NOT NULL AS on_road,
        half_m + greatest(half_box_m(length_m, width_m), CASE WHEN combination_m = length_m THEN 0.0 ELSE coalesce(combination_m, 2 * two_half_boxes_m()) - length_m / 2 END) AS halves_m,
        greatest(before_m, after_m, sqrt(before_x_m ** 2 + before_y_m ** 2) - strays_m(actor_class, before_s), sqrt(after_x_m ** 2 + after_y_m ** 2) - strays_m(actor_class, after_s), ahead_m, behind_m, CASE WHEN off_ahead_m IS NOT NULL THEN least(off_ahead_m, off_behind_m) END) AS distance_m,
        greatest(from_m - front_m, rear_m - to_m) AS along_m, off_ahead_m - half_m AS off_ahead_m,
        CASE WHEN ahead_m > 0 OR from_m > front_m THEN true WHEN behind_m > 0 OR to_m < rear_m THEN false END AS ahead,
        coalesce(CASE WHEN t_before_ns IS NOT NULL THEN before.way = 1 ELSE true END AND CASE WHEN t_after_ns IS NOT NULL THEN after.way = 1 ELSE true END AND coalesce(t_before_ns, t_after_ns) IS NOT NULL, false) AS along
    FROM stretch
),
-- where all around the ego is in plain view, nobody drives past it unseen: whoever was, or will be, ahead or behind is so until then
watched AS (
    SELECT
        b.*, g.around_m, g.lane_m AS in_view_m,
        b.late AND coalesce(g.around_m >= watched_m(b.speed_mps, greatest(b.t_ns - lag(b.t_ns) OVER w, lead(b.t_ns) OVER w - b.t_ns) / 1e9), false) AS in_view
    FROM bounded b
    LEFT JOIN sight g USING (drive_id, ego_id, t_ns)
    WINDOW w AS (PARTITION BY b.drive_id, b.ego_id, b.object_id ORDER BY b.t_ns)
),
counted AS (
    SELECT
        *, sum((NOT in_view)::INTEGER) OVER (PARTITION BY drive_id, ego_id, object_id, road, t_before_ns ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS n_since,
        sum((NOT in_view)::INTEGER) OVER (PARTITION BY drive_id, ego_id, object_id, road, t_after_ns ORDER BY t_ns DESC ROWS UNBOUNDED PRECEDING) AS n_until
    FROM watched
),
ordered AS (
    SELECT
        * REPLACE (coalesce(ahead, CASE WHEN on_road AND was.n = n_since THEN was.ahead END, CASE WHEN on_road AND will_be.n = n_until THEN will_be.ahead END) AS ahead)
    FROM (
        SELECT
            *,
            last_value(CASE WHEN ahead IS NOT NULL AND on_road THEN {'ahead': ahead, 'n': n_since} END IGNORE NULLS)
                OVER (PARTITION BY drive_id, ego_id, object_id, road, t_before_ns ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS was,
            last_value(CASE WHEN ahead IS NOT NULL AND on_road THEN {'ahead': ahead, 'n': n_until} END IGNORE NULLS)
                OVER (PARTITION BY drive_id, ego_id, object_id, road, t_after_ns ORDER BY t_ns DESC ROWS UNBOUNDED PRECEDING) AS will_be
        FROM counted
    )
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
    WHERE u.code = 'off_lanes' AND p.s_m IS NULL AND p.distance_m > least(r.end_m - e.s_m, e.s_m - r.begin_m)
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
    greatest(0.0::DOUBLE, coalesce(distance_m, 0.0) - halves_m, along_m, CASE WHEN late THEN coalesce(around_m, 0.0) - halves_m END) AS least_m, ahead, along, late,
    greatest(least_m, off_ahead_m, CASE WHEN late THEN in_view_m END) AS lane_m
FROM ordered
UNION ALL
SELECT
    h.drive_id, h.ego_id, h.t_ns, h.object_id, h.actor_class, may_be_vehicle(h.actor_class),
    greatest(0.0::DOUBLE, coalesce(h.distance_m, 0.0) - two_half_boxes_m()),
    CASE WHEN h.distance_m > two_half_boxes_m() THEN (h.x_m - e.x_m) * cos(e.yaw_rad) + (h.y_m - e.y_m) * sin(e.yaw_rad) > 0 END,
    false, false, greatest(0.0::DOUBLE, coalesce(h.distance_m, 0.0) - two_half_boxes_m())
FROM (SELECT * FROM incomplete UNION ALL SELECT * FROM beyond UNION SELECT * FROM in_hole) h
JOIN ego_state e USING (drive_id, ego_id, t_ns)
