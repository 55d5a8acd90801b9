-- Who comes towards the ego on the lane that it would overtake in (paper: OV and DA), and how far that can be told.
-- A vehicle that comes from another lane counts from 15 s before it gets there, at the distance that it then really made.
WITH reach AS (
    SELECT c.drive_id, c.ego_id, c.chain_id, max(c.s_start_m + c.length_m) AS end_m, max({'seq': c.seq, 'id': c.lanelet_id}).id AS last_id
    FROM corridor c
    GROUP BY ALL
),
ego AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, e.s_m, e.front_s_m, x.side, x.half_width_m, x.over_width_m,
        -- everybody is placed on the corridor at least so far ahead, however far the ego's own way leads on
        least(r.end_m - e.front_s_m, corridor_ahead_m()) AS corridor_m,
        n.ahead_id IS NULL AND r.end_m - e.front_s_m <= corridor_ahead_m() AS map_ends, g.sensor_range_m - e.length_m / 2 AS range_m
    FROM ego_state e
    JOIN ego_corridor x ON x.drive_id = e.drive_id AND x.ego_id = e.ego_id AND x.chain_id = e.chain_id AND x.t_ns = e.t_ns
    JOIN reach r ON r.drive_id = e.drive_id AND r.ego_id = e.ego_id AND r.chain_id = e.chain_id
    JOIN data_log g ON g.drive_id = e.drive_id
    LEFT JOIN lane_next n ON n.environment_id = g.environment_id AND n.lanelet_id = r.last_id
    WHERE e.front_s_m IS NOT NULL AND x.side IS NOT NULL
),
against AS (
    SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, p.rear_s_m, p.speed_mps, p.rear_s_m - e.front_s_m AS da_m, is_vehicle(p.actor_class) AS vehicle
    FROM pair p
    JOIN ego e USING (drive_id, ego_id, t_ns)
    WHERE may_be_vehicle(p.actor_class) AND p.s_m > e.s_m AND abs(p.heading_diff_rad) > 2 * pi() / 3
        AND e.side * p.d_m - p.lat_half_m < p.half_width_m + coalesce(p.over_width_m, e.over_width_m, 2 * p.half_width_m)
        -- standing the wrong way round in the running lane it is parked there; moving it is oncoming
        AND e.side * p.d_m + p.lat_half_m > CASE WHEN p.speed_mps <= standing_mps() THEN p.half_width_m + over_boundary_m() ELSE -p.half_width_m END
),
entry AS (
    SELECT drive_id, ego_id, object_id, min({'t_ns': t_ns, 's_m': rear_s_m}) AS e FROM against WHERE vehicle GROUP BY ALL
),
-- the way that it still had to make, from each of the steps before it got there
approach AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, p.object_id, p.speed_mps, p.x_m, y.e.s_m AS entry_s_m,
        sqrt((p.x_m - lead(p.x_m) OVER w) ** 2 + (p.y_m - lead(p.y_m) OVER w) ** 2) AS step_m, p.t_ns = y.e.t_ns AS there
    FROM entry y
    JOIN pair p ON p.drive_id = y.drive_id AND p.ego_id = y.ego_id AND p.object_id = y.object_id
        AND p.t_ns <= y.e.t_ns AND p.t_ns >= y.e.t_ns - 15_000_000_000
    WINDOW w AS (PARTITION BY p.drive_id, p.ego_id, p.object_id ORDER BY p.t_ns)
),
coming AS (
    SELECT a.drive_id, a.ego_id, a.t_ns, a.object_id, a.speed_mps, a.entry_s_m - e.front_s_m + a.way_m AS da_m
    FROM (
        SELECT *, of_pm(sum(whole_pm(coalesce(step_m, 0.0))) OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY t_ns DESC ROWS UNBOUNDED PRECEDING)) AS way_m
        FROM approach
    ) a
    JOIN ego e USING (drive_id, ego_id, t_ns)
    WHERE NOT a.there AND a.x_m IS NOT NULL AND a.entry_s_m > e.front_s_m
),
nearest AS (
    SELECT drive_id, ego_id, t_ns, min({'da_m': da_m, 'object_id': object_id, 'speed_mps': speed_mps, 'way': way}) AS o
    FROM (
        SELECT drive_id, ego_id, t_ns, object_id, speed_mps, da_m, false AS way FROM against WHERE vehicle
        UNION ALL BY NAME
        SELECT *, true AS way FROM coming
    )
    GROUP BY ALL
),
hidden AS (
    SELECT u.drive_id, u.ego_id, u.t_ns, count(*) AS n, min({'id': u.object_id, 'reason': u.reason}) AS u
    FROM (
        SELECT drive_id, ego_id, t_ns, object_id, code, reason FROM unplaced
        UNION ALL
        SELECT drive_id, ego_id, t_ns, object_id, 'no_class', 'comes, and its class is not known' FROM against WHERE vehicle IS NULL
    ) u
    LEFT JOIN nearest n ON n.drive_id = u.drive_id AND n.ego_id = u.ego_id AND n.t_ns = u.t_ns
    -- free_m ends where the map does, and who was met is behind; of one that came from off the lanes nobody knows which way it was to make
    WHERE u.code NOT IN ('beyond_map', 'lost_behind') AND (n.o.object_id IS NULL OR n.o.object_id <> u.object_id OR n.o.way)
    GROUP BY ALL
)
SELECT
    e.drive_id, e.ego_id, e.t_ns, n.o.object_id AS object_id, n.o.da_m AS da_m, n.o.speed_mps AS speed_mps, n.o.way AS on_its_way,
    -- ground truth has no range: least() leaves its NULL out, as it should here
    greatest(0.0, least(e.corridor_m, e.range_m)) AS free_m,
    CASE WHEN e.range_m < e.corridor_m THEN 'sensor_range' WHEN e.map_ends THEN 'map_end' ELSE 'corridor_end' END AS free_reason,
    coalesce(h.n, 0) AS n_unplaced,
    CASE WHEN h.n > 0 THEN 'actor ' || h.u.id || ' ' || h.u.reason END AS unplaced_reason
FROM ego e
LEFT JOIN nearest n USING (drive_id, ego_id, t_ns)
LEFT JOIN hidden h USING (drive_id, ego_id, t_ns)
