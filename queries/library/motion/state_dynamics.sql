-- Speed, and its unfiltered backward difference at the log's own rate, taken only between samples that are continuous by the drive's clock.
-- A velocity that is filtered itself (see quality) has no such difference, because it would hide every impact.
-- lifetime: part
CREATE TABLE state_dynamics (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor
    t_ns BIGINT NOT NULL,             -- time stamp
    x_m DOUBLE,                       -- box centre, x {position}
    y_m DOUBLE,                       -- box centre, y {position}
    z_m DOUBLE,                       -- box centre, height; NULL: not recorded, or constant as in a flat simulation {position}
    yaw_rad DOUBLE,                   -- heading {heading}
    travel_rad DOUBLE,                -- direction of travel: of a moving vehicle its heading (the opposite if it reverses), of another moving actor its velocity's direction, else the heading {heading}
    vx_mps DOUBLE,                    -- velocity east {velocity}
    vy_mps DOUBLE,                    -- velocity north {velocity}
    speed_mps DOUBLE,                 -- length of the velocity vector {velocity}
    accel_mps2 DOUBLE,                -- backward difference of the speed at the log's own rate, unfiltered; NULL: first sample, sample after a hole, or velocity derived by a filter (quality velocity_filtered) {velocity}
    length_m DOUBLE,                  -- box length {size}
    width_m DOUBLE,                   -- box width {size}
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    indicator VARCHAR                 -- [indicator] see actor_state
);

INSERT INTO state_dynamics BY NAME
WITH drive_clock AS (SELECT drive_id, max(max_gap_ns) AS max_gap_ns FROM _ego_clock GROUP BY drive_id),
-- Drives with measured heights. A flat simulation writes the same height all the time: 0, or half the box's height.
drive_with_heights AS (
    SELECT drive_id
    FROM (SELECT drive_id, min(z_m) AS low_m, max(z_m) AS high_m FROM actor_state WHERE z_m IS NOT NULL GROUP BY drive_id, actor_id)
    GROUP BY drive_id
    HAVING max(high_m - low_m) > measured_height_change_m() OR max(high_m) - min(low_m) > level_m()
),
actor_sample AS (
    SELECT
        s.drive_id, s.actor_id, s.t_ns, s.x_m, s.y_m, s.z_m, s.yaw_rad, s.vx_mps, s.vy_mps, s.indicator,
        sqrt(s.vx_mps * s.vx_mps + s.vy_mps * s.vy_mps) AS speed_mps,
        lag({'t_ns': s.t_ns, 'speed_mps': sqrt(s.vx_mps * s.vx_mps + s.vy_mps * s.vy_mps)}) OVER w AS previous,
        s.vx_mps * cos(s.yaw_rad) + s.vy_mps * sin(s.yaw_rad) AS forward_mps,
        forward_mps < 0 AND coalesce(lag(forward_mps) OVER w < 0, true) AND coalesce(lead(forward_mps) OVER w < 0, true) AS is_reversing
    FROM actor_state s
    WINDOW w AS (PARTITION BY s.drive_id, s.actor_id ORDER BY s.t_ns)
)
SELECT
    p.drive_id, p.actor_id, p.t_ns, p.x_m, p.y_m, CASE WHEN h.drive_id IS NOT NULL THEN p.z_m END AS z_m, p.yaw_rad,
    travel_rad(a.actor_class, p.speed_mps, p.vx_mps, p.vy_mps, p.yaw_rad, p.is_reversing) AS travel_rad, p.vx_mps, p.vy_mps, p.speed_mps,
    CASE WHEN q.actor_id IS NULL AND p.t_ns - p.previous.t_ns <= g.max_gap_ns THEN (p.speed_mps - p.previous.speed_mps) / ((p.t_ns - p.previous.t_ns) / 1e9) END AS accel_mps2,
    a.length_m, a.width_m, a.actor_class, p.indicator
FROM actor_sample p
JOIN drive_clock g USING (drive_id)
JOIN road_user a USING (drive_id, actor_id)
LEFT JOIN (SELECT DISTINCT drive_id, actor_id FROM quality WHERE check_id = 'velocity_filtered') q USING (drive_id, actor_id)
LEFT JOIN drive_with_heights h USING (drive_id)
