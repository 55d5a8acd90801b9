-- Intervals between two steps in which the ego and an object may have touched. Each box moves along the cubic through its positions and
-- velocities at the two steps. A pair is examined only if it is so near at one of the two steps that it could touch in the interval.
-- lifetime: part
CREATE TABLE between_steps (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step; the boxes are apart at this step and the next, but came nearer between the two and may have touched
    t_next_ns BIGINT NOT NULL,        -- the next step, with no hole before it {position}
    object_id VARCHAR NOT NULL,       -- the other actor
    least_m DOUBLE NOT NULL,          -- least clearance between the two steps, if both boxes move on the cubic through the positions and velocities at both (on the chord, if the velocities contradict it); negative: depth of overlap {position, heading, size}
    blur_m DOUBLE NOT NULL            -- error bound of least_m, if neither brakes or swerves by more than 8 m/s2. Smaller than -least_m: certain contact. Smaller than least_m: no contact, and no row {position}
);

INSERT INTO between_steps BY NAME
WITH ego_step AS (
    SELECT s.drive_id, s.ego_id, s.t_ns, lead(s.t_ns) OVER w AS t_next_ns, lag(s.t_ns) OVER w AS t_before_ns, c.max_gap_ns
    FROM step s
    JOIN clock c USING (drive_id, ego_id)
    WINDOW w AS (PARTITION BY s.drive_id, s.ego_id ORDER BY s.t_ns)
),
-- The only full scan of the large table pair. Two boxes that touch between two steps have a small clearance at one of the steps: at most
-- half of the distance that they move in that time, plus the distance that they may swerve.
near_pair AS (
    SELECT p.drive_id, p.ego_id, p.object_id, t.t_before_ns, t.t_ns, t.t_next_ns, t.max_gap_ns
    FROM (
        SELECT p.* FROM pair p JOIN clock c USING (drive_id, ego_id)
        WHERE p.clearance_m <= c.max_gap_ns / 1e9 * (unknown_speed_mps() + coalesce(p.speed_mps, unknown_speed_mps())) / 2 + swerve_mps2() * (c.max_gap_ns / 1e9) ** 2
    ) p
    JOIN ego_step t USING (drive_id, ego_id, t_ns)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    CROSS JOIN LATERAL (SELECT greatest(coalesce(t.t_next_ns - t.t_ns, 0), coalesce(t.t_ns - t.t_before_ns, 0)) / 1e9 AS dt_s) d
    WHERE p.clearance_m <= dt_s * (coalesce(e.speed_mps, unknown_speed_mps()) + coalesce(p.speed_mps, unknown_speed_mps())) / 2 + swerve_mps2() * dt_s ** 2
),
-- occasion: near_pair
step_interval AS (
    SELECT drive_id, ego_id, object_id, t_ns, t_next_ns FROM near_pair WHERE t_next_ns - t_ns <= max_gap_ns
    UNION
    SELECT drive_id, ego_id, object_id, t_before_ns, t_ns FROM near_pair WHERE t_ns - t_before_ns <= max_gap_ns
),
-- The object at both ends of an interval. Each end is looked up separately: a join of the two ends alone would pair all samples of a track.
pair_begin AS MATERIALIZED (
    SELECT p.* FROM pair p SEMI JOIN step_interval n ON n.drive_id = p.drive_id AND n.ego_id = p.ego_id AND n.object_id = p.object_id AND n.t_ns = p.t_ns
),
pair_end AS MATERIALIZED (
    SELECT p.* RENAME (t_ns AS t_next_ns) FROM pair p
    SEMI JOIN step_interval n ON n.drive_id = p.drive_id AND n.ego_id = p.ego_id AND n.object_id = p.object_id AND n.t_next_ns = p.t_ns
),
-- Both actors at both steps. (x, y) is the position of the object relative to the ego at the first step; ego_way and object_way are their
-- displacements until the second step (see between_way).
interval_motion AS (
    SELECT
        n.drive_id, n.ego_id, n.object_id, n.t_ns, n.t_next_ns, (n.t_next_ns - n.t_ns) / 1e9 AS dt_s, least(a.clearance_m, b.clearance_m) AS end_clearance_m,
        e.length_m / 2 AS ego_half_length_m, e.width_m / 2 AS ego_half_width_m, a.length_m / 2 AS object_half_length_m, a.width_m / 2 AS object_half_width_m,
        e.yaw_rad AS ego_yaw_rad, box_turn_rad(f.yaw_rad - e.yaw_rad) AS ego_turn_rad, a.yaw_rad AS object_yaw_rad, box_turn_rad(b.yaw_rad - a.yaw_rad) AS object_turn_rad,
        a.x_m - e.x_m AS x, a.y_m - e.y_m AS y,
        between_way(e.x_m, e.y_m, f.x_m, f.y_m, e0.vx_mps, e0.vy_mps, e1.vx_mps, e1.vy_mps, dt_s) AS ego_way,
        between_way(a.x_m, a.y_m, b.x_m, b.y_m, o0.vx_mps, o0.vy_mps, o1.vx_mps, o1.vy_mps, dt_s) AS object_way
    FROM step_interval n
    JOIN pair_begin a ON a.drive_id = n.drive_id AND a.ego_id = n.ego_id AND a.object_id = n.object_id AND a.t_ns = n.t_ns
    JOIN pair_end b ON b.drive_id = n.drive_id AND b.ego_id = n.ego_id AND b.object_id = n.object_id AND b.t_next_ns = n.t_next_ns
    JOIN ego_state e ON e.drive_id = n.drive_id AND e.ego_id = n.ego_id AND e.t_ns = n.t_ns
    JOIN ego_state f ON f.drive_id = n.drive_id AND f.ego_id = n.ego_id AND f.t_ns = n.t_next_ns
    LEFT JOIN state_dynamics e0 ON e0.drive_id = n.drive_id AND e0.actor_id = n.ego_id AND e0.t_ns = n.t_ns
    LEFT JOIN state_dynamics e1 ON e1.drive_id = n.drive_id AND e1.actor_id = n.ego_id AND e1.t_ns = n.t_next_ns
    LEFT JOIN state_dynamics o0 ON o0.drive_id = n.drive_id AND o0.actor_id = n.object_id AND o0.t_ns = n.t_ns
    LEFT JOIN state_dynamics o1 ON o1.drive_id = n.drive_id AND o1.actor_id = n.object_id AND o1.t_ns = n.t_next_ns
    WHERE a.clearance_m > 0 AND b.clearance_m > 0
),
relative_motion AS MATERIALIZED (
    SELECT *,
        object_way.x - ego_way.x AS change_x_m, object_way.y - ego_way.y AS change_y_m, object_way.px - ego_way.px AS px, object_way.py - ego_way.py AS py, object_way.qx - ego_way.qx AS qx, object_way.qy - ego_way.qy AS qy,
        -- The box of a slow actor cannot swerve far: its deviation is at most the length of its path.
        least(between_blur_m(ego_way, dt_s), ego_way.long_m) + least(between_blur_m(object_way, dt_s), object_way.long_m)
            -- The box may also turn unevenly.
            + 0.1 * (abs(ego_turn_rad) * ego_half_length_m + abs(object_turn_rad) * object_half_length_m) AS blur_m
    FROM interval_motion
    WHERE ego_turn_rad IS NOT NULL AND object_turn_rad IS NOT NULL AND x IS NOT NULL
),
-- First a coarse search, in n parts of at most half a metre, then a fine one in twentieths of a part around the least clearance.
coarse_position AS (
    SELECT m.*, n, unnest(range(n + 1)) / n AS u
    FROM (SELECT *, ceil((sqrt(change_x_m ** 2 + change_y_m ** 2) + sqrt(px ** 2 + py ** 2) + sqrt(qx ** 2 + qy ** 2) + abs(ego_turn_rad) * ego_half_length_m + abs(object_turn_rad) * object_half_length_m) / 0.5)::BIGINT + 1 AS n FROM relative_motion) m
    WHERE end_clearance_m - 0.25 * n <= blur_m
),
-- The arguments of box_clearance are columns, because a macro repeats the expression of an argument wherever it uses it.
coarse_box_pair AS (
    SELECT *, offset_x_m * cos(ego_angle_rad) + offset_y_m * sin(ego_angle_rad) AS dx, offset_y_m * cos(ego_angle_rad) - offset_x_m * sin(ego_angle_rad) AS dy, cos(object_angle_rad - ego_angle_rad) AS c, sin(object_angle_rad - ego_angle_rad) AS s
    FROM (SELECT *, between_offset(u, x, change_x_m, px, qx) AS offset_x_m, between_offset(u, y, change_y_m, py, qy) AS offset_y_m, ego_yaw_rad + ego_turn_rad * u AS ego_angle_rad, object_yaw_rad + object_turn_rad * u AS object_angle_rad FROM coarse_position)
),
coarse_minimum AS (
    SELECT drive_id, ego_id, object_id, t_ns, min({'m': box_clearance(dx, dy, c, s, ego_half_length_m, ego_half_width_m, object_half_length_m, object_half_width_m), 'u': u, 'n': n}) AS minimum
    FROM coarse_box_pair
    GROUP BY drive_id, ego_id, object_id, t_ns
),
fine_position AS (
    SELECT m.*, minimum.u + unnest(range(-20, 21)) / (20.0::DOUBLE * minimum.n) AS u
    FROM relative_motion m
    JOIN coarse_minimum l USING (drive_id, ego_id, object_id, t_ns)
    WHERE minimum.m <= blur_m + 0.25
),
fine_box_pair AS (
    SELECT *, offset_x_m * cos(ego_angle_rad) + offset_y_m * sin(ego_angle_rad) AS dx, offset_y_m * cos(ego_angle_rad) - offset_x_m * sin(ego_angle_rad) AS dy, cos(object_angle_rad - ego_angle_rad) AS c, sin(object_angle_rad - ego_angle_rad) AS s
    FROM (SELECT *, between_offset(u, x, change_x_m, px, qx) AS offset_x_m, between_offset(u, y, change_y_m, py, qy) AS offset_y_m, ego_yaw_rad + ego_turn_rad * u AS ego_angle_rad, object_yaw_rad + object_turn_rad * u AS object_angle_rad FROM fine_position WHERE u BETWEEN 0 AND 1)
),
least_clearance AS (
    SELECT drive_id, ego_id, object_id, t_ns, t_next_ns, end_clearance_m, blur_m, min(box_clearance(dx, dy, c, s, ego_half_length_m, ego_half_width_m, object_half_length_m, object_half_width_m)) AS least_m
    FROM fine_box_pair
    GROUP BY drive_id, ego_id, object_id, t_ns, t_next_ns, end_clearance_m, blur_m
)
-- The boxes must come nearer between the two steps than at either of them. This excludes a vehicle that only follows.
SELECT drive_id, ego_id, t_ns, t_next_ns, object_id, least_m, blur_m FROM least_clearance WHERE least_m <= blur_m AND least_m < end_clearance_m - 0.05
