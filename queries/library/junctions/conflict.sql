-- Encounters of two actors on common ground: when each of them entered and left it, and the time between the two. The result does not
-- depend on which of the two is the ego.
-- lifetime: part
CREATE TABLE conflict (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the conflict, from 0, in time order: the areas swept by the ego (with its trailer) and another actor cross or merge, at more than 20 degrees between the two paths and at most 10 s apart. There is no conflict with an actor that stands all the time on the common ground, has no position, heading or size, or takes the same course within 20 degrees; see passage_conflict
    object_id VARCHAR NOT NULL,       -- the other actor
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    t_ego_in_ns BIGINT NOT NULL,      -- first step with the ego's box on the conflict area: the ground that the object's box was or will be on {position}
    t_ego_out_ns BIGINT NOT NULL,     -- last step with the ego's box on it {position}
    t_object_in_ns BIGINT NOT NULL,   -- first sample of the object on ground that the ego's box was or will be on {position}
    t_object_out_ns BIGINT NOT NULL,  -- last sample of the object on it {position}
    pet_s DOUBLE NOT NULL,            -- post-encroachment time (PET): later entry minus earlier exit, both interpolated between samples, as near to each other as the speeds allow; negative: both were on the area at once {position, velocity}
    pet_at_most BOOLEAN NOT NULL,     -- pet_s is only an upper bound: the later actor's track begins, or continues after a hole, where it enters, or the earlier actor's track ends where it leaves {position}
    ego_first BOOLEAN NOT NULL,       -- the ego entered first, or both at the same time {position}
    angle_rad DOUBLE NOT NULL,        -- the object's heading relative to the ego's path, where the later of the two enters, -pi..pi: near pi oncoming, negative: it comes from the left {heading}
    ego_speed_mps DOUBLE,             -- speed of the ego when it enters {velocity}
    speed_mps DOUBLE,                 -- speed of the object when it enters {velocity}
    decel_mps2 DOUBLE,                -- the object's strongest mean deceleration over 0.5 s, from 4 s before the ego's entry until its own entry (positive: it slowed), without an impact with the ego; NULL: not completely seen, or it entered before that {velocity}
    junction_id VARCHAR,              -- the junction in which the ego's front is when the ego enters the area; NULL: none, or no map
    crossing_id VARCHAR               -- the pedestrian crossing on which the ego's box is then; NULL: none, or no map
);

