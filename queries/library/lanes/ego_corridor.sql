-- The position of the ego's box in its running chains. The centre and each corner have segments of their own, so that the box is not tilted
-- in a bend. If a chain meets itself, the station that continues the last one counts.
-- lifetime: part
CREATE TABLE ego_corridor (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- a running chain whose strip contains the ego
    t_ns BIGINT NOT NULL,             -- the step
    s_m DOUBLE NOT NULL,              -- chain station of the box centre {position}
    d_m DOUBLE NOT NULL,              -- offset of the centre from the running lane's centre line, left positive {position}
    left_out_m DOUBLE,                -- distance of the outermost corner beyond the running lane's left boundary; negative: all corners are inside {position, heading, size}
    left_in_m DOUBLE,                 -- distance of the innermost corner beyond the left boundary; positive: the whole box is beyond it {position}
    right_out_m DOUBLE,               -- distance of the outermost corner beyond the right boundary; negative: all corners are inside {position, heading, size}
    right_in_m DOUBLE,                -- distance of the innermost corner beyond the right boundary; positive: the whole box is beyond it {position}
    front_s_m DOUBLE,                 -- chain station of the foremost corner {position, heading, size}
    rear_s_m DOUBLE,                  -- chain station of the rearmost corner {position, heading, size}
    lat_half_m DOUBLE,                -- half the extent of the box across the corridor {heading, size}
    half_width_m DOUBLE NOT NULL,     -- half width of the running lane at the centre's station
    over_width_m DOUBLE,              -- see _corridor
    over_against BOOLEAN,             -- see _corridor {position, heading, size}
    side INTEGER,                     -- see _corridor {position}
    heading_diff_rad DOUBLE           -- the ego's heading relative to the corridor, -pi..pi {heading}
);

