-- Where the ego and another may have touched between two steps: their boxes moved along the cubic through the places and velocities at
-- both. Only pairs whose boxes are near enough at one of the two for what they move from step to step are looked at.
WITH timed AS (
    SELECT s.drive_id, s.ego_id, s.t_ns, lead(s.t_ns) OVER w AS t_next_ns, lag(s.t_ns) OVER w AS t_before_ns, c.max_gap_ns
    FROM step s
    JOIN clock c USING (drive_id, ego_id)
    WINDOW w AS (PARTITION BY s.drive_id, s.ego_id ORDER BY s.t_ns)
),
-- the only look at a large table: one of the two clearances is at most half of what they move in that time, and as much as they may swerve
near AS (
    SELECT p.drive_id, p.ego_id, p.object_id, t.t_before_ns, t.t_ns, t.t_next_ns, t.max_gap_ns
    FROM (
        SELECT p.* FROM pair p JOIN clock c USING (drive_id, ego_id)
        WHERE p.clearance_m <= c.max_gap_ns / 1e9 * (fast_mps() + coalesce(p.speed_mps, fast_mps())) / 2 + swerve_mps2() * (c.max_gap_ns / 1e9) ** 2
    ) p
    JOIN timed t USING (drive_id, ego_id, t_ns)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    CROSS JOIN LATERAL (SELECT greatest(coalesce(t.t_next_ns - t.t_ns, 0), coalesce(t.t_ns - t.t_before_ns, 0)) / 1e9 AS dt_s) d
    WHERE p.clearance_m <= dt_s * (coalesce(e.speed_mps, fast_mps()) + coalesce(p.speed_mps, fast_mps())) / 2 + swerve_mps2() * dt_s ** 2
),
span AS (
    SELECT drive_id, ego_id, object_id, t_ns, t_next_ns FROM near WHERE t_next_ns - t_ns <= max_gap_ns
    UNION
    SELECT drive_id, ego_id, object_id, t_before_ns, t_ns FROM near WHERE t_ns - t_before_ns <= max_gap_ns
),
-- both of them at both steps: v the velocity, gone the way between, off how far that is from what the velocity makes of it
ended AS (
    SELECT
        n.drive_id, n.ego_id, n.object_id, n.t_ns, n.t_next_ns, (n.t_next_ns - n.t_ns) / 1e9 AS dt_s, least(a.clearance_m, b.clearance_m) AS end_m,
        e.length_m / 2 AS hla, e.width_m / 2 AS hwa, a.length_m / 2 AS hlb, a.width_m / 2 AS hwb,
        e.yaw_rad AS ego_yaw, box_turn_rad(f.yaw_rad - e.yaw_rad) AS ego_turn, a.yaw_rad AS yaw, box_turn_rad(b.yaw_rad - a.yaw_rad) AS turn,
        a.x_m - e.x_m AS x, a.y_m - e.y_m AS y,
        between_way(e.x_m, e.y_m, f.x_m, f.y_m, e0.vx_mps, e0.vy_mps, e1.vx_mps, e1.vy_mps, dt_s) AS own,
        between_way(a.x_m, a.y_m, b.x_m, b.y_m, o0.vx_mps, o0.vy_mps, o1.vx_mps, o1.vy_mps, dt_s) AS its
    FROM span n
    JOIN pair a ON a.drive_id = n.drive_id AND a.ego_id = n.ego_id AND a.object_id = n.object_id AND a.t_ns = n.t_ns
    JOIN pair b ON b.drive_id = n.drive_id AND b.ego_id = n.ego_id AND b.object_id = n.object_id AND b.t_ns = n.t_next_ns
    JOIN ego_state e ON e.drive_id = n.drive_id AND e.ego_id = n.ego_id AND e.t_ns = n.t_ns
    JOIN ego_state f ON f.drive_id = n.drive_id AND f.ego_id = n.ego_id AND f.t_ns = n.t_next_ns
    LEFT JOIN state_dynamics e0 ON e0.drive_id = n.drive_id AND e0.actor_id = n.ego_id AND e0.t_ns = n.t_ns
    LEFT JOIN state_dynamics e1 ON e1.drive_id = n.drive_id AND e1.actor_id = n.ego_id AND e1.t_ns = n.t_next_ns
    LEFT JOIN state_dynamics o0 ON o0.drive_id = n.drive_id AND o0.actor_id = n.object_id AND o0.t_ns = n.t_ns
    LEFT JOIN state_dynamics o1 ON o1.drive_id = n.drive_id AND o1.actor_id = n.object_id AND o1.t_ns = n.t_next_ns
    WHERE a.clearance_m > 0 AND b.clearance_m > 0
),
moved AS MATERIALIZED (
    SELECT *,
        its.x - own.x AS gx, its.y - own.y AS gy, its.px - own.px AS px, its.py - own.py AS py, its.qx - own.qx AS qx, its.qy - own.qy AS qy,
        -- nobody leaves the way by more than its length
        least(between_blur_m(own, dt_s), own.long_m) + least(between_blur_m(its, dt_s), its.long_m)
            -- a turn is not even either
            + 0.1 * (abs(ego_turn) * hla + abs(turn) * hlb) AS blur_m
    FROM ended
    WHERE ego_turn IS NOT NULL AND turn IS NOT NULL AND x IS NOT NULL
),
-- half a metre at a time, then a twentieth of that around the least
coarse AS (
    SELECT m.*, n, unnest(range(n + 1)) / n AS u
    FROM (SELECT *, ceil((sqrt(gx ** 2 + gy ** 2) + sqrt(px ** 2 + py ** 2) + sqrt(qx ** 2 + qy ** 2) + abs(ego_turn) * hla + abs(turn) * hlb) / 0.5)::BIGINT + 1 AS n FROM moved) m
    WHERE end_m - 0.25 * n <= blur_m
),
-- columns, and not one expression: a macro writes its arguments out wherever it uses them
coarse_boxes AS (
    SELECT *, ex * cos(ea) + ey * sin(ea) AS dx, ey * cos(ea) - ex * sin(ea) AS dy, cos(oa - ea) AS c, sin(oa - ea) AS s
    FROM (SELECT *, between_offset(u, x, gx, px, qx) AS ex, between_offset(u, y, gy, py, qy) AS ey, ego_yaw + ego_turn * u AS ea, yaw + turn * u AS oa FROM coarse)
),
least_coarse AS (
    SELECT drive_id, ego_id, object_id, t_ns, min({'m': box_clearance(dx, dy, c, s, hla, hwa, hlb, hwb), 'u': u, 'n': n}) AS low
    FROM coarse_boxes
    GROUP BY drive_id, ego_id, object_id, t_ns
),
fine AS (
    SELECT m.*, low.u + unnest(range(-20, 21)) / (20.0::DOUBLE * low.n) AS u
    FROM moved m
    JOIN least_coarse l USING (drive_id, ego_id, object_id, t_ns)
    WHERE low.m <= blur_m + 0.25
),
fine_boxes AS (
    SELECT *, ex * cos(ea) + ey * sin(ea) AS dx, ey * cos(ea) - ex * sin(ea) AS dy, cos(oa - ea) AS c, sin(oa - ea) AS s
    FROM (SELECT *, between_offset(u, x, gx, px, qx) AS ex, between_offset(u, y, gy, py, qy) AS ey, ego_yaw + ego_turn * u AS ea, yaw + turn * u AS oa FROM fine WHERE u BETWEEN 0 AND 1)
),
swept AS (
    SELECT drive_id, ego_id, object_id, t_ns, t_next_ns, end_m, blur_m, min(box_clearance(dx, dy, c, s, hla, hwa, hlb, hwb)) AS least_m
    FROM fine_boxes
    GROUP BY drive_id, ego_id, object_id, t_ns, t_next_ns, end_m, blur_m
)
-- nearer between the two than at either: who only follows does not come nearer
SELECT drive_id, ego_id, t_ns, t_next_ns, object_id, least_m, blur_m FROM swept WHERE least_m <= blur_m AND least_m < end_m - 0.05
