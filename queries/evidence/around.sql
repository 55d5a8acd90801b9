-- The ego steps near each moment of `_moment` (the worst step of a finding or near miss), thinned in the same way for all of them.
CREATE OR REPLACE TEMP TABLE _around AS
SELECT m.drive_id, m.ego_id, m.t_ns AS at_ns, e.t_ns
FROM _moment m
JOIN ego_state e ON e.drive_id = m.drive_id AND e.ego_id = m.ego_id AND e.t_ns >= m.t_ns - $path_ns AND e.t_ns <= m.t_ns + $path_ns
QUALIFY e.t_ns = m.t_ns OR row_number() OVER (
    PARTITION BY m.drive_id, m.ego_id, m.t_ns, e.t_ns // $step_ns ORDER BY e.t_ns
) = 1
