-- Speed, its unfiltered backward difference at the log's own rate, and the way made so far. A difference is taken only over samples
-- that are continuous by the drive's clock.
WITH gap AS (SELECT drive_id, max(max_gap_ns) AS max_gap_ns FROM clock GROUP BY drive_id),
prior AS (
    SELECT
        s.drive_id, s.actor_id, s.t_ns, s.x_m, s.y_m, s.yaw_rad, s.vx_mps, s.vy_mps, s.indicator,
        sqrt(s.vx_mps * s.vx_mps + s.vy_mps * s.vy_mps) AS speed_mps,
        s.t_ns - lag(s.t_ns) OVER w AS dt_ns,
        lag(s.x_m) OVER w AS x_before_m,
        lag(s.y_m) OVER w AS y_before_m,
        lag(sqrt(s.vx_mps * s.vx_mps + s.vy_mps * s.vy_mps)) OVER w AS speed_before_mps
    FROM actor_state s
    WINDOW w AS (PARTITION BY s.drive_id, s.actor_id ORDER BY s.t_ns)
)
SELECT
    p.drive_id, p.actor_id, p.t_ns, p.x_m, p.y_m, p.yaw_rad, p.vx_mps, p.vy_mps, p.speed_mps,
    CASE WHEN p.dt_ns <= g.max_gap_ns THEN (p.speed_mps - p.speed_before_mps) / (p.dt_ns / 1e9) END AS accel_mps2,
    sum(coalesce(sqrt((p.x_m - p.x_before_m) ** 2 + (p.y_m - p.y_before_m) ** 2), 0.0))
        OVER (PARTITION BY p.drive_id, p.actor_id ORDER BY p.t_ns ROWS UNBOUNDED PRECEDING) AS travel_m,
    a.length_m, a.width_m, a.actor_class, p.indicator
FROM prior p
JOIN gap g USING (drive_id)
JOIN actor a USING (drive_id, actor_id)
