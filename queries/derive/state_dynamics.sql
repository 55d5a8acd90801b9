-- Speed and its unfiltered backward difference at the log's own rate, taken only over samples that are continuous by the drive's clock.
WITH gap AS (SELECT drive_id, max(max_gap_ns) AS max_gap_ns FROM ego_clock GROUP BY drive_id),
prior AS (
    SELECT
        s.drive_id, s.actor_id, s.t_ns, s.x_m, s.y_m, s.yaw_rad, s.vx_mps, s.vy_mps, s.indicator,
        sqrt(s.vx_mps * s.vx_mps + s.vy_mps * s.vy_mps) AS speed_mps,
        lag({'t_ns': s.t_ns, 'speed_mps': sqrt(s.vx_mps * s.vx_mps + s.vy_mps * s.vy_mps)}) OVER (PARTITION BY s.drive_id, s.actor_id ORDER BY s.t_ns) AS before
    FROM actor_state s
)
SELECT
    p.drive_id, p.actor_id, p.t_ns, p.x_m, p.y_m, p.yaw_rad, p.vx_mps, p.vy_mps, p.speed_mps,
    CASE WHEN p.t_ns - p.before.t_ns <= g.max_gap_ns THEN (p.speed_mps - p.before.speed_mps) / ((p.t_ns - p.before.t_ns) / 1e9) END AS accel_mps2,
    a.length_m, a.width_m, a.actor_class, p.indicator
FROM prior p
JOIN gap g USING (drive_id)
JOIN actor a USING (drive_id, actor_id)
