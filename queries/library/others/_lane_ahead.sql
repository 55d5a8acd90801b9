-- Vehicles and objects ahead of the ego in its running lane: with their centre in the lane, or partly in the lane and in the ego's way. The
-- table lead has the nearest vehicle of them. For an ego that is out of its lane, an object beside the lane that faces the ego and is in
-- its way is ahead, too (`outside`).
--
-- Without a map, the running lane is the ego's recorded path. Beyond its end, the ego may take another bend. An actor that is only perhaps
-- in the ego's way has no class in this table, because nothing is known about it. The same applies to an actor beside the path that the ego
-- would hit within two seconds, both with its present curvature and straight on: the road may bend there, or the ego swerves.
-- lifetime: part
CREATE TABLE _lane_ahead (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- an actor ahead that is in the running lane and not in passed_by, or that reaches into the lane and is in the ego's way or heading into it; no pedestrian or animal, and an object only if it is in the way; see lead
    actor_class VARCHAR,              -- [actor_class] see road_user; NULL also, without a map, if it is not known whether the actor is in the ego's way, and for an actor of unknown speed that stands in the lane, crosses it or may head into it {class}
    gap_m DOUBLE,                     -- distance from bumper to bumper along the corridor; negative: the two boxes overlap {position, heading, size}
    speed_mps DOUBLE,                 -- speed of the actor {velocity}
    oncoming BOOLEAN,                 -- the actor heads against the corridor {position, heading, velocity}
    across_m DOUBLE,                  -- gap between the two boxes across the corridor; negative: overlap, the actor is in the ego's way {position, heading, size}
    ego_across_mps DOUBLE,            -- the ego's speed across the corridor, positive towards the actor {velocity}
    across_mps DOUBLE,                -- the actor's speed across the corridor, positive towards the ego {velocity}
    soon BOOLEAN,                     -- the actor is in the ego's way, or will be within 3 s at the present speeds across the corridor; NULL: its speed is not known {position, heading, velocity}
    outside BOOLEAN                   -- no part of the actor is in the running lane: it is beside the lane, faces the ego and is in the ego's way {position}
);

