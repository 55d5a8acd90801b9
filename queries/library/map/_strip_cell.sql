-- Every 4 m grid cell that the strips beside a drivable segment may touch: the cells of their bounding box whose centre is less than 2.9 m
-- before or behind them. (Half a cell's diagonal is 2.8 m.)
-- lifetime: map
CREATE TABLE _strip_cell (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet
    k INTEGER NOT NULL,               -- number of the segment, see _lane_segment
    cell BIGINT NOT NULL              -- 4 m grid cell that the strip of 15 m on both sides of the segment may touch
);

INSERT INTO _strip_cell BY NAME
WITH segment_box AS (
    SELECT
        g.*,
        floor((least(x0_m, x1_m) - strip_m() * greatest(abs(ty0), abs(ty1))) / 4)::BIGINT AS ix0,
        floor((greatest(x0_m, x1_m) + strip_m() * greatest(abs(ty0), abs(ty1))) / 4)::BIGINT AS ix1,
        floor((least(y0_m, y1_m) - strip_m() * greatest(abs(tx0), abs(tx1))) / 4)::BIGINT AS iy0,
        floor((greatest(y0_m, y1_m) + strip_m() * greatest(abs(tx0), abs(tx1))) / 4)::BIGINT AS iy1
    FROM _lane_segment g
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = g.lanelet_id AND n.drivable
),
cell_column AS (SELECT *, unnest(range(ix0, ix1 + 1)) AS ix FROM segment_box),
grid_cell AS (SELECT *, unnest(range(iy0, iy1 + 1)) AS iy FROM cell_column)
SELECT environment_id, lanelet_id, k, cell_key(ix, iy) AS cell
FROM grid_cell
WHERE along0(4 * ix + 2, 4 * iy + 2, x0_m, y0_m, tx0, ty0) > -2.9 AND along1(4 * ix + 2, 4 * iy + 2, x1_m, y1_m, tx1, ty1) > -2.9