INSERT INTO ego_corridor BY NAME
WITH ego_box AS (
    SELECT st.drive_id, st.ego_id, st.t_ns, s.x_m, s.y_m, s.yaw_rad, s.length_m / 2 AS half_box_length_m, s.width_m / 2 AS half_box_width_m, st.travel_m
    FROM step st
    JOIN state_dynamics s ON s.drive_id = st.drive_id AND s.actor_id = st.ego_id AND s.t_ns = st.t_ns
    WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL
),
box_point AS (
    SELECT drive_id, ego_id, t_ns, 0 AS p, x_m, y_m FROM ego_box
    UNION ALL
    SELECT
        drive_id, ego_id, t_ns, c.p,
        x_m + c.l * half_box_length_m * cos(yaw_rad) - c.w * half_box_width_m * sin(yaw_rad),
        y_m + c.l * half_box_length_m * sin(yaw_rad) + c.w * half_box_width_m * cos(yaw_rad)
    FROM ego_box CROSS JOIN (VALUES (1, 1, 1), (2, 1, -1), (3, -1, 1), (4, -1, -1)) AS c(p, l, w)
    WHERE yaw_rad IS NOT NULL AND half_box_length_m IS NOT NULL AND half_box_width_m IS NOT NULL
),
point_candidate AS (
    SELECT
        a.drive_id, a.ego_id, a.t_ns, a.p, a.x_m, a.y_m, c.* EXCLUDE (drive_id, ego_id, cell),
        along0(a.x_m, a.y_m, c.x0_m, c.y0_m, c.tx0, c.ty0) AS a0,
        along1(a.x_m, a.y_m, c.x1_m, c.y1_m, c.tx1, c.ty1) AS a1
    FROM (FROM box_point SEMI JOIN (FROM data_log WHERE environment_id IS NOT NULL) USING (drive_id)) a
    JOIN _corridor_cell c ON c.drive_id = a.drive_id AND c.ego_id = a.ego_id AND c.cell = corridor_cell_of(a.x_m, a.y_m)
),
point_on_strip AS (
    SELECT
        drive_id, ego_id, t_ns, p, lanelet_id, s0_m + u * len_m AS lane_s_m, d_m, hw0_m + u * (hw1_m - hw0_m) AS half_width_m,
        atan2(ty0 + u * (ty1 - ty0), tx0 + u * (tx1 - tx0)) AS heading_rad
    FROM (
        SELECT *, a0 / (a0 + a1) AS u, offset_left(x_m, y_m, a0 / (a0 + a1), x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1) AS d_m
        FROM point_candidate
        WHERE a0 >= -slack0_m AND a1 > -slack1_m AND a0 + a1 > 0
    )
    WHERE abs(d_m) <= strip_m()
),
-- A chain that returns to a lanelet, as on a test track, contains it once per lap. Each occurrence applies from the midpoint between it and
-- the previous one.
occurrence AS (
    SELECT
        drive_id, ego_id, chain_id, lanelet_id, s_start_m, over_width_m, over_against, side,
        coalesce((lag(s_start_m) OVER (PARTITION BY drive_id, ego_id, chain_id, lanelet_id ORDER BY s_start_m) + s_start_m) / 2, '-infinity'::DOUBLE) AS from_m
    FROM _corridor
),
chain_lanelet AS (
    SELECT DISTINCT drive_id, ego_id, chain_id, lanelet_id FROM _corridor
),
-- The stations of the ego that are certain: those at which its lanelet is part of the chain.
certain_station AS (
    SELECT e.drive_id, e.ego_id, c.chain_id, e.t_ns, c.s_start_m + e.s_m - s.travel_m AS station_minus_travel_m
    FROM ego_lane e
    JOIN chain c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.lanelet_id = e.lanelet_id
    JOIN step s ON s.drive_id = e.drive_id AND s.ego_id = e.ego_id AND s.t_ns = e.t_ns
    WHERE e.with_direction AND e.t_ns BETWEEN c.t_first_ns AND c.t_last_ns
),
centre_on_lane AS (
    SELECT p.*, l.chain_id, g.travel_m + f.station_minus_travel_m AS expected_s_m
    FROM point_on_strip p
    JOIN chain_lanelet l USING (drive_id, ego_id, lanelet_id)
    JOIN ego_box g USING (drive_id, ego_id, t_ns)
    ASOF LEFT JOIN certain_station f ON f.drive_id = p.drive_id AND f.ego_id = p.ego_id AND f.chain_id = l.chain_id AND f.t_ns <= p.t_ns
    WHERE p.p = 0
),
best_centre AS (
    SELECT
        p.drive_id, p.ego_id, p.chain_id, p.t_ns,
        min({
            'off_m': coalesce(abs(o.s_start_m + p.lane_s_m - p.expected_s_m), abs(p.d_m)),
            's_m': o.s_start_m + p.lane_s_m, 'd_m': p.d_m, 'half_width_m': p.half_width_m, 'heading_rad': p.heading_rad,
            'over_width_m': o.over_width_m, 'over_against': o.over_against, 'side': o.side
        }) AS b
    FROM centre_on_lane p
    ASOF JOIN occurrence o
        ON o.drive_id = p.drive_id AND o.ego_id = p.ego_id AND o.chain_id = p.chain_id AND o.lanelet_id = p.lanelet_id
            AND o.from_m <= coalesce(p.expected_s_m - p.lane_s_m, '-infinity'::DOUBLE)
    GROUP BY ALL
),
corner_on_lane AS (
    SELECT p.*, b.chain_id, b.b.s_m AS centre_s_m
    FROM best_centre b
    JOIN point_on_strip p ON p.drive_id = b.drive_id AND p.ego_id = b.ego_id AND p.t_ns = b.t_ns AND p.p > 0
),
best_corner AS (
    SELECT
        p.drive_id, p.ego_id, p.chain_id, p.t_ns, p.p,
        min({
            'off_m': abs(o.s_start_m + p.lane_s_m - p.centre_s_m), 's_m': o.s_start_m + p.lane_s_m,
            'd_m': p.d_m, 'half_width_m': p.half_width_m
        }) AS c
    FROM corner_on_lane p
    ASOF JOIN occurrence o
        ON o.drive_id = p.drive_id AND o.ego_id = p.ego_id AND o.chain_id = p.chain_id AND o.lanelet_id = p.lanelet_id
            AND o.from_m <= p.centre_s_m - p.lane_s_m
    WHERE abs(o.s_start_m + p.lane_s_m - p.centre_s_m) < 30
    GROUP BY ALL
),
box_extent AS (
    SELECT
        drive_id, ego_id, chain_id, t_ns,
        max(c.d_m - c.half_width_m) AS left_out_m, min(c.d_m - c.half_width_m) AS left_in_m,
        max(-c.d_m - c.half_width_m) AS right_out_m, min(-c.d_m - c.half_width_m) AS right_in_m,
        max(c.s_m) AS front_s_m, min(c.s_m) AS rear_s_m, (max(c.d_m) - min(c.d_m)) / 2 AS lat_half_m
    FROM best_corner
    GROUP BY ALL
    HAVING count(*) = 4
),
-- Without a map, the ego is in the middle of its own path. While it reverses, that path has nothing ahead.
own_place AS (
    SELECT
        b.drive_id, b.ego_id, w.seg, b.t_ns, w.s0_m + w.len_m * greatest(0.0, least(1.0, a.a0 / nullif(a.a0 + a.a1, 0))) AS s_m, b.half_box_width_m + own_lane_beside_m() AS half_width_m,
        b.half_box_length_m, b.half_box_width_m, wrap_rad(b.yaw_rad - atan2(w.ty0 + w.ty1, w.tx0 + w.tx1)) AS turn_rad
    FROM ego_box b
    JOIN step st USING (drive_id, ego_id, t_ns)
    ASOF JOIN (SELECT * FROM _own_way SEMI JOIN (FROM data_log WHERE environment_id IS NULL) USING (drive_id) WHERE t_from_ns IS NOT NULL) w
        ON w.drive_id = st.drive_id AND w.ego_id = st.ego_id AND w.seg = st.seg AND w.t_from_ns <= st.t_ns
    CROSS JOIN LATERAL (SELECT along0(b.x_m, b.y_m, w.x0_m, w.y0_m, w.tx0, w.ty0) AS a0, along1(b.x_m, b.y_m, w.x1_m, w.y1_m, w.tx1, w.ty1) AS a1) a
)
SELECT
    b.drive_id, b.ego_id, b.chain_id, b.t_ns, b.b.s_m AS s_m, b.b.d_m AS d_m,
    e.left_out_m, e.left_in_m, e.right_out_m, e.right_in_m, e.front_s_m, e.rear_s_m, e.lat_half_m,
    b.b.half_width_m AS half_width_m, b.b.over_width_m AS over_width_m, b.b.over_against AS over_against, b.b.side AS side,
    wrap_rad(g.yaw_rad - b.b.heading_rad) AS heading_diff_rad
FROM best_centre b
JOIN ego_box g USING (drive_id, ego_id, t_ns)
LEFT JOIN box_extent e USING (drive_id, ego_id, chain_id, t_ns)
UNION ALL
SELECT
    drive_id, ego_id, seg, t_ns, s_m, 0.0, -own_lane_beside_m(), -2 * half_width_m, -own_lane_beside_m(), -2 * half_width_m,
    CASE WHEN abs(turn_rad) < pi() / 2 THEN s_m + half_box_length_m END, CASE WHEN abs(turn_rad) < pi() / 2 THEN s_m - half_box_length_m END, half_box_width_m,
    half_width_m, NULL, NULL, NULL, turn_rad
FROM own_place
WHERE s_m IS NOT NULL AND half_width_m IS NOT NULL
