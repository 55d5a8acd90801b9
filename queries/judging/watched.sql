-- The subjects with a step at which the automated driver does not drive, or at which that is not known. All others are engaged at every
-- step.
-- `never`: it drives at no step at all. A step without a row is a step at which it is not known.
CREATE OR REPLACE TEMP TABLE _watched AS
SELECT s.drive_id, s.ego_id, bool_and(coalesce(NOT e.engaged, false)) AS never
FROM step s
LEFT JOIN ego_condition e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
GROUP BY ALL HAVING bool_or(e.engaged IS DISTINCT FROM true)
