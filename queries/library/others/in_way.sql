-- The nearest actor in the ego's way at each step: a person, an animal, an object or a vehicle. Each is a reason to brake or to stop. The
-- way is the running lane and the strip that the ego's box sweeps, with half a metre on both sides. An actor that crosses is in the way if
-- its velocity (not its heading) brings it into the strip within some seconds, at this step and in the moments before. A single velocity is
-- no proof, because recorded velocities jitter: the actor then only may be in the way.
-- lifetime: part
CREATE TABLE in_way (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; one row for every step
    object_id VARCHAR,                -- the nearest actor of any class in the ego's way or heading into it; NULL: none, as far as known
    actor_class VARCHAR,              -- [actor_class] see actor; NULL also if there is no actor {class}
    gap_m DOUBLE,                     -- distance along the road from the ego's front to the actor, 0 alongside; NULL: no actor {position, heading, size}
    along_mps DOUBLE,                 -- speed of the actor along the road, positive away from the ego; NULL: no actor, or not known {velocity}
    need_mps2 DOUBLE NOT NULL,        -- the hardest deceleration needed within the last 2 s to stay 5 m away from an actor in the way; 0: none was needed {velocity}
    known BOOLEAN NOT NULL            -- within the last 2 s, no other actor can have been in the way: every near actor has a position, and no actor beside the way could step into it {position}
);

INSERT INTO in_way BY NAME
WITH ahead AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, p.object_id, p.actor_class,
        greatest(0.0, coalesce(p.rear_s_m, p.s_m) - e.front_s_m) AS gap_m, e.speed_mps AS ego_speed_mps,
        abs(p.d_m - e.d_m) - coalesce(p.lat_half_m, 0.0) - e.lat_half_m AS across_m,
        -- An object of unknown size takes at least its centre, and may be as large as any box.
        CASE WHEN p.lat_half_m IS NULL THEN box_half_diagonal_m(p.actor_class, p.length_m, p.width_m) ELSE 0.0 END AS unknown_half_m,
        in_lane(p.d_m, coalesce(p.lat_half_m, 0.0), p.half_width_m) AS in_lane,
        -- A standing actor needs no heading.
        coalesce(s.vx_mps * cos(p.yaw_rad - p.heading_diff_rad) + s.vy_mps * sin(p.yaw_rad - p.heading_diff_rad), CASE WHEN p.speed_mps <= standing_mps() THEN 0.0 END) AS along_mps,
        sign(p.d_m - e.d_m) * (
            e.speed_mps * sin(e.heading_diff_rad) - (s.vy_mps * cos(p.yaw_rad - p.heading_diff_rad) - s.vx_mps * sin(p.yaw_rad - p.heading_diff_rad))
        ) AS towards_mps
    FROM pair p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    LEFT JOIN state_dynamics s ON s.drive_id = p.drive_id AND s.actor_id = p.object_id AND s.t_ns = p.t_ns
    WHERE p.s_m > e.s_m AND p.s_m - e.s_m < way_reach_m() AND e.front_s_m IS NOT NULL
),
in_way_check AS (
    SELECT
        *,
        across_m < way_beside_m() OR in_lane OR across_m <= enters_s() * least(towards_mps, least_towards_mps) AND towards_before_mps IS NOT NULL AS in_way,
        -- A pedestrian beside the path may step into it. So may an actor of unknown class or velocity.
        across_m < way_beside_m() + unknown_half_m OR across_m <= enters_s() * towards_mps OR across_m < may_step_m() AND (actor_class IS NULL OR NOT may_be_vehicle(actor_class) OR towards_mps IS NULL) AS may_be_in_way,
        need_mps2(gap_m, ego_speed_mps, along_mps) AS need_mps2
    FROM (
        SELECT *, least(min(towards_mps) OVER (w RANGE BETWEEN coming_for_ns() PRECEDING AND CURRENT ROW), towards_before_mps) AS least_towards_mps
        FROM (SELECT *, lag(towards_mps) OVER w AS towards_before_mps FROM ahead WINDOW w AS (PARTITION BY drive_id, ego_id, object_id ORDER BY t_ns))
        WINDOW w AS (PARTITION BY drive_id, ego_id, object_id ORDER BY t_ns)
    )
),
nearest_object AS (
    SELECT
        drive_id, ego_id, t_ns,
        min({'gap_m': gap_m, 'object_id': object_id, 'actor_class': actor_class, 'along_mps': along_mps}) FILTER (in_way) AS nearest,
        max(need_mps2) FILTER (in_way) AS need_mps2,
        bool_or(along_mps IS NULL OR in_way IS DISTINCT FROM true) AS is_doubtful
    FROM in_way_check
    WHERE in_way OR may_be_in_way
    GROUP BY ALL
),
nearest_hidden AS (
    SELECT h.drive_id, h.ego_id, h.t_ns, min(h.lane_m) AS least_m
    FROM hidden h
    LEFT JOIN pair p ON p.drive_id = h.drive_id AND p.ego_id = h.ego_id AND p.t_ns = h.t_ns AND p.object_id = h.object_id
    WHERE h.ahead IS DISTINCT FROM false AND p.d_m IS NULL
    GROUP BY ALL
),
way_step AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, m.nearest, coalesce(m.need_mps2, 0.0) AS need_mps2,
        e.front_s_m IS NOT NULL AND e.speed_mps IS NOT NULL AND NOT coalesce(m.is_doubtful, false)
            AND coalesce(u.least_m > brakes_for_m(e.speed_mps), true) AS known
    FROM ego_state e
    LEFT JOIN nearest_object m USING (drive_id, ego_id, t_ns)
    LEFT JOIN nearest_hidden u USING (drive_id, ego_id, t_ns)
)
SELECT
    drive_id, ego_id, t_ns, nearest.object_id AS object_id, nearest.actor_class AS actor_class, nearest.gap_m AS gap_m, nearest.along_mps AS along_mps,
    max(need_mps2) OVER recent AS need_mps2, bool_and(known) OVER recent AS known
FROM way_step
-- A driver releases the brake only some time after the way is clear.
WINDOW recent AS (PARTITION BY drive_id, ego_id ORDER BY t_ns RANGE BETWEEN brake_release_ns() PRECEDING AND CURRENT ROW)
