-- Each ego and each actor near it, where both have a sample at the same time, by the rules no-collision and contact-signature: whether the
-- two were seen so far apart that the rule does not apply to them, and the steps that break the rule. A box without place, heading or size
-- is in none, nor are two on different levels by the heights of the log. A change of speed is left to the window where the velocity is not
-- the log's own, and where a step is long.
WITH _box AS (
    SELECT
        s.actor_id, s.t_ns, s.x_m, s.y_m, s.z_m, s.yaw_rad, a.length_m / 2 AS half_length_m, a.width_m / 2 AS half_width_m, a.is_ego, a.actor_class,
        sqrt(s.vx_mps * s.vx_mps + s.vy_mps * s.vy_mps) AS speed_mps,
        (s.t_ns - lag(s.t_ns) OVER w) / 1e9 AS step_s,
        -- Quality may name no actor, and means several then: this is NULL for all of them.
        CASE WHEN s.actor_id NOT IN (SELECT actor_id FROM _quality WHERE check_id IN ('velocity_derived', 'velocity_filtered')) AND step_s <= $jolt_s * 1.5 THEN (speed_mps - lag(speed_mps) OVER w) / step_s END AS accel_mps2
    FROM _state s
    JOIN _actor a USING (actor_id)
    WHERE s.x_m + s.y_m + s.yaw_rad + a.length_m + a.width_m IS NOT NULL
    WINDOW w AS (PARTITION BY s.actor_id ORDER BY s.t_ns)
), _pair AS (
    SELECT
        e.actor_id AS ego_id, o.actor_id AS object_id, e.t_ns, e.x_m, e.y_m, e.half_length_m AS ego_half_length_m, e.half_width_m AS ego_half_width_m,
        o.half_length_m, o.half_width_m, o.yaw_rad - e.yaw_rad AS turn_rad,
        (o.x_m - e.x_m) * cos(e.yaw_rad) + (o.y_m - e.y_m) * sin(e.yaw_rad) AS dx, (o.y_m - e.y_m) * cos(e.yaw_rad) - (o.x_m - e.x_m) * sin(e.yaw_rad) AS dy,
        greatest(-o.accel_mps2, CASE WHEN NOT may_walk(o.actor_class) OR o.speed_mps > $walk_mps THEN o.accel_mps2 END, abs(e.accel_mps2)) AS jolt_mps2
    FROM _box e
    JOIN _box o ON o.t_ns = e.t_ns AND o.actor_id <> e.actor_id
    WHERE e.is_ego AND same_level(e.z_m, o.z_m) AND abs(o.x_m - e.x_m) < $near_m AND abs(o.y_m - e.y_m) < $near_m
), _clearance AS (
    SELECT *, box_clearance(dx, dy, cos(turn_rad), sin(turn_rad), ego_half_length_m, ego_half_width_m, half_length_m, half_width_m) AS clearance_m
    FROM _pair
), _judged AS (
    SELECT 'ukhc.no-collision' AS rule_id, *, clearance_m > 0 AS is_apart, clearance_m <= 0 AS fails, clearance_m AS observed, 0.0 AS required, clearance_m AS margin
    FROM _clearance
    UNION ALL
    SELECT 'ukhc.contact-signature', *, clearance_m > $within_m, clearance_m <= $within_m AND jolt_mps2 >= $tyre_mps2, jolt_mps2, $tyre_mps2, $tyre_mps2 - jolt_mps2
    FROM _clearance
)
SELECT
    rule_id, ego_id, object_id, bool_or(is_apart) AS is_apart,
    list({'t_ns': t_ns, 'x_m': x_m, 'y_m': y_m, 'clearance_m': clearance_m, 'observed': observed, 'required': required, 'margin': margin} ORDER BY t_ns) FILTER (fails) AS steps
FROM _judged
GROUP BY rule_id, ego_id, object_id
ORDER BY rule_id, ego_id, object_id
