-- Every 2 m grid cell that the lane area of a segment may touch: the cells of its bounding box whose centre is less than 1.5 m before or
-- behind that area and less than 2.1 m beside it. (Half a cell's diagonal is 1.4 m; in a bend, these distances are not exact.) Each row
-- contains the segment itself, so that one join gives the position of a point.
-- lifetime: map
CREATE TABLE _lane_cell (
    environment_id VARCHAR NOT NULL,  -- the map
    cell BIGINT NOT NULL,             -- 2 m grid cell that the segment's lane area may touch
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    drivable BOOLEAN NOT NULL,        -- see lanelet
    footway BOOLEAN,                  -- for pedestrians only; NULL: the use of the lane is not known
    k INTEGER NOT NULL,               -- number of the segment, see _lane_segment
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

INSERT INTO _lane_cell BY NAME
WITH segment_box AS (
    SELECT
        g.*, n.drivable, nullif(n.lane_type, 'unknown') IN ('sidewalk', 'walking') AS footway, greatest(hw0_m, hw1_m) + 0.1 AS reach_m,
        floor((least(x0_m, x1_m) - greatest(hw0_m, hw1_m) - 0.1) / 2)::BIGINT AS ix0,
        floor((greatest(x0_m, x1_m) + greatest(hw0_m, hw1_m) + 0.1) / 2)::BIGINT AS ix1,
        floor((least(y0_m, y1_m) - greatest(hw0_m, hw1_m) - 0.1) / 2)::BIGINT AS iy0,
        floor((greatest(y0_m, y1_m) + greatest(hw0_m, hw1_m) + 0.1) / 2)::BIGINT AS iy1
    FROM _lane_segment g JOIN lanelet n USING (environment_id, lanelet_id)
),
cell_column AS (SELECT *, unnest(range(ix0, ix1 + 1)) AS ix FROM segment_box),
grid_cell AS (SELECT *, unnest(range(iy0, iy1 + 1)) AS iy FROM cell_column)
SELECT
    environment_id, cell_key(ix, iy) AS cell, lanelet_id, drivable, footway, k,
    s0_m, len_m, x0_m, y0_m, tx0, ty0, hw0_m, x1_m, y1_m, tx1, ty1, hw1_m, slack0_m, slack1_m
FROM grid_cell
WHERE along0(2 * ix + 1, 2 * iy + 1, x0_m, y0_m, tx0, ty0) > -1.5 AND along1(2 * ix + 1, 2 * iy + 1, x1_m, y1_m, tx1, ty1) > -1.5
    AND abs(offset_left(2 * ix + 1, 2 * iy + 1, 0.5, x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1)) < reach_m + 2
