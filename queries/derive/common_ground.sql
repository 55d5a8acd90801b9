-- Where the ground that two boxes sweep is common to both, at an angle, not more than 10 s apart. What two actors share does not depend on which of
-- them is the ego.
WITH
-- two visits, that of the actor with the lesser id first: a pair of which either is an ego is looked at once
candidate AS (
    SELECT drive_id, actor_id AS a_id, cell AS a_cell, slot AS a_slot, heading AS a_heading, object_id AS b_id, object_cell AS b_cell, object_slot AS b_slot, object_heading AS b_heading
    FROM meeting
    WHERE actor_id < object_id
    UNION
    SELECT drive_id, object_id, object_cell, object_slot, object_heading, actor_id, cell, slot, heading
    FROM meeting
    WHERE actor_id > object_id
),
-- step by step, or the planner, which cannot know how few they are, would compare everybody with everybody
close AS MATERIALIZED (
    SELECT m.a_id, m.a_cell, m.a_slot, m.a_heading, b.*
    FROM candidate m
    JOIN swept_box b ON b.drive_id = m.drive_id AND b.actor_id = m.b_id AND b.cell = m.b_cell AND b.slot = m.b_slot AND b.heading = m.b_heading
),
angled AS MATERIALIZED (
    SELECT b.drive_id, b.a_id, b.actor_id AS b_id, a.t_ns AS ta_ns, b.t_ns AS tb_ns, a.t_sample_ns AS ka_ns, b.t_sample_ns AS kb_ns, (b.x_m - a.x_m) ** 2 + (b.y_m - a.y_m) ** 2 AS d2
    FROM close b
    JOIN swept_box a ON a.drive_id = b.drive_id AND a.actor_id = b.a_id AND a.cell = b.a_cell AND a.slot = b.a_slot AND a.heading = b.a_heading
    WHERE abs(a.t_ns - b.t_ns) <= conflict_ns() AND abs(wrap_rad(b.travel_rad - a.travel_rad)) > conflict_angle_rad() AND same_level(b.z_m, a.z_m)
        AND boxes_meet(b.x_m - a.x_m, b.y_m - a.y_m, a.cos_yaw, a.sin_yaw, b.cos_yaw, b.sin_yaw, a.half_length_m, a.half_width_m, b.half_length_m, b.half_width_m)
),
-- In a tight bend even a follower's box lies across that of another moment. What counts is the angle against the other's way where that comes
-- nearest: of those there, nearer to it than any at an angle, is one that runs along its way
there AS MATERIALIZED (
    SELECT t.other_id, t.d2, b.*
    FROM (
        SELECT drive_id, a_id AS own_id, b_id AS other_id, ta_ns AS t_ns, min(d2) AS d2 FROM angled GROUP BY ALL
        UNION ALL
        SELECT drive_id, b_id, a_id, tb_ns, min(d2) FROM angled GROUP BY ALL
    ) t
    JOIN swept_box b ON b.drive_id = t.drive_id AND b.actor_id = t.own_id AND b.t_ns = t.t_ns
),
around AS MATERIALIZED (
    SELECT *, unnest(range(floor((y_m - sqrt(d2)) / cell_m)::BIGINT, floor((y_m + sqrt(d2)) / cell_m)::BIGINT + 1)) AS near_iy
    FROM (
        SELECT t.*, t.slot + s.i AS near_slot, unnest(range(floor((x_m - sqrt(d2)) / cell_m)::BIGINT, floor((x_m + sqrt(d2)) / cell_m)::BIGINT + 1)) AS near_ix
        FROM there t CROSS JOIN (VALUES (-1), (0), (1)) AS s(i)
    )
),
along AS MATERIALIZED (
    SELECT DISTINCT o.drive_id, o.actor_id AS own_id, o.other_id, o.t_ns
    FROM around o
    JOIN swept_box e ON e.drive_id = o.drive_id AND e.actor_id = o.other_id AND e.ix = o.near_ix AND e.iy = o.near_iy AND e.slot = o.near_slot
    WHERE (o.x_m - e.x_m) ** 2 + (o.y_m - e.y_m) ** 2 < o.d2 AND abs(e.t_ns - o.t_ns) <= conflict_ns()
        AND abs(wrap_rad(o.travel_rad - e.travel_rad)) <= conflict_angle_rad() AND same_level(o.z_m, e.z_m)
        AND boxes_meet(o.x_m - e.x_m, o.y_m - e.y_m, e.cos_yaw, e.sin_yaw, o.cos_yaw, o.sin_yaw, e.half_length_m, e.half_width_m, o.half_length_m, o.half_width_m)
),
-- not along each other's way: for one of the two that is so
shared AS MATERIALIZED (
    SELECT a.*
    FROM angled a
    LEFT JOIN along x ON x.drive_id = a.drive_id AND x.own_id = a.a_id AND x.other_id = a.b_id AND x.t_ns = a.ta_ns
    LEFT JOIN along y ON y.drive_id = a.drive_id AND y.own_id = a.b_id AND y.other_id = a.a_id AND y.t_ns = a.tb_ns
    WHERE x.own_id IS NULL OR y.own_id IS NULL
),
-- the same as each ego sees it; the trailer that it draws is the ego
mine AS MATERIALIZED (SELECT DISTINCT drive_id, ego_id, actor_id, object_id FROM meeting)
SELECT p.drive_id, p.ego_id, p.actor_id, p.object_id, p.t_ego_ns, p.t_object_ns
FROM (
    SELECT m.*, s.ta_ns AS t_ego_ns, s.tb_ns AS t_object_ns, s.ka_ns AS t_step_ns
    FROM shared s JOIN mine m ON m.drive_id = s.drive_id AND m.actor_id = s.a_id AND m.object_id = s.b_id
    UNION ALL
    SELECT m.*, s.tb_ns, s.ta_ns, s.kb_ns
    FROM shared s JOIN mine m ON m.drive_id = s.drive_id AND m.actor_id = s.b_id AND m.object_id = s.a_id
) p
-- a trailer's other samples are not the ego's steps
SEMI JOIN step k ON k.drive_id = p.drive_id AND k.ego_id = p.ego_id AND k.t_ns = p.t_step_ns
