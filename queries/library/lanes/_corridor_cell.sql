-- The grid cells of the strips beside the ego's chains that an actor visited at some time, or in which `pair` extrapolates it: the corridor is
-- searched only there. A lanelet that the ego drives in every lap is listed once.
-- lifetime: part
CREATE TABLE _corridor_cell (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    cell BIGINT NOT NULL,             -- 4 m grid cell that the strip of 15 m on both sides of the segment may touch, and that at some time contained the centre of an actor, recorded or extrapolated (see pair), or a corner of an ego
    lanelet_id VARCHAR NOT NULL,      -- a lanelet of any of the ego's chains
    k INTEGER NOT NULL,               -- number of the segment
    s0_m DOUBLE NOT NULL,             -- lanelet station of the segment's start
    len_m DOUBLE NOT NULL,            -- length of the segment along the centre line
    x0_m DOUBLE NOT NULL,             -- start, x
    y0_m DOUBLE NOT NULL,             -- start, y
    tx0 DOUBLE NOT NULL,              -- unit tangent at the start, x
    ty0 DOUBLE NOT NULL,              -- unit tangent at the start, y
    hw0_m DOUBLE NOT NULL,            -- half width of the lane at the start
    x1_m DOUBLE NOT NULL,             -- end, x
    y1_m DOUBLE NOT NULL,             -- end, y
    tx1 DOUBLE NOT NULL,              -- unit tangent at the end, x
    ty1 DOUBLE NOT NULL,              -- unit tangent at the end, y
    hw1_m DOUBLE NOT NULL,            -- half width of the lane at the end
    slack0_m DOUBLE NOT NULL,         -- see _lane_segment
    slack1_m DOUBLE NOT NULL          -- see _lane_segment
);

