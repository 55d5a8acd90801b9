-- Moments at which two boxes cover the same ground, at an angle and at most 10 s apart. The result does not depend on which of the two
-- actors is the ego.
-- lifetime: part
CREATE TABLE _common_ground (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    actor_id VARCHAR NOT NULL,        -- the ego, or a trailer of the ego
    object_id VARCHAR NOT NULL,       -- another actor
    t_ego_ns BIGINT NOT NULL,         -- a moment of the box of actor_id, see _swept_box
    t_object_ns BIGINT NOT NULL       -- a moment of the object's box, at most 10 s before or after, at which it covers the same ground at more than 20 degrees
);

INSERT INTO _common_ground BY NAME
WITH
-- Pairs of visits. A visit groups the samples of one actor that lie in one grid cell, one 10 s slot and one 5-degree heading step (see
-- meeting). The first visit is that of the actor with the lesser id, so that a pair that two egos share is examined only once.
visit_pair AS (
    SELECT drive_id, actor_id AS a_id, cell AS a_cell, slot AS a_slot, heading AS a_heading, object_id AS b_id, object_cell AS b_cell, object_slot AS b_slot, object_heading AS b_heading
    FROM _meeting
    WHERE actor_id < object_id
    UNION
    SELECT drive_id, object_id, object_cell, object_slot, object_heading, actor_id, cell, slot, heading
    FROM _meeting
    WHERE actor_id > object_id
),
-- One join at a time: the planner underestimates how few pairs of visits there are, and would compare all actors with each other.
visit_pair_box AS MATERIALIZED (
    SELECT m.a_id, m.a_cell, m.a_slot, m.a_heading, b.*
    FROM visit_pair m
    JOIN _swept_box b ON b.drive_id = m.drive_id AND b.actor_id = m.b_id AND b.cell = m.b_cell AND b.slot = m.b_slot AND b.heading = m.b_heading
),
angled_pair AS MATERIALIZED (
    SELECT b.drive_id, b.a_id, b.actor_id AS b_id, a.t_ns AS a_t_ns, b.t_ns AS b_t_ns, a.t_sample_ns AS a_sample_ns, b.t_sample_ns AS b_sample_ns, (b.x_m - a.x_m) ** 2 + (b.y_m - a.y_m) ** 2 AS squared_distance_m2
    FROM visit_pair_box b
    JOIN _swept_box a ON a.drive_id = b.drive_id AND a.actor_id = b.a_id AND a.cell = b.a_cell AND a.slot = b.a_slot AND a.heading = b.a_heading
    WHERE abs(a.t_ns - b.t_ns) <= conflict_ns() AND abs(wrap_rad(b.travel_rad - a.travel_rad)) > conflict_angle_rad() AND same_level(b.z_m, a.z_m)
        AND boxes_meet(b.x_m - a.x_m, b.y_m - a.y_m, a.cos_yaw, a.sin_yaw, b.cos_yaw, b.sin_yaw, a.half_length_m, a.half_width_m, b.half_length_m, b.half_width_m)
),
-- In a tight bend, even a follower's box lies at an angle to the leader's box of another moment. The angle is therefore measured to the
-- other actor's path, at its point nearest to this actor. An actor moves along that path if the nearest of the other actor's boxes has the
-- same direction.
angled_moment AS MATERIALIZED (
    SELECT t.other_id, t.squared_distance_m2, b.*
    FROM (
        SELECT drive_id, a_id AS own_id, b_id AS other_id, a_t_ns AS t_ns, min(squared_distance_m2) AS squared_distance_m2 FROM angled_pair GROUP BY ALL
        UNION ALL
        SELECT drive_id, b_id, a_id, b_t_ns, min(squared_distance_m2) FROM angled_pair GROUP BY ALL
    ) t
    JOIN _swept_box b ON b.drive_id = t.drive_id AND b.actor_id = t.own_id AND b.t_ns = t.t_ns
),
nearby_cell AS MATERIALIZED (
    SELECT *, unnest(range(floor((y_m - sqrt(squared_distance_m2)) / cell_m)::BIGINT, floor((y_m + sqrt(squared_distance_m2)) / cell_m)::BIGINT + 1)) AS near_iy
    FROM (
        SELECT t.*, t.slot + s.i AS near_slot, unnest(range(floor((x_m - sqrt(squared_distance_m2)) / cell_m)::BIGINT, floor((x_m + sqrt(squared_distance_m2)) / cell_m)::BIGINT + 1)) AS near_ix
        FROM angled_moment t CROSS JOIN (VALUES (-1), (0), (1)) AS s(i)
    )
),
along_moment AS MATERIALIZED (
    SELECT DISTINCT o.drive_id, o.actor_id AS own_id, o.other_id, o.t_ns
    FROM nearby_cell o
    JOIN _swept_box e ON e.drive_id = o.drive_id AND e.actor_id = o.other_id AND e.ix = o.near_ix AND e.iy = o.near_iy AND e.slot = o.near_slot
    WHERE (o.x_m - e.x_m) ** 2 + (o.y_m - e.y_m) ** 2 < o.squared_distance_m2 AND abs(e.t_ns - o.t_ns) <= conflict_ns()
        AND abs(wrap_rad(o.travel_rad - e.travel_rad)) <= conflict_angle_rad() AND same_level(o.z_m, e.z_m)
        AND boxes_meet(o.x_m - e.x_m, o.y_m - e.y_m, e.cos_yaw, e.sin_yaw, o.cos_yaw, o.sin_yaw, e.half_length_m, e.half_width_m, o.half_length_m, o.half_width_m)
),
-- At least one of the two does not move along the other's way.
crossing_pair AS MATERIALIZED (
    SELECT a.*
    FROM angled_pair a
    LEFT JOIN along_moment x ON x.drive_id = a.drive_id AND x.own_id = a.a_id AND x.other_id = a.b_id AND x.t_ns = a.a_t_ns
    LEFT JOIN along_moment y ON y.drive_id = a.drive_id AND y.own_id = a.b_id AND y.other_id = a.a_id AND y.t_ns = a.b_t_ns
    WHERE x.own_id IS NULL OR y.own_id IS NULL
),
-- The same from the view of each ego. A trailer that the ego tows counts as the ego.
ego_meeting AS MATERIALIZED (SELECT DISTINCT drive_id, ego_id, actor_id, object_id FROM _meeting)
SELECT p.drive_id, p.ego_id, p.actor_id, p.object_id, p.t_ego_ns, p.t_object_ns
FROM (
    SELECT m.*, s.a_t_ns AS t_ego_ns, s.b_t_ns AS t_object_ns, s.a_sample_ns AS t_step_ns
    FROM crossing_pair s JOIN ego_meeting m ON m.drive_id = s.drive_id AND m.actor_id = s.a_id AND m.object_id = s.b_id
    UNION ALL
    SELECT m.*, s.b_t_ns, s.a_t_ns, s.b_sample_ns
    FROM crossing_pair s JOIN ego_meeting m ON m.drive_id = s.drive_id AND m.actor_id = s.b_id AND m.object_id = s.a_id
) p
-- A sample of a trailer counts only if it is a step of the ego, too.
SEMI JOIN step k ON k.drive_id = p.drive_id AND k.ego_id = p.ego_id AND k.t_ns = p.t_step_ns
