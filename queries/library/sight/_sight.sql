-- How far the ego sees at the steps at which an object is missing: around it up to the nearest box, and along its own lane up to the first
-- actor in the lane. If the lane is not straight, the view ends at the first point that a box hides.
-- lifetime: part
CREATE TABLE _sight (
    drive_id VARCHAR NOT NULL,        -- the drive; only where data_log.in_sight holds
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which an actor without a position is or may be present
    around_m DOUBLE NOT NULL,         -- distance from the ego's middle within which nothing blocks the view: up to the nearest box, or the sensor's range {position}
    lane_m DOUBLE NOT NULL,           -- distance ahead of the ego's front within which its lane is in plain view {position}
    vehicle_lane_m DOUBLE NOT NULL    -- distance ahead of the ego's front within which no vehicle can be hidden in its lane; a box that reaches less than half a metre into the lane hides no vehicle {position}
);

INSERT INTO _sight BY NAME
WITH missing_step AS (
    SELECT DISTINCT drive_id, ego_id, t_ns
    FROM (
        SELECT drive_id, ego_id, t_ns FROM _unseen
        UNION ALL
        SELECT drive_id, ego_id, t_ns FROM pair WHERE x_m IS NULL OR y_m IS NULL
    )
),
-- occasion: missing_step
viewpoint AS (
    SELECT e.*, sight_m(g.sensor_range_m) AS range_m
    FROM missing_step
    JOIN data_log g ON g.drive_id = missing_step.drive_id AND g.in_sight
    JOIN ego_state e ON e.drive_id = missing_step.drive_id AND e.ego_id = missing_step.ego_id AND e.t_ns = missing_step.t_ns
),
-- A box of unknown heading or size is taken to be as large as it can be.
box_in_range AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, p.distance_m - r.half_diagonal_m AS around_m, p.s_m > e.s_m AS is_ahead,
        abs(p.d_m) - coalesce(p.lat_half_m, r.half_diagonal_m) - p.half_width_m AS beside_lane_m,
        coalesce(p.rear_s_m, p.s_m - r.half_diagonal_m) - e.front_s_m AS lane_m
    FROM viewpoint e
    JOIN pair p USING (drive_id, ego_id, t_ns)
    CROSS JOIN LATERAL (SELECT box_half_diagonal_m(p.actor_class, p.length_m, p.width_m) AS half_diagonal_m) r
    WHERE p.distance_m < e.range_m
),
nearest_box AS (
    SELECT
        drive_id, ego_id, t_ns, min(around_m) AS around_m,
        min(lane_m) FILTER (is_ahead AND beside_lane_m < 0) AS lane_m, min(lane_m) FILTER (is_ahead AND beside_lane_m < -hides_vehicle_m()) AS vehicle_distance_m
    FROM box_in_range
    GROUP BY ALL
),
corridor_segment AS (
    SELECT c.drive_id, c.ego_id, c.chain_id, c.s_start_m + g.s0_m AS s_m, g.x0_m, g.y0_m, g.tx0, g.ty0
    FROM _corridor c
    JOIN data_log l USING (drive_id)
    JOIN _lane_segment g ON g.environment_id = l.environment_id AND g.lanelet_id = c.lanelet_id
    WHERE l.in_sight
    UNION ALL
    SELECT w.drive_id, w.ego_id, w.seg, w.s0_m, w.x0_m, w.y0_m, w.tx0, w.ty0
    FROM _own_way w
    SEMI JOIN (FROM data_log WHERE environment_id IS NULL AND in_sight) l ON l.drive_id = w.drive_id
),
-- Beyond the end of its own path, the ego's lane is not known.
own_way_end AS (
    SELECT w.drive_id, w.ego_id, w.seg AS chain_id, max(w.s0_m + w.len_m) AS end_m
    FROM _own_way w
    SEMI JOIN (FROM data_log WHERE environment_id IS NULL) l ON l.drive_id = w.drive_id
    GROUP BY ALL
),
ego_segment AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, e.chain_id, e.s_m, e.range_m, p.x0_m, p.y0_m, p.tx0, p.ty0
    FROM viewpoint e
    ASOF JOIN corridor_segment p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.chain_id = e.chain_id AND p.s_m <= e.s_m
),
-- A lane is straight if its centre line, at four distances up to the end of the range, stays near the ego's tangent.
straight_lane AS (
    SELECT o.drive_id, o.ego_id, o.t_ns
    FROM (
        SELECT *, s_m + v.share * range_m AS place_s_m FROM ego_segment CROSS JOIN (VALUES (0.25), (0.5), (0.75), (1.0)) AS v(share)
    ) o
    ASOF JOIN corridor_segment p ON p.drive_id = o.drive_id AND p.ego_id = o.ego_id AND p.chain_id = o.chain_id AND p.s_m <= o.place_s_m
    GROUP BY ALL
    HAVING max(abs((p.y0_m - o.y0_m) * o.tx0 - (p.x0_m - o.x0_m) * o.ty0)) < straight_m()
),
-- In a bend: points along the centre of the lane, and the nearest one that is behind a box.
lane_place AS (
    SELECT o.drive_id, o.ego_id, o.t_ns, e.x_m, e.y_m, o.along_m, p.x0_m + (o.s_m + o.along_m - p.s_m) * p.tx0 - e.x_m AS dx_m, p.y0_m + (o.s_m + o.along_m - p.s_m) * p.ty0 - e.y_m AS dy_m
    FROM (
        SELECT o.*, s_m + v.k * sight_step_m() AS place_s_m, v.k * sight_step_m() AS along_m
        FROM ego_segment o
        ANTI JOIN straight_lane USING (drive_id, ego_id, t_ns)
        CROSS JOIN LATERAL (SELECT unnest(range(1, (range_m / sight_step_m())::BIGINT)) AS k) v
    ) o
    JOIN viewpoint e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.t_ns = o.t_ns
    ASOF JOIN corridor_segment p ON p.drive_id = o.drive_id AND p.ego_id = o.ego_id AND p.chain_id = o.chain_id AND p.s_m <= o.place_s_m
),
hidden_place AS (
    SELECT drive_id, ego_id, t_ns, min(along_m) - sight_step_m() AS along_m
    FROM (
        SELECT a.drive_id, a.ego_id, a.t_ns, a.along_m
        FROM lane_place a
        CROSS JOIN LATERAL (SELECT sqrt(a.dx_m ** 2 + a.dy_m ** 2) AS distance_m) x
        JOIN pair p ON p.drive_id = a.drive_id AND p.ego_id = a.ego_id AND p.t_ns = a.t_ns AND p.distance_m < x.distance_m + box_half_diagonal_m(p.actor_class, p.length_m, p.width_m)
            AND coalesce(
                blocks_sight(p.x_m - a.x_m, p.y_m - a.y_m, a.dx_m, a.dy_m, p.yaw_rad, p.length_m, p.width_m),
                may_block_sight(p.x_m - a.x_m, p.y_m - a.y_m, a.dx_m, a.dy_m, box_half_diagonal_m(p.actor_class, p.length_m, p.width_m))
            )
        UNION ALL
        -- A row with NULL for each step, for steps at which nothing blocks the view; otherwise min() ignores it. A left join with
        -- blocks_sight in its condition would be a nested loop.
        SELECT drive_id, ego_id, t_ns, NULL FROM lane_place
    )
    GROUP BY drive_id, ego_id, t_ns
)
SELECT
    e.drive_id, e.ego_id, e.t_ns, greatest(0.0, least(n.around_m, e.range_m)) AS around_m,
    greatest(0.0, CASE
        WHEN r.t_ns IS NOT NULL OR b.t_ns IS NOT NULL THEN least(n.lane_m, w.end_m - e.front_s_m, least(b.along_m, e.range_m - both_half_diagonals_m() / 2) - e.length_m / 2)
        ELSE least(n.around_m, e.range_m) - e.length_m / 2
    END) AS lane_m,
    greatest(0.0, CASE
        WHEN r.t_ns IS NOT NULL OR b.t_ns IS NOT NULL THEN least(n.vehicle_distance_m, w.end_m - e.front_s_m, least(b.along_m, e.range_m - both_half_diagonals_m() / 2) - e.length_m / 2)
        ELSE least(n.around_m, e.range_m) - e.length_m / 2
    END) AS vehicle_lane_m
FROM viewpoint e
LEFT JOIN nearest_box n USING (drive_id, ego_id, t_ns)
LEFT JOIN straight_lane r USING (drive_id, ego_id, t_ns)
LEFT JOIN hidden_place b USING (drive_id, ego_id, t_ns)
LEFT JOIN own_way_end w ON w.drive_id = e.drive_id AND w.ego_id = e.ego_id AND w.chain_id = e.chain_id
