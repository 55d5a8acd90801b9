-- The grid cells of the strips beside the ego's chains that an actor visited at some time. A lanelet that the ego drives in every lap is
-- listed once.
-- lifetime: part
CREATE TABLE _corridor_cell (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    cell BIGINT NOT NULL,             -- 4 m grid cell that the strip beside the segment may touch and that an actor visited (see _visited_cell)
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
lanelet_cell AS (
    SELECT m.drive_id, m.ego_id, m.environment_id, s.cell, s.lanelet_id, s.k
    FROM chain_lanelet m
    JOIN _strip_cell s USING (environment_id, lanelet_id)
    SEMI JOIN _visited_cell v ON v.drive_id = m.drive_id AND v.cell = s.cell
),
-- Without a map: the strips beside the ego's own path. Its lane is as wide as the ego plus a small margin on both sides
-- (own_lane_beside_m).
own_segment AS (
    SELECT
        w.*, a.width_m / 2 + own_lane_beside_m() AS half_width_m, max(w.k) OVER (PARTITION BY w.drive_id, w.ego_id, w.seg) AS last_k,
        floor((least(x0_m, x1_m) - strip_m() * greatest(abs(ty0), abs(ty1))) / 4)::BIGINT AS ix0,
        floor((greatest(x0_m, x1_m) + strip_m() * greatest(abs(ty0), abs(ty1))) / 4)::BIGINT AS ix1,
        floor((least(y0_m, y1_m) - strip_m() * greatest(abs(tx0), abs(tx1))) / 4)::BIGINT AS iy0,
        floor((greatest(y0_m, y1_m) + strip_m() * greatest(abs(tx0), abs(tx1))) / 4)::BIGINT AS iy1
    FROM _own_way w
    JOIN actor a ON a.drive_id = w.drive_id AND a.actor_id = w.ego_id AND a.width_m IS NOT NULL
    SEMI JOIN (FROM data_log WHERE environment_id IS NULL) g ON g.drive_id = w.drive_id
),
own_column AS (SELECT *, unnest(range(ix0, ix1 + 1)) AS ix FROM own_segment),
own_cell AS (SELECT *, unnest(range(iy0, iy1 + 1)) AS iy, cell_key(ix, iy) AS cell FROM own_column)
SELECT
    m.drive_id, m.ego_id, m.cell, m.lanelet_id, m.k,
    g.s0_m, g.len_m, g.x0_m, g.y0_m, g.tx0, g.ty0, g.hw0_m, g.x1_m, g.y1_m, g.tx1, g.ty1, g.hw1_m, g.slack0_m, g.slack1_m
FROM lanelet_cell m
JOIN _lane_segment g USING (environment_id, lanelet_id, k)
UNION ALL
SELECT
    o.drive_id, o.ego_id, o.cell, own_lanelet(o.seg), o.k,
    o.s0_m, o.len_m, o.x0_m, o.y0_m, o.tx0, o.ty0, o.half_width_m, o.x1_m, o.y1_m, o.tx1, o.ty1, o.half_width_m,
    CASE WHEN o.k = 0 THEN 0.05 ELSE 0.0 END, CASE WHEN o.k = o.last_k THEN 0.05 ELSE 0.0 END
FROM own_cell o
SEMI JOIN _visited_cell v ON v.drive_id = o.drive_id AND v.cell = o.cell
