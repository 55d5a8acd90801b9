-- Part of `position.sql`: a drive is where an ego has its first position.
SELECT drive_id, drive_id AS key, arg_min(x_m, (actor_id, t_ns)) AS x_m, arg_min(y_m, (actor_id, t_ns)) AS y_m
FROM actor_state SEMI JOIN (FROM actor WHERE is_ego) a USING (drive_id, actor_id)
WHERE x_m IS NOT NULL AND y_m IS NOT NULL GROUP BY drive_id
