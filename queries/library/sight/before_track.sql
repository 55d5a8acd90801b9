-- How near to the ego an actor may have been just before its track begins. A recorder may find an actor late (track_delay_ns): going back in
-- time, both boxes move at their velocities at the first step, without turning.
-- lifetime: part
CREATE TABLE before_track (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the first step at which the actor has a position, later than the log's first step
    object_id VARCHAR NOT NULL,       -- an actor that goes away from the ego when it is first seen, and was nearer than 1 m in the half second before
    least_m DOUBLE NOT NULL           -- least distance of the two boxes in the half second before, less than at t_ns; negative: depth of overlap {position, heading, size, velocity}
);

INSERT INTO before_track BY NAME
WITH track_begin AS (
    SELECT e.drive_id, e.ego_id, e.object_id, e.t_ns, st.t_next_ns
    FROM (SELECT drive_id, ego_id, object_id, min(t_ns) AS t_ns FROM pair WHERE x_m IS NOT NULL GROUP BY ALL) e
    JOIN clock c USING (drive_id, ego_id)
    JOIN (SELECT drive_id, ego_id, t_ns, lead(t_ns) OVER (PARTITION BY drive_id, ego_id, seg ORDER BY t_ns) AS t_next_ns FROM step) st USING (drive_id, ego_id, t_ns)
    WHERE e.t_ns > c.t_start_ns
),
-- occasion: track_begin
-- The position of the actor in the frame of the ego's box, and the velocity of the actor relative to the ego. The first velocity of a track
-- may be missing: then it is that from the first step to the next.
relative_motion AS (
    SELECT
        b.drive_id, b.ego_id, b.object_id, b.t_ns, p.clearance_m, e.yaw_rad, p.yaw_rad - e.yaw_rad AS turn_rad, p.x_m - e.x_m AS x_m, p.y_m - e.y_m AS y_m,
        coalesce(o.vx_mps, (q.x_m - p.x_m) * 1e9 / (b.t_next_ns - b.t_ns)) - coalesce(v.vx_mps, e.speed_mps * cos(e.yaw_rad)) AS vx_mps,
        coalesce(o.vy_mps, (q.y_m - p.y_m) * 1e9 / (b.t_next_ns - b.t_ns)) - coalesce(v.vy_mps, e.speed_mps * sin(e.yaw_rad)) AS vy_mps,
        e.length_m / 2 AS ego_half_length_m, e.width_m / 2 AS ego_half_width_m, p.length_m / 2 AS object_half_length_m, p.width_m / 2 AS object_half_width_m
    FROM track_begin b
    JOIN pair p USING (drive_id, ego_id, object_id, t_ns)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    LEFT JOIN pair q ON q.drive_id = b.drive_id AND q.ego_id = b.ego_id AND q.object_id = b.object_id AND q.t_ns = b.t_next_ns
    LEFT JOIN state_dynamics o ON o.drive_id = b.drive_id AND o.actor_id = b.object_id AND o.t_ns = b.t_ns
    LEFT JOIN state_dynamics v ON v.drive_id = b.drive_id AND v.actor_id = b.ego_id AND v.t_ns = b.t_ns
    WHERE p.clearance_m > 0 AND NOT p.clearance_is_bound
),
-- The actor's position in the frame of the ego's box, at twentieths of the time.
earlier_position AS (
    SELECT
        drive_id, ego_id, object_id, t_ns, clearance_m, cos(turn_rad) AS c, sin(turn_rad) AS s, ego_half_length_m, ego_half_width_m, object_half_length_m, object_half_width_m,
        (x_m - vx_mps * back.time_s) * cos(yaw_rad) + (y_m - vy_mps * back.time_s) * sin(yaw_rad) AS dx,
        (y_m - vy_mps * back.time_s) * cos(yaw_rad) - (x_m - vx_mps * back.time_s) * sin(yaw_rad) AS dy
    FROM relative_motion
    CROSS JOIN (SELECT unnest(range(1, 21)) / 20.0::DOUBLE * track_delay_ns() / 1e9 AS time_s) back
    WHERE clearance_m - sqrt(vx_mps ** 2 + vy_mps ** 2) * track_delay_ns() / 1e9 < near_before_track_m()
)
SELECT drive_id, ego_id, t_ns, object_id, min(box_clearance(dx, dy, c, s, ego_half_length_m, ego_half_width_m, object_half_length_m, object_half_width_m)) AS least_m
FROM earlier_position
GROUP BY drive_id, ego_id, t_ns, object_id, clearance_m
HAVING least_m < least(clearance_m, near_before_track_m())