INSERT INTO _lane_ahead BY NAME
WITH
own_way_end AS (
    SELECT drive_id, ego_id, seg AS chain_id, min(driven_m) AS driven_m
    FROM _own_way SEMI JOIN (FROM data_log WHERE environment_id IS NULL) USING (drive_id)
    GROUP BY drive_id, ego_id, seg
),
-- Actors that follow a lane of a junction. If such an actor comes across the ego's path, it crosses that path and is not ahead: see
-- conflict.
actor_on_junction_lane AS (
    SELECT DISTINCT o.drive_id, o.actor_id AS object_id, o.t_ns
    FROM lane_occupancy o
    JOIN data_log g USING (drive_id)
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
    WHERE n.drivable AND n.junction_id IS NOT NULL AND abs(o.heading_diff_rad) < along_lane_rad()
),
object_ahead AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, p.object_id, p.actor_class, p.rear_s_m - e.front_s_m AS gap_m, along_lane_mps(p.speed_mps, p.heading_diff_rad) AS speed_mps,
        abs(p.heading_diff_rad) > pi() / 2 AS oncoming, abs(p.d_m - e.d_m) - p.lat_half_m - e.lat_half_m AS across_m,
        sign(p.d_m - e.d_m) * e.speed_mps * sin(e.heading_diff_rad) AS ego_across_mps, sign(e.d_m - p.d_m) * p.speed_mps * sin(p.heading_diff_rad) AS across_mps,
        abs(p.d_m) <= p.half_width_m OR w.may_bend_m > 0 AS is_centre_in_lane, NOT in_lane(p.d_m, p.lat_half_m + w.may_bend_m, p.half_width_m) AS outside,
        w.may_bend_m > 0 AND NOT in_lane(p.d_m, p.lat_half_m - w.may_bend_m, p.half_width_m) OR y.may_cross AND p.speed_mps IS NULL AS is_unsure,
        -- In the ego's way at this step, or soon at the present speeds across the lane. For an oncoming object, only its present position
        -- counts.
        abs(p.d_m - e.d_m) - p.lat_half_m - e.lat_half_m
        < CASE WHEN abs(p.heading_diff_rad) < 2 * pi() / 3 THEN
            drift_s() * greatest(0.0, sign(p.d_m - e.d_m) * (e.speed_mps * sin(e.heading_diff_rad) - p.speed_mps * sin(p.heading_diff_rad)))
        ELSE 0.0 END AS is_soon,
        -- An object that is partly in the lane may stand while the ego moves over, or move on into the lane, if its speed is not known.
        NOT is_soon AND p.speed_mps IS NULL AND abs(p.heading_diff_rad) < 2 * pi() / 3
            AND abs(p.d_m - e.d_m) - p.lat_half_m - e.lat_half_m
            < drift_s() * (coalesce(sign(p.d_m - e.d_m) * e.speed_mps * sin(e.heading_diff_rad), 0.0) + unknown_speed_mps() * greatest(0.0, -sign(p.d_m - e.d_m) * sin(p.heading_diff_rad))) AS may_be_soon
    FROM pair p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    LEFT JOIN actor_on_junction_lane c ON c.drive_id = p.drive_id AND c.object_id = p.object_id AND c.t_ns = p.t_ns
    LEFT JOIN own_way_end n ON n.drive_id = e.drive_id AND n.ego_id = e.ego_id AND n.chain_id = e.chain_id
    CROSS JOIN LATERAL (SELECT coalesce(bends_otherwise_m(p.s_m - n.driven_m, e.speed_mps), 0.0) AS may_bend_m) w
    CROSS JOIN LATERAL (
        SELECT NOT (c.t_ns IS NULL AND (n.driven_m IS NULL OR abs(p.heading_diff_rad) > 3 * pi() / 4) OR abs(p.heading_diff_rad) < pi() / 4) AS may_cross
    ) y
    WHERE may_be_vehicle_or_obstacle(p.actor_class, p.d_m - e.d_m, p.lat_half_m + e.lat_half_m) AND p.s_m > e.s_m
        AND (
            in_lane(p.d_m, p.lat_half_m + w.may_bend_m, p.half_width_m)
            OR abs(p.heading_diff_rad) > 2 * pi() / 3 AND abs(p.d_m - e.d_m) < p.lat_half_m + e.lat_half_m
                -- Only the ego's front can reach an object that stands there. The other parts of its box follow the front.
                AND (
                    (p.speed_mps <= standing_mps()) IS NOT true
                    OR abs(p.d_m - e.d_m - e.length_m / 2 * sin(e.heading_diff_rad)) < p.lat_half_m + e.width_m / 2 * cos(e.heading_diff_rad)
                )
        )
        -- An object beside the ego's box is not ahead, even if part of it is in the lane. If the two boxes overlap, they have met.
        AND (p.rear_s_m >= e.front_s_m OR abs(p.d_m - e.d_m) < p.lat_half_m + e.lat_half_m)
        -- An actor of unknown speed stands in the lane, or crosses it.
        AND (NOT y.may_cross OR coalesce(p.speed_mps <= standing_mps(), true))
),
-- Without a map: actors that the ego would soon hit with its present curvature, or with that of a moment before, although its path passes
-- them.
on_course AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, p.object_id, f.dx - e.length_m / 2 - box_half_across_m(p.width_m, p.length_m, f.turn_rad) AS gap_m, along_lane_mps(p.speed_mps, f.turn_rad) AS speed_mps,
        -- Straight on counts as well: an ego that comes out of a bend straightens.
        bool_or(
            abs(arc_offset_m(f.dx, f.dy, s.bend_per_m)) < e.width_m / 2 + box_half_across_m(p.length_m, p.width_m, f.turn_rad - s.bend_per_m * f.dx)
            AND abs(f.dy) < e.width_m / 2 + box_half_across_m(p.length_m, p.width_m, f.turn_rad)
        )
            OVER (PARTITION BY p.drive_id, p.ego_id, p.object_id ORDER BY p.t_ns RANGE BETWEEN 2_000_000_000 PRECEDING AND CURRENT ROW) AS is_course_held
    FROM pair p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    SEMI JOIN own_way_end n ON n.drive_id = e.drive_id AND n.ego_id = e.ego_id
    ASOF JOIN (FROM _own_way WHERE t_from_ns IS NOT NULL) s ON s.drive_id = e.drive_id AND s.ego_id = e.ego_id AND s.seg = e.chain_id AND s.t_from_ns <= e.t_ns
    CROSS JOIN LATERAL (
        SELECT
            (p.x_m - e.x_m) * cos(e.yaw_rad) + (p.y_m - e.y_m) * sin(e.yaw_rad) AS dx, (p.y_m - e.y_m) * cos(e.yaw_rad) - (p.x_m - e.x_m) * sin(e.yaw_rad) AS dy,
            p.yaw_rad - e.yaw_rad AS turn_rad
    ) f
    WHERE may_be_vehicle(p.actor_class) AND p.distance_m < lost_near_m() + late_s() * e.speed_mps AND f.dx > 0
        AND ttc_s(f.dx - e.length_m / 2 - box_half_across_m(p.width_m, p.length_m, f.turn_rad), e.speed_mps - CASE WHEN p.speed_mps > standing_mps() THEN p.speed_mps * cos(f.turn_rad) ELSE 0.0 END) < late_s()
        AND (coalesce(p.speed_mps <= standing_mps(), true) OR cos(f.turn_rad) > cos(pi() / 4))
)
-- The object's centre is in the lane, or the object is in the ego's way. A vehicle that only reaches over the line must not hide the
-- vehicle that the ego follows.
SELECT
    o.drive_id, o.ego_id, o.t_ns, o.object_id, CASE WHEN NOT o.is_unsure AND (o.is_centre_in_lane OR NOT o.may_be_soon) AND b.is_sure IS NULL THEN o.actor_class END AS actor_class, o.gap_m, o.speed_mps, o.oncoming, o.across_m, o.ego_across_mps,
    o.across_mps, CASE WHEN NOT o.may_be_soon THEN o.is_soon END AS soon, o.outside
FROM object_ahead o
-- The ego neither meets nor follows an object that its own path passes.
LEFT JOIN _passed_by b ON b.drive_id = o.drive_id AND b.ego_id = o.ego_id AND b.t_ns = o.t_ns AND b.object_id = o.object_id
WHERE (o.is_centre_in_lane OR o.is_soon OR o.may_be_soon) AND b.is_sure IS DISTINCT FROM true
UNION ALL BY NAME
SELECT c.* EXCLUDE (is_course_held) FROM on_course c
ANTI JOIN object_ahead o ON o.drive_id = c.drive_id AND o.ego_id = c.ego_id AND o.t_ns = c.t_ns AND o.object_id = c.object_id
WHERE c.is_course_held