INSERT INTO _corridor_cell BY NAME
WITH chain_lanelet AS (SELECT DISTINCT c.drive_id, c.ego_id, l.environment_id, c.lanelet_id FROM chain c JOIN data_log l USING (drive_id)),
segment AS (
    SELECT NULL AS drive_id, NULL AS ego_id, g.*
    FROM _lane_segment g
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = g.lanelet_id AND n.drivable
    SEMI JOIN chain_lanelet c ON c.environment_id = g.environment_id AND c.lanelet_id = g.lanelet_id
    UNION ALL BY NAME
    -- Without a map: the ego's own path. Its lane is as wide as the ego plus a small margin on both sides (own_lane_beside_m).
    SELECT
        w.drive_id, w.ego_id, own_lanelet(w.seg) AS lanelet_id, w.k, w.s0_m, w.len_m, w.x0_m, w.y0_m, w.tx0, w.ty0, w.x1_m, w.y1_m, w.tx1, w.ty1,
        a.width_m / 2 + own_lane_beside_m() AS hw0_m, hw0_m AS hw1_m, CASE WHEN w.k = 0 THEN 0.05 ELSE 0.0 END AS slack0_m,
        CASE WHEN w.k = max(w.k) OVER (PARTITION BY w.drive_id, w.ego_id, w.seg) THEN 0.05 ELSE 0.0 END AS slack1_m
    FROM _own_way w
    JOIN actor a ON a.drive_id = w.drive_id AND a.actor_id = w.ego_id AND a.width_m IS NOT NULL
    SEMI JOIN (FROM data_log WHERE environment_id IS NULL) g ON g.drive_id = w.drive_id
),
segment_box AS (
    SELECT
        *,
        floor((least(x0_m, x1_m) - strip_m() * greatest(abs(ty0), abs(ty1))) / 4)::BIGINT AS ix0,
        floor((greatest(x0_m, x1_m) + strip_m() * greatest(abs(ty0), abs(ty1))) / 4)::BIGINT AS ix1,
        floor((least(y0_m, y1_m) - strip_m() * greatest(abs(tx0), abs(tx1))) / 4)::BIGINT AS iy0,
        floor((greatest(y0_m, y1_m) + strip_m() * greatest(abs(tx0), abs(tx1))) / 4)::BIGINT AS iy1
    FROM segment
),
cell_column AS (SELECT *, unnest(range(ix0, ix1 + 1)) AS ix FROM segment_box),
grid_cell AS (SELECT *, unnest(range(iy0, iy1 + 1)) AS iy FROM cell_column),
-- Of the segment's bounding box, the cells whose centre is less than 2.9 m before or behind the strips. (Half a cell's diagonal is 2.8 m.)
strip_cell AS (
    SELECT coalesce(m.drive_id, g.drive_id) AS drive_id, coalesce(m.ego_id, g.ego_id) AS ego_id, cell_key(g.ix, g.iy) AS cell, g.* EXCLUDE (drive_id, ego_id)
    FROM grid_cell g
    LEFT JOIN chain_lanelet m USING (environment_id, lanelet_id)
    WHERE along0(4 * ix + 2, 4 * iy + 2, x0_m, y0_m, tx0, ty0) > -2.9 AND along1(4 * ix + 2, 4 * iy + 2, x1_m, y1_m, tx1, ty1) > -2.9
),
step_number AS (
    SELECT drive_id, t_ns, row_number() OVER (PARTITION BY drive_id ORDER BY t_ns) AS n FROM (SELECT DISTINCT drive_id, t_ns FROM step)
),
-- Only tracks that lack a step, or have samples between the steps, are extrapolated.
irregular_track AS (
    SELECT t.drive_id, t.actor_id, t.t_first_ns, t.t_last_ns
    FROM (
        SELECT s.drive_id, s.actor_id, min(s.t_ns) AS t_first_ns, max(s.t_ns) AS t_last_ns, count(*) AS n_samples
        FROM state_dynamics s
        JOIN (SELECT drive_id, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns FROM step_number GROUP BY ALL) e ON e.drive_id = s.drive_id
        WHERE s.t_ns BETWEEN e.t_first_ns AND e.t_last_ns
        GROUP BY ALL
    ) t
    LEFT JOIN step_number a ON a.drive_id = t.drive_id AND a.t_ns = t.t_first_ns
    LEFT JOIN step_number b ON b.drive_id = t.drive_id AND b.t_ns = t.t_last_ns
    WHERE (b.n - a.n + 1 = t.n_samples) IS DISTINCT FROM true
),
extrapolated_place AS (
    SELECT e.drive_id, s.x_m + s.vx_mps * (e.t_ns - s.t_ns) / 1e9 AS x_m, s.y_m + s.vy_mps * (e.t_ns - s.t_ns) / 1e9 AS y_m
    FROM (
        SELECT r.drive_id, r.actor_id, n.t_ns
        FROM irregular_track r
        JOIN step_number n ON n.drive_id = r.drive_id AND n.t_ns >= r.t_first_ns AND n.t_ns <= r.t_last_ns
    ) e
    JOIN (SELECT drive_id, max(max_gap_ns) AS max_gap_ns FROM clock GROUP BY ALL) c ON c.drive_id = e.drive_id
    ASOF JOIN (FROM state_dynamics SEMI JOIN irregular_track USING (drive_id, actor_id)) s ON s.drive_id = e.drive_id AND s.actor_id = e.actor_id AND s.t_ns <= e.t_ns
    WHERE s.t_ns < e.t_ns AND e.t_ns - s.t_ns <= c.max_gap_ns
),
visited_cell AS (
    SELECT drive_id, corridor_cell_of(x_m, y_m) AS cell
    FROM state_dynamics
    WHERE x_m IS NOT NULL AND y_m IS NOT NULL
    UNION
    SELECT drive_id, corridor_cell_of(x_m, y_m) FROM extrapolated_place WHERE x_m IS NOT NULL AND y_m IS NOT NULL
    UNION
    SELECT
        s.drive_id,
        corridor_cell_of(
            s.x_m + c.l * s.length_m / 2 * cos(s.yaw_rad) - c.w * s.width_m / 2 * sin(s.yaw_rad),
            s.y_m + c.l * s.length_m / 2 * sin(s.yaw_rad) + c.w * s.width_m / 2 * cos(s.yaw_rad)
        )
    FROM step e
    JOIN state_dynamics s ON s.drive_id = e.drive_id AND s.actor_id = e.ego_id AND s.t_ns = e.t_ns
    CROSS JOIN (VALUES (1, 1), (1, -1), (-1, 1), (-1, -1)) AS c(l, w)
    WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL AND s.yaw_rad IS NOT NULL AND s.length_m IS NOT NULL AND s.width_m IS NOT NULL
)
SELECT
    drive_id, ego_id, cell, lanelet_id, k, s0_m, len_m, x0_m, y0_m, tx0, ty0, hw0_m, x1_m, y1_m, tx1, ty1, hw1_m, slack0_m, slack1_m
FROM strip_cell
SEMI JOIN visited_cell USING (drive_id, cell)
