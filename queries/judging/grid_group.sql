-- A group is the steps of one ego (and one object) in a default grid. Per group: the number of steps, a signature of their time stamps that
-- does not depend on order, and `whole`: no step is missing and the automated driver drives at every step.
CREATE OR REPLACE TEMP TABLE _grid_group AS
WITH _group_summary AS (
    SELECT grid, drive_id, ego_id, object_id, count(*) AS n, sum(hash(t_ns)::HUGEINT) AS signature,
        min(seg) = max(seg) AND max(k) - min(k) + 1 = count(*) AS unbroken
    FROM (SELECT 'step' AS grid, * FROM _step_grid
        UNION ALL SELECT 'pair', * FROM _pair_grid WHERE $_objects)
    GROUP BY ALL)
SELECT g.* EXCLUDE (unbroken), g.unbroken AND w.ego_id IS NULL AS whole
FROM _group_summary g LEFT JOIN _watched w ON w.drive_id = g.drive_id AND w.ego_id = g.ego_id
