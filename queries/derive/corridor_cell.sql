-- Every 4 m grid cell that the strip beside a segment of the ego's chains may touch, found as in lane_cell. A lanelet driven on every
-- lap is in here once.
WITH mine AS (SELECT DISTINCT c.drive_id, c.ego_id, l.environment_id, c.lanelet_id FROM chain c JOIN data_log l USING (drive_id)),
box AS (
    SELECT
        m.drive_id, m.ego_id, g.*,
        floor((least(x0_m, x1_m) - strip_m() * greatest(abs(ty0), abs(ty1))) / 4)::BIGINT AS ix0,
        floor((greatest(x0_m, x1_m) + strip_m() * greatest(abs(ty0), abs(ty1))) / 4)::BIGINT AS ix1,
        floor((least(y0_m, y1_m) - strip_m() * greatest(abs(tx0), abs(tx1))) / 4)::BIGINT AS iy0,
        floor((greatest(y0_m, y1_m) + strip_m() * greatest(abs(tx0), abs(tx1))) / 4)::BIGINT AS iy1
    FROM mine m JOIN lane_segment g USING (environment_id, lanelet_id)
),
columns_ AS (SELECT *, unnest(range(ix0, ix1 + 1)) AS ix FROM box),
cells AS (SELECT *, unnest(range(iy0, iy1 + 1)) AS iy FROM columns_)
SELECT
    drive_id, ego_id, cell_key(ix, iy) AS cell, lanelet_id, k,
    s0_m, len_m, x0_m, y0_m, tx0, ty0, hw0_m, x1_m, y1_m, tx1, ty1, hw1_m, slack0_m, slack1_m
FROM cells
WHERE along0(4 * ix + 2, 4 * iy + 2, x0_m, y0_m, tx0, ty0) > -2.9 AND along1(4 * ix + 2, 4 * iy + 2, x1_m, y1_m, tx1, ty1) > -2.9
