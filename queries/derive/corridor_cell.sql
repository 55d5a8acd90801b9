-- The strips beside the ego's chains, cell by cell, where anybody ever was. A lanelet driven on every lap is in here once.
WITH mine AS (SELECT DISTINCT c.drive_id, c.ego_id, l.environment_id, c.lanelet_id FROM chain c JOIN data_log l USING (drive_id)),
met AS (
    SELECT m.drive_id, m.ego_id, m.environment_id, s.cell, s.lanelet_id, s.k
    FROM mine m
    JOIN strip_cell s USING (environment_id, lanelet_id)
    SEMI JOIN visited_cell v ON v.drive_id = m.drive_id AND v.cell = s.cell
)
SELECT
    m.drive_id, m.ego_id, m.cell, m.lanelet_id, m.k,
    g.s0_m, g.len_m, g.x0_m, g.y0_m, g.tx0, g.ty0, g.hw0_m, g.x1_m, g.y1_m, g.tx1, g.ty1, g.hw1_m, g.slack0_m, g.slack1_m
FROM met m
JOIN lane_segment g USING (environment_id, lanelet_id, k)
