-- Every 2 m grid cell that the lane area of a segment may touch: the cells of its bounding box whose centre is within half a cell's
-- diagonal of that area. Each row contains the segment itself, so that one join gives the position of a point.
WITH segment_box AS (
    SELECT
        g.*, n.drivable, nullif(n.lane_type, 'unknown') IN ('sidewalk', 'walking') AS footway, greatest(hw0_m, hw1_m) + 0.1 AS reach_m,
        floor((least(x0_m, x1_m) - greatest(hw0_m, hw1_m) - 0.1) / 2)::BIGINT AS ix0,
        floor((greatest(x0_m, x1_m) + greatest(hw0_m, hw1_m) + 0.1) / 2)::BIGINT AS ix1,
        floor((least(y0_m, y1_m) - greatest(hw0_m, hw1_m) - 0.1) / 2)::BIGINT AS iy0,
        floor((greatest(y0_m, y1_m) + greatest(hw0_m, hw1_m) + 0.1) / 2)::BIGINT AS iy1
    FROM lane_segment g JOIN lanelet n USING (environment_id, lanelet_id)
),
cell_column AS (SELECT *, unnest(range(ix0, ix1 + 1)) AS ix FROM segment_box),
grid_cell AS (SELECT *, unnest(range(iy0, iy1 + 1)) AS iy FROM cell_column)
SELECT
    environment_id, cell_key(ix, iy) AS cell, lanelet_id, drivable, footway, k,
    s0_m, len_m, x0_m, y0_m, tx0, ty0, hw0_m, x1_m, y1_m, tx1, ty1, hw1_m, slack0_m, slack1_m
FROM grid_cell
WHERE along0(2 * ix + 1, 2 * iy + 1, x0_m, y0_m, tx0, ty0) > -1.5 AND along1(2 * ix + 1, 2 * iy + 1, x1_m, y1_m, tx1, ty1) > -1.5
    AND abs(offset_left(2 * ix + 1, 2 * iy + 1, 0.5, x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1)) < reach_m + 2
