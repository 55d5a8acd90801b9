-- Each ego and each actor near it, where both have a sample at the same time: whether they were seen apart, and the steps at which their
-- boxes overlap. A box without place, heading or size is in none, nor are two on different levels by the heights of the log.
WITH _box AS (
    SELECT s.actor_id, s.t_ns, s.x_m, s.y_m, s.z_m, s.yaw_rad, a.length_m / 2 AS half_length_m, a.width_m / 2 AS half_width_m, a.is_ego
    FROM _state s
    JOIN _actor a USING (actor_id)
    WHERE s.x_m + s.y_m + s.yaw_rad + a.length_m + a.width_m IS NOT NULL
), _pair AS (
    SELECT
        e.actor_id AS ego_id, o.actor_id AS object_id, e.t_ns, e.x_m, e.y_m, e.half_length_m AS ego_half_length_m, e.half_width_m AS ego_half_width_m,
        o.half_length_m, o.half_width_m, o.yaw_rad - e.yaw_rad AS turn_rad,
        (o.x_m - e.x_m) * cos(e.yaw_rad) + (o.y_m - e.y_m) * sin(e.yaw_rad) AS dx, (o.y_m - e.y_m) * cos(e.yaw_rad) - (o.x_m - e.x_m) * sin(e.yaw_rad) AS dy
    FROM _box e
    JOIN _box o ON o.t_ns = e.t_ns AND o.actor_id <> e.actor_id
    WHERE e.is_ego AND same_level(e.z_m, o.z_m) AND abs(o.x_m - e.x_m) < $near_m AND abs(o.y_m - e.y_m) < $near_m
), _clearance AS (
    SELECT *, box_clearance(dx, dy, cos(turn_rad), sin(turn_rad), ego_half_length_m, ego_half_width_m, half_length_m, half_width_m) AS clearance_m
    FROM _pair
)
SELECT
    ego_id, object_id, bool_or(clearance_m > 0) AS is_apart,
    list({'t_ns': t_ns, 'x_m': x_m, 'y_m': y_m, 'clearance_m': clearance_m} ORDER BY t_ns) FILTER (clearance_m <= 0) AS contacts
FROM _clearance
GROUP BY ego_id, object_id
ORDER BY ego_id, object_id