INSERT INTO conflict BY NAME
WITH
drive_clock AS (SELECT drive_id, max(period_ns) AS period_ns, max(max_gap_ns) AS max_gap_ns FROM _ego_clock GROUP BY drive_id),
-- u is the actor with the lesser id, v is the other one. The moments of u are divided into stretches without a pause; within each stretch
-- of u, the moments of v are divided in the same way.
pair_moment AS MATERIALIZED (
    SELECT
        drive_id, ego_id, object_id, actor_id, ego_id < object_id AS ego_is_u, CASE WHEN ego_is_u THEN t_ego_ns ELSE t_object_ns END AS u_ns, CASE WHEN ego_is_u THEN t_object_ns ELSE t_ego_ns END AS v_ns
    FROM _common_ground
),
lesser_id_moment AS MATERIALIZED (
    SELECT p.*, sum((u_ns - before_ns > g.max_gap_ns)::INTEGER) OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY u_ns) AS u_stretch
    FROM (
        SELECT *, lag(u_ns, 1, u_ns) OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY u_ns) AS before_ns
        FROM (SELECT DISTINCT drive_id, ego_id, object_id, u_ns FROM pair_moment)
    ) p
    JOIN drive_clock g USING (drive_id)
),
greater_id_moment AS MATERIALIZED (
    SELECT *, sum((v_ns - before_ns > max_gap_ns)::INTEGER) OVER (PARTITION BY drive_id, ego_id, object_id, u_stretch ORDER BY v_ns) AS v_stretch
    FROM (
        SELECT p.*, g.max_gap_ns, lag(v_ns, 1, v_ns) OVER (PARTITION BY drive_id, ego_id, object_id, u_stretch ORDER BY v_ns) AS before_ns
        FROM (
            SELECT t.drive_id, t.ego_id, t.object_id, t.actor_id, t.ego_is_u, s.u_stretch, t.v_ns, min(t.u_ns) AS u_first_ns, max(t.u_ns) AS u_last_ns
            FROM pair_moment t JOIN lesser_id_moment s USING (drive_id, ego_id, object_id, u_ns)
            GROUP BY ALL
        ) p
        JOIN drive_clock g USING (drive_id)
    )
),
stretch_pair AS MATERIALIZED (
    SELECT
        drive_id, ego_id, object_id, u_stretch, v_stretch, any_value(max_gap_ns) AS max_gap_ns, min(u_first_ns) AS u_first_ns, max(u_last_ns) AS u_last_ns,
        min(v_ns) AS v_first_ns, max(v_ns) AS v_last_ns
    FROM greater_id_moment
    GROUP BY drive_id, ego_id, object_id, u_stretch, v_stretch
),
-- A pair of stretches and the previous one (b) belong to the same encounter if one of the actors did not leave in between and the other
-- soon came back. At the edge of the common ground, the angle may fall below 20 degrees and rise again, and an actor may step aside. n is
-- the number of the encounter.
encounter_part AS MATERIALIZED (
    SELECT drive_id, ego_id, object_id, u_stretch, v_stretch, sum((NOT is_joined)::INTEGER) OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY u_stretch, v_stretch) AS n
    FROM (
        SELECT
            *, greatest(u_first_ns - b.u_last_ns, b.u_first_ns - u_last_ns) AS u_gap_ns, greatest(v_first_ns - b.v_last_ns, b.v_first_ns - v_last_ns) AS v_gap_ns,
            coalesce(least(u_gap_ns, v_gap_ns) <= max_gap_ns AND greatest(u_gap_ns, v_gap_ns) <= conflict_apart_ns(), true) AS is_joined
        FROM (
            SELECT
                *, lag({'u_first_ns': u_first_ns, 'u_last_ns': u_last_ns, 'v_first_ns': v_first_ns, 'v_last_ns': v_last_ns})
                    OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY u_stretch, v_stretch) AS b
            FROM stretch_pair
        )
    )
),
-- The first and last moment of each of the ego's boxes on the common ground, and those of the object on the ground that it shares with
-- this box.
box_time AS MATERIALIZED (
    SELECT
        drive_id, ego_id, object_id, n, actor_id, CASE WHEN ego_is_u THEN min(u_first_ns) ELSE min(v_ns) END AS ego_first_ns, CASE WHEN ego_is_u THEN max(u_last_ns) ELSE max(v_ns) END AS ego_last_ns,
        CASE WHEN ego_is_u THEN min(v_ns) ELSE min(u_first_ns) END AS object_first_ns, CASE WHEN ego_is_u THEN max(v_ns) ELSE max(u_last_ns) END AS object_last_ns
    FROM greater_id_moment JOIN encounter_part USING (drive_id, ego_id, object_id, u_stretch, v_stretch)
    GROUP BY drive_id, ego_id, object_id, n, actor_id, ego_is_u
),
encounter_time AS MATERIALIZED (
    SELECT
        drive_id, ego_id, object_id, n, min(ego_first_ns) AS ego_first_ns, max(ego_last_ns) AS ego_last_ns, min(object_first_ns) AS object_first_ns, max(object_last_ns) AS object_last_ns
    FROM box_time
    GROUP BY drive_id, ego_id, object_id, n
),
-- One row per entry (sense 1) or exit (sense -1) of a box. on_id is the actor whose ground is entered or left; that actor is there from
-- t_from_ns to t_to_ns. i is the box at the first or last moment on the ground; t_off_ns is the moment just before or after, when the box
-- is off the ground.
entry_or_exit AS MATERIALIZED (
    SELECT
        p.drive_id, p.ego_id, p.object_id, p.n, p.is_ego, p.on_id, p.t_from_ns - g.period_ns AS t_from_ns, p.t_to_ns + g.period_ns AS t_to_ns, p.sense, i,
        CASE WHEN p.sense = 1 THEN i.t_before_ns ELSE i.t_after_ns END AS t_off_ns
    FROM (
        SELECT
            o.drive_id, o.ego_id, o.object_id, o.n, true AS is_ego, o.actor_id, o.object_id AS on_id, w.object_first_ns AS t_from_ns, w.object_last_ns AS t_to_ns,
            unnest([1, -1]) AS sense, unnest([o.ego_first_ns, o.ego_last_ns]) AS t_ns
        FROM box_time o JOIN encounter_time w USING (drive_id, ego_id, object_id, n)
        UNION ALL
        SELECT
            o.drive_id, o.ego_id, o.object_id, o.n, false, o.object_id, o.actor_id, o.ego_first_ns, o.ego_last_ns,
            unnest([1, -1]), unnest([w.object_first_ns, w.object_last_ns])
        FROM box_time o JOIN encounter_time w USING (drive_id, ego_id, object_id, n)
    ) p
    JOIN drive_clock g USING (drive_id)
    JOIN _swept_box i ON i.drive_id = p.drive_id AND i.actor_id = p.actor_id AND i.t_ns = p.t_ns
),
entry_or_exit_with_boxes AS MATERIALIZED (
    SELECT e.*, f
    FROM entry_or_exit e
    LEFT JOIN _swept_box f ON f.drive_id = e.drive_id AND f.actor_id = e.i.actor_id AND f.t_ns = e.t_off_ns
),
-- share: the part of the path, from the moment off the ground to the moment on it, after which the box first touches a box of the other
-- actor. angle_rad: the other's direction of travel minus this actor's own, where the two are nearest.
first_contact AS MATERIALIZED (
    SELECT
        drive_id, ego_id, object_id, n, is_ego, actor_id, sense, t_sample_ns, t_on_ns, t_off_ns, min(first_touch(sides_off, sides_on)) AS share,
        min({'d2': d2, 't_ns': t_ns, 'angle_rad': angle_rad}) FILTER (abs(angle_rad) > conflict_angle_rad() AND is_meeting).angle_rad AS angle_rad
    FROM (
        SELECT
            e.drive_id, e.ego_id, e.object_id, e.n, e.is_ego, i.actor_id AS actor_id, e.sense, i.t_sample_ns AS t_sample_ns, i.t_ns AS t_on_ns, e.t_off_ns, b.t_ns,
            (b.x_m - i.x_m) ** 2 + (b.y_m - i.y_m) ** 2 AS d2, wrap_rad(b.travel_rad - i.travel_rad) AS angle_rad,
            boxes_sides(b.x_m - f.x_m, b.y_m - f.y_m, f.cos_yaw, f.sin_yaw, b.cos_yaw, b.sin_yaw, f.half_length_m, f.half_width_m, b.half_length_m, b.half_width_m) AS sides_off,
            boxes_sides(b.x_m - i.x_m, b.y_m - i.y_m, i.cos_yaw, i.sin_yaw, b.cos_yaw, b.sin_yaw, i.half_length_m, i.half_width_m, b.half_length_m, b.half_width_m) AS sides_on,
            boxes_meet(b.x_m - i.x_m, b.y_m - i.y_m, i.cos_yaw, i.sin_yaw, b.cos_yaw, b.sin_yaw, i.half_length_m, i.half_width_m, b.half_length_m, b.half_width_m) AS is_meeting
        FROM entry_or_exit_with_boxes e
        JOIN _swept_box b ON b.drive_id = e.drive_id AND b.actor_id = e.on_id AND b.t_ns >= e.t_from_ns AND b.t_ns <= e.t_to_ns
    )
    GROUP BY drive_id, ego_id, object_id, n, is_ego, actor_id, sense, t_sample_ns, t_on_ns, t_off_ns
),
-- If the common ground ends because the angle becomes too small, and not because the boxes separate, share is NULL. The time of the entry
-- or exit is then the moment off the ground. An entry or exit without a moment off the ground was not seen.
entry_or_exit_time AS MATERIALIZED (
    SELECT
        drive_id, ego_id, object_id, n, is_ego, sense, min(sense * t_sample_ns) AS signed_sample_ns,
        min({
            'ns': sense * (t_on_ns - coalesce(round((1 - coalesce(share, 0)) * (t_on_ns - t_off_ns)), 0)::BIGINT), 'is_known': t_off_ns IS NOT NULL,
            'off_rad': -abs(angle_rad), 'angle_rad': CASE WHEN is_ego THEN angle_rad ELSE -angle_rad END
        }) AS entry_or_exit
    FROM first_contact
    GROUP BY drive_id, ego_id, object_id, n, is_ego, sense
),
encounter AS MATERIALIZED (
    SELECT
        drive_id, ego_id, object_id, n, min(signed_sample_ns) FILTER (is_ego AND sense = 1) AS t_ego_in_ns, min(-signed_sample_ns) FILTER (is_ego AND sense = -1) AS t_ego_out_ns,
        min(signed_sample_ns) FILTER (NOT is_ego AND sense = 1) AS t_object_in_ns, min(-signed_sample_ns) FILTER (NOT is_ego AND sense = -1) AS t_object_out_ns,
        max({'ns': entry_or_exit.ns, 'is_unknown': NOT entry_or_exit.is_known, 'off_rad': -entry_or_exit.off_rad, 'angle_rad': entry_or_exit.angle_rad}) FILTER (sense = 1) AS later_entry,
        min({'ns': -entry_or_exit.ns, 'is_known': entry_or_exit.is_known}) FILTER (sense = -1) AS earlier_exit
    FROM entry_or_exit_time
    GROUP BY drive_id, ego_id, object_id, n
),
-- The course over ground of each actor on the common ground, independent of its recorded heading. If the actor moves less than a metre
-- there, half a second before and after is added. NULL: it hardly moves.
course_on_ground AS MATERIALIZED (
    SELECT drive_id, ego_id, object_id, n, is_ego, min({'margin_ns': margin_ns, 'course_rad': atan2(north_m, east_m)}).course_rad AS course_rad
    FROM (
        SELECT
            p.*, max({'t_ns': s.t_ns, 'x_m': s.x_m}).x_m - min({'t_ns': s.t_ns, 'x_m': s.x_m}).x_m AS east_m,
            max({'t_ns': s.t_ns, 'y_m': s.y_m}).y_m - min({'t_ns': s.t_ns, 'y_m': s.y_m}).y_m AS north_m
        FROM (
            SELECT e.drive_id, e.ego_id, e.object_id, e.n, true AS is_ego, e.ego_id AS actor_id, e.t_ego_in_ns AS t_in_ns, e.t_ego_out_ns AS t_out_ns, m.margin_ns
            FROM encounter e CROSS JOIN (VALUES (0), (500_000_000)) AS m(margin_ns)
            UNION ALL
            SELECT e.drive_id, e.ego_id, e.object_id, e.n, false, e.object_id, e.t_object_in_ns, e.t_object_out_ns, m.margin_ns
            FROM encounter e CROSS JOIN (VALUES (0), (500_000_000)) AS m(margin_ns)
        ) p
        JOIN state_dynamics s ON s.drive_id = p.drive_id AND s.actor_id = p.actor_id AND s.t_ns >= p.t_in_ns - p.margin_ns AND s.t_ns <= p.t_out_ns + p.margin_ns
        WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL
        GROUP BY ALL
    )
    WHERE sqrt(east_m ** 2 + north_m ** 2) >= standing_spread_m()
    GROUP BY drive_id, ego_id, object_id, n, is_ego
),
-- Two actors with the same course over the common ground follow each other: only their recorded headings differ, and one of them is wrong.
-- The time between them is headway.
following_encounter AS MATERIALIZED (
    SELECT e.drive_id, e.ego_id, e.object_id, e.n
    FROM (FROM course_on_ground WHERE is_ego) e
    JOIN (FROM course_on_ground WHERE NOT is_ego) o USING (drive_id, ego_id, object_id, n)
    WHERE abs(wrap_rad(o.course_rad - e.course_rad)) <= conflict_angle_rad()
),
-- An actor that stands all the time on the common ground is an obstacle, not a partner in a conflict.
moving_encounter AS MATERIALIZED (
    SELECT
        e.*, (later_entry.ns - earlier_exit.ns) / 1e9 AS pet_s, later_entry.is_unknown OR NOT earlier_exit.is_known AS pet_at_most, later_entry.angle_rad AS angle_rad
    FROM encounter e
    ANTI JOIN following_encounter f ON f.drive_id = e.drive_id AND f.ego_id = e.ego_id AND f.object_id = e.object_id AND f.n = e.n
    SEMI JOIN state_dynamics s ON s.drive_id = e.drive_id AND s.actor_id = e.object_id
        AND s.t_ns >= e.t_object_in_ns AND s.t_ns <= e.t_object_out_ns AND coalesce(s.speed_mps > standing_mps(), true)
    SEMI JOIN state_dynamics o ON o.drive_id = e.drive_id AND o.actor_id = e.ego_id
        AND o.t_ns >= e.t_ego_in_ns AND o.t_ns <= e.t_ego_out_ns AND coalesce(o.speed_mps > standing_mps(), true)
    -- An actor over or under the ego's road does not meet the ego. off_level is also true if this is only possible: pair then gives the
    -- actor no position.
    ANTI JOIN (FROM pair WHERE off_level) p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.object_id = e.object_id
        AND p.t_ns >= e.t_object_in_ns AND p.t_ns <= e.t_object_out_ns
),
-- The mean deceleration over the half second before each sample, if all samples of that time exist.
object_braking AS (
    SELECT
        drive_id, ego_id, object_id, n, max(decel_mps2) FILTER (coalesce(t_ns < t_impact_ns, true)) AS decel_mps2,
        -- The whole period was seen.
        bool_and(coalesce(gap_ns <= max_gap_ns, true)) AND min(t_ns) - (t_ego_in_ns - 4_000_000_000) <= period_ns
            AND max(t_ns) = t_object_in_ns AND bool_and(speed_mps IS NOT NULL) AS is_whole
    FROM (
        SELECT
            m.drive_id, m.ego_id, m.object_id, m.n, m.t_ego_in_ns, m.t_object_in_ns, i.t_ns AS t_impact_ns, s.t_ns, s.speed_mps, c.max_gap_ns, c.period_ns,
            s.t_ns - lag(s.t_ns) OVER w AS gap_ns,
            CASE WHEN s.t_ns - first_value(s.t_ns) OVER half >= 500_000_000 - c.period_ns // 2 THEN
                (first_value(s.speed_mps) OVER half - s.speed_mps) / ((s.t_ns - first_value(s.t_ns) OVER half) / 1e9)
            END AS decel_mps2
        FROM moving_encounter m
        JOIN clock c USING (drive_id, ego_id)
        JOIN state_dynamics s ON s.drive_id = m.drive_id AND s.actor_id = m.object_id
            AND s.t_ns >= m.t_ego_in_ns - 4_000_000_000 AND s.t_ns <= m.t_object_in_ns
        LEFT JOIN impact i ON i.drive_id = m.drive_id AND i.ego_id = m.ego_id AND i.object_id = m.object_id
        WINDOW
            w AS (PARTITION BY m.drive_id, m.ego_id, m.object_id, m.n ORDER BY s.t_ns),
            half AS (
                PARTITION BY m.drive_id, m.ego_id, m.object_id, m.n ORDER BY s.t_ns
                RANGE BETWEEN 500_000_000 PRECEDING AND CURRENT ROW
            )
    )
    GROUP BY drive_id, ego_id, object_id, n, t_ego_in_ns, t_object_in_ns, period_ns
),
-- The lanelets under the ego's box when its front enters the area.
entry_lanelet AS (
    SELECT m.drive_id, m.ego_id, m.t_ego_in_ns, g.environment_id, c.lanelet_id, e.front_s_m - c.s_start_m AS front_m, e.rear_s_m - c.s_start_m AS rear_m, c.length_m
    FROM (SELECT DISTINCT drive_id, ego_id, t_ego_in_ns FROM moving_encounter) m
    JOIN ego_state e ON e.drive_id = m.drive_id AND e.ego_id = m.ego_id AND e.t_ns = m.t_ego_in_ns
    JOIN data_log g ON g.drive_id = m.drive_id
    JOIN chain c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.chain_id = e.chain_id
        AND c.s_start_m <= e.front_s_m AND c.s_start_m + c.length_m >= e.rear_s_m
),
entry_junction AS (
    SELECT i.drive_id, i.ego_id, i.t_ego_in_ns, max({'s_m': -i.front_m, 'id': n.junction_id}).id AS junction_id
    FROM entry_lanelet i
    JOIN lanelet n USING (environment_id, lanelet_id)
    WHERE i.front_m >= 0 AND i.front_m < i.length_m AND n.junction_id IS NOT NULL
    GROUP BY ALL
),
entry_crossing AS (
    SELECT i.drive_id, i.ego_id, i.t_ego_in_ns, max({'s_m': x.s_start_m - i.front_m, 'id': x.crossing_id}).id AS crossing_id
    FROM entry_lanelet i
    JOIN crossing x USING (environment_id, lanelet_id)
    WHERE i.front_m >= x.s_start_m AND i.rear_m <= x.s_end_m
    GROUP BY ALL
)
SELECT
    m.drive_id, m.ego_id,
    (row_number() OVER (PARTITION BY m.drive_id, m.ego_id ORDER BY m.t_ego_in_ns, m.t_object_in_ns, m.object_id, m.n) - 1)::INTEGER AS occurrence,
    m.object_id, o.actor_class, m.t_ego_in_ns, m.t_ego_out_ns, m.t_object_in_ns, m.t_object_out_ns,
    m.pet_s, m.pet_at_most,
    m.t_ego_in_ns <= m.t_object_in_ns AS ego_first, m.angle_rad,
    a.speed_mps AS ego_speed_mps, o.speed_mps,
    CASE WHEN d.is_whole THEN d.decel_mps2 END AS decel_mps2,
    j.junction_id, x.crossing_id
FROM moving_encounter m
JOIN state_dynamics a ON a.drive_id = m.drive_id AND a.actor_id = m.ego_id AND a.t_ns = m.t_ego_in_ns
JOIN state_dynamics o ON o.drive_id = m.drive_id AND o.actor_id = m.object_id AND o.t_ns = m.t_object_in_ns
LEFT JOIN object_braking d ON d.drive_id = m.drive_id AND d.ego_id = m.ego_id AND d.object_id = m.object_id AND d.n = m.n
LEFT JOIN entry_junction j ON j.drive_id = m.drive_id AND j.ego_id = m.ego_id AND j.t_ego_in_ns = m.t_ego_in_ns
LEFT JOIN entry_crossing x ON x.drive_id = m.drive_id AND x.ego_id = m.ego_id AND x.t_ego_in_ns = m.t_ego_in_ns
