-- Every 4 m grid cell that the bounding box of a segment's lane area touches.
WITH box AS (
    SELECT
        environment_id, lanelet_id, k,
        floor((least(x0_m, x1_m) - greatest(hw0_m, hw1_m) - 0.1) / 4)::BIGINT AS ix0,
        floor((greatest(x0_m, x1_m) + greatest(hw0_m, hw1_m) + 0.1) / 4)::BIGINT AS ix1,
        floor((least(y0_m, y1_m) - greatest(hw0_m, hw1_m) - 0.1) / 4)::BIGINT AS iy0,
        floor((greatest(y0_m, y1_m) + greatest(hw0_m, hw1_m) + 0.1) / 4)::BIGINT AS iy1
    FROM lane_segment
),
columns_ AS (SELECT *, unnest(range(ix0, ix1 + 1)) AS ix FROM box)
SELECT environment_id, cell_key(ix, iy) AS cell, lanelet_id, k
FROM (SELECT *, unnest(range(iy0, iy1 + 1)) AS iy FROM columns_)
