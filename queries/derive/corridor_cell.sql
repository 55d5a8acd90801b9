-- The grid cells of the strips beside the ego's chains in which some actor ever was. A lanelet that the ego drives in every lap is listed
-- once.
WITH chain_lanelet AS (SELECT DISTINCT c.drive_id, c.ego_id, l.environment_id, c.lanelet_id FROM chain c JOIN data_log l USING (drive_id)),
lanelet_cell AS (
    SELECT m.drive_id, m.ego_id, m.environment_id, s.cell, s.lanelet_id, s.k
    FROM chain_lanelet m
    JOIN strip_cell s USING (environment_id, lanelet_id)
    SEMI JOIN visited_cell v ON v.drive_id = m.drive_id AND v.cell = s.cell
)
SELECT
    m.drive_id, m.ego_id, m.cell, m.lanelet_id, m.k,
    g.s0_m, g.len_m, g.x0_m, g.y0_m, g.tx0, g.ty0, g.hw0_m, g.x1_m, g.y1_m, g.tx1, g.ty1, g.hw1_m, g.slack0_m, g.slack1_m
FROM lanelet_cell m
JOIN lane_segment g USING (environment_id, lanelet_id, k)
