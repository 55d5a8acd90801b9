-- The actors that the ego went ahead of in a junction, by the direction from which they came, and whether another actor may have come. The
-- ego went ahead of an actor if it took the common ground first, or while the actor was still on it.
-- lifetime: part
CREATE TABLE passage_conflict (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- see junction_passage; one row for each relation
    relation VARCHAR NOT NULL,        -- [relation] the direction from which the actor came, by its heading 2 s before, relative to the ego's at its entry. oncoming: from the road ahead (if that road leads off at an angle and no other is as straight, also from_left or from_right). ahead_going: a cyclist, animal or vehicle along the ego's own road that continues while the ego turns. pedestrian: on foot, in the junction or within 12 m before or after it. An actor without a class may be any {position}
    object_id VARCHAR,                -- the actor with the least PET, of the actors that the ego went ahead of or drove into. Driven into: a pedestrian who was still there, or a vehicle that had not yet passed the ego's front; NULL: none
    actor_class VARCHAR,              -- [actor_class] see road_user; it decides whether a low PET breaks a rule {class}
    pet_s DOUBLE,                     -- PET (post-encroachment time) of object_id, also if by reason another actor may have a lower one; infinite: no actor within 10 s, or until the log's end at least 4 s later; NULL: not known {position, velocity}
    decel_mps2 DOUBLE,                -- see conflict; 0 if there is no actor; NULL: not known {velocity}
    braked_id VARCHAR,                -- an actor of this relation (by its heading when it began to brake) that braked where its path led onto the ego's, whether it came or not, see forced_braking. Of several, first one without another cause, then the hardest braking; NULL: none {position, velocity}
    braked_pet_s DOUBLE,              -- PET that would have resulted at the speed of braked_id before the braking {position, velocity}
    braked_mps2 DOUBLE,               -- deceleration of braked_id {velocity}
    braked_cause VARCHAR,             -- [braking_cause] another possible cause of the braking, see forced_braking; NULL: none
    reason VARCHAR                    -- why another actor cannot be excluded, as JSON from the macro why: an actor has no position, heading or size; a track begins or ends within 30 m, or as near as the actor can drive in that time; the log, a hole or the sensor's range ends too soon; NULL: no other actor
);

INSERT INTO passage_conflict BY NAME
WITH passage AS (
    SELECT
        p.drive_id, p.ego_id, p.occurrence, p.t_in_ns, p.t_out_ns, coalesce(p.t_in_ns, p.t_first_ns) AS t_enter_ns, coalesce(p.t_out_ns, p.t_last_ns) AS t_leave_ns,
        a.yaw_rad AS heading_rad, p.straightest_rad, a.travel_m AS travel_in_m, b.travel_m, b.x_m, b.y_m
    FROM junction_passage p
    JOIN ego_state a ON a.drive_id = p.drive_id AND a.ego_id = p.ego_id AND a.t_ns = coalesce(p.t_in_ns, p.t_first_ns)
    JOIN ego_state b ON b.drive_id = p.drive_id AND b.ego_id = p.ego_id AND b.t_ns = p.t_last_ns
),
-- Actors on common ground with the ego in the junction. Pedestrians also count up to 12 m before and after the junction: in the mouths of
-- the roads that the ego turns out of and into.
encounter AS (
    SELECT
        p.drive_id, p.ego_id, p.occurrence, p.heading_rad, p.straightest_rad, c.object_id, c.actor_class, c.pet_s, c.decel_mps2, c.t_object_in_ns,
        -- An actor of unknown class may be on foot or driven.
        may_walk(c.actor_class) AS is_on_foot,
        -- An actor into whose side the ego drove counts, too: the ego's front reached the actor's path before the actor's rear had passed.
        c.actor_class IS DISTINCT FROM 'pedestrian' AND c.t_ego_out_ns >= p.t_enter_ns AND e.t_ns <= p.t_leave_ns AND (c.ego_first OR coalesce(
            (e.x_m + e.length_m / 2 * cos(e.yaw_rad) - s.x_m) * cos(s.yaw_rad) + (e.y_m + e.length_m / 2 * sin(e.yaw_rad) - s.y_m) * sin(s.yaw_rad)
                + e.width_m / 2 * abs(sin(e.yaw_rad - s.yaw_rad)) > -s.length_m / 2,
            true
        )) AS is_driven,
        -- The object turns into the ego's road behind the ego, after a time that the rules find too short for crossing vehicles.
        coalesce(c.pet_s >= merging_s() AND c.pet_s < least_junction_s() AND abs(wrap_rad(b.yaw_rad - o.yaw_rad)) < pi() / 4, false) AS merges
    FROM passage p
    JOIN conflict c ON c.drive_id = p.drive_id AND c.ego_id = p.ego_id
    JOIN ego_state e ON e.drive_id = c.drive_id AND e.ego_id = c.ego_id AND e.t_ns = c.t_ego_in_ns
    ASOF LEFT JOIN state_dynamics s ON s.drive_id = c.drive_id AND s.actor_id = c.object_id AND s.t_ns <= c.t_ego_in_ns
    LEFT JOIN ego_state b ON b.drive_id = c.drive_id AND b.ego_id = c.ego_id AND b.t_ns = c.t_ego_out_ns
    LEFT JOIN state_dynamics o ON o.drive_id = c.drive_id AND o.actor_id = c.object_id AND o.t_ns = c.t_object_out_ns
    WHERE ((c.t_ego_out_ns >= p.t_enter_ns AND e.t_ns <= p.t_leave_ns)
            OR (may_walk(c.actor_class) AND e.travel_m <= p.travel_m + mouth_m() AND e.travel_m >= p.travel_in_m - mouth_m()))
        -- An actor that the ego drove into counts, too: it was still there.
        AND (c.ego_first OR c.pet_s < 0)
        AND c.actor_class IS DISTINCT FROM 'object'
),
-- The direction from which an actor came: its heading two seconds before it arrived, relative to the ego's heading at its entry.
approach AS (
    SELECT m.drive_id, m.ego_id, m.occurrence, m.object_id, m.t_object_in_ns, wrap_rad(min({'t_ns': s.t_ns, 'travel_rad': s.travel_rad}).travel_rad - m.heading_rad) AS from_rad
    FROM encounter m
    JOIN state_dynamics s ON s.drive_id = m.drive_id AND s.actor_id = m.object_id
        AND s.t_ns >= m.t_object_in_ns - 2_000_000_000 AND s.t_ns <= m.t_object_in_ns
    WHERE s.yaw_rad IS NOT NULL
    GROUP BY m.drive_id, m.ego_id, m.occurrence, m.object_id, m.t_object_in_ns, m.heading_rad
),
encounter_by_relation AS (
    SELECT drive_id, ego_id, occurrence, 'pedestrian' AS relation, object_id, actor_class, pet_s, decel_mps2, false AS merges FROM encounter WHERE is_on_foot
    UNION ALL
    SELECT m.drive_id, m.ego_id, m.occurrence, unnest(relations_of(c.from_rad, m.straightest_rad)), m.object_id, m.actor_class, m.pet_s, m.decel_mps2, m.merges
    FROM encounter m JOIN approach c USING (drive_id, ego_id, occurrence, object_id, t_object_in_ns)
    WHERE m.is_driven
),
nearest_encounter AS (
    SELECT
        drive_id, ego_id, occurrence, relation,
        min({'pet_s': pet_s, 'object_id': object_id, 'actor_class': actor_class, 'decel_mps2': decel_mps2}) FILTER (NOT merges OR relation <> 'oncoming') AS other,
        min({'pet_s': pet_s, 'object_id': object_id}) FILTER (merges AND relation = 'oncoming') AS merging
    FROM encounter_by_relation
    GROUP BY drive_id, ego_id, occurrence, relation
),
-- Actors that braked where their path led onto the ego's. Of each relation, one without another cause to brake comes first, then the
-- hardest braking.
braked_object AS (
    SELECT
        p.drive_id, p.ego_id, p.occurrence, f.object_id, f.pet_s, f.decel_mps2, f.other_cause,
        may_walk(f.actor_class) AS is_on_foot, f.actor_class IS DISTINCT FROM 'pedestrian' AND e.t_ns <= p.t_leave_ns AS is_driven,
        relations_of(wrap_rad(s.yaw_rad - p.heading_rad), p.straightest_rad) AS relations
    FROM passage p
    JOIN forced_braking f ON f.drive_id = p.drive_id AND f.ego_id = p.ego_id AND f.t_ego_out_ns >= p.t_enter_ns
    JOIN ego_state e ON e.drive_id = f.drive_id AND e.ego_id = f.ego_id AND e.t_ns = f.t_ego_in_ns
    JOIN state_dynamics s ON s.drive_id = f.drive_id AND s.actor_id = f.object_id AND s.t_ns = f.t_from_ns
    WHERE (e.t_ns <= p.t_leave_ns OR (f.actor_class IS NOT DISTINCT FROM 'pedestrian' AND e.travel_m <= p.travel_m + mouth_m()))
        AND f.actor_class IS DISTINCT FROM 'object' AND f.decel_mps2 > least_braking_mps2()
),
hardest_braking AS (
    SELECT
        drive_id, ego_id, occurrence, relation,
        min({
            'has_other_cause': other_cause IS NOT NULL, 'ease_mps2': -decel_mps2, 'pet_s': pet_s, 'object_id': object_id, 'decel_mps2': decel_mps2, 'other_cause': other_cause
        }) AS braking
    FROM (
        SELECT *, unnest(relations) AS relation FROM braked_object WHERE is_driven
        UNION ALL
        SELECT *, 'pedestrian' FROM braked_object WHERE is_on_foot
    )
    GROUP BY drive_id, ego_id, occurrence, relation
),
-- ---- reasons against "no other actor": actors that are present, but without a position, heading or size
incomplete_pair AS (
    SELECT
        drive_id, ego_id, t_ns, object_id, actor_class, x_m, y_m, x_m IS NULL OR y_m IS NULL AS has_no_position,
        CASE WHEN off_level THEN 'off_level' WHEN x_m IS NULL OR y_m IS NULL THEN 'no_position' WHEN yaw_rad IS NULL THEN 'no_heading' ELSE 'no_size' END AS lack
    FROM pair
    WHERE (x_m IS NULL OR y_m IS NULL OR yaw_rad IS NULL OR length_m IS NULL OR width_m IS NULL) AND actor_class IS DISTINCT FROM 'object'
),
unclear_object AS (
    SELECT p.drive_id, p.ego_id, p.occurrence, b.object_id, b.actor_class, min(b.lack) AS lack, p.x_m, p.y_m, p.t_enter_ns, p.t_leave_ns,
        count(*) FILTER (b.has_no_position) * any_value(c.period_ns) / 1e9 AS without_position_s
    FROM passage p
    JOIN clock c USING (drive_id, ego_id)
    JOIN incomplete_pair b ON b.drive_id = p.drive_id AND b.ego_id = p.ego_id AND b.t_ns <= p.t_leave_ns + conflict_ns()
        -- Before that, a pedestrian may have crossed the mouth of the road behind the ego.
        AND b.t_ns >= p.t_enter_ns - CASE WHEN may_walk(b.actor_class) THEN 2_000_000_000 ELSE 0 END
    GROUP BY p.drive_id, p.ego_id, p.occurrence, b.object_id, b.actor_class, p.x_m, p.y_m, p.t_enter_ns, p.t_leave_ns
),
-- An actor that is seen before or after at a place from which it cannot have come (at 30 m/s) is excluded.
unclear_object_near AS (
    SELECT u.drive_id, u.ego_id, u.occurrence, u.object_id, u.actor_class, u.lack
    FROM unclear_object u
    LEFT JOIN (
        SELECT u.drive_id, u.ego_id, u.occurrence, u.object_id, min(sqrt((o.x_m - u.x_m) ** 2 + (o.y_m - u.y_m) ** 2)) AS least_m
        FROM unclear_object u
        JOIN pair o ON o.drive_id = u.drive_id AND o.ego_id = u.ego_id AND o.object_id = u.object_id
            AND o.t_ns >= u.t_enter_ns - conflict_ns() AND o.t_ns <= u.t_leave_ns + conflict_ns()
        GROUP BY u.drive_id, u.ego_id, u.occurrence, u.object_id
    ) k USING (drive_id, ego_id, occurrence, object_id)
    WHERE k.least_m IS NULL OR k.least_m < meeting_near_m() + 30 * u.without_position_s
),
track AS (
    SELECT s.drive_id, s.actor_id, s.actor_class, min(s.t_ns) AS t_first_ns, max(s.t_ns) AS t_last_ns
    FROM state_dynamics s
    WHERE s.actor_class IS DISTINCT FROM 'object' AND s.x_m IS NOT NULL AND s.y_m IS NOT NULL
    GROUP BY s.drive_id, s.actor_id, s.actor_class
),
-- Actors whose track begins or ends while the ego passes the junction, or so soon before or after that they may have come.
-- broken_track_near selects those near the junction.
broken_track AS (
    SELECT p.drive_id, p.ego_id, p.occurrence, d.actor_id AS object_id, d.actor_class, v.lack, v.t_ns, p.x_m, p.y_m,
        -- Towards the junction (1) or away from it (-1), and how long that may have taken.
        2 * v.lost - 1 AS direction, (CASE v.lost WHEN 1 THEN p.t_leave_ns + watched_ns() - v.t_ns ELSE v.t_ns - p.t_enter_ns END) / 1e9 AS reach_s
    FROM passage p
    JOIN clock c USING (drive_id, ego_id)
    JOIN track d ON d.drive_id = p.drive_id AND d.actor_id <> p.ego_id
    CROSS JOIN LATERAL (VALUES ('appeared', d.t_first_ns, 0), ('lost', d.t_last_ns, 1)) AS v(lack, t_ns, lost)
    WHERE v.t_ns >= p.t_enter_ns - v.lost * conflict_ns() AND v.t_ns <= p.t_leave_ns + conflict_ns() AND v.t_ns > c.t_start_ns + c.max_gap_ns AND v.t_ns < c.t_end_ns - c.max_gap_ns
),
broken_track_near AS (
    SELECT b.drive_id, b.ego_id, b.occurrence, b.object_id, b.actor_class, b.lack
    FROM broken_track b
    JOIN state_dynamics s ON s.drive_id = b.drive_id AND s.actor_id = b.object_id AND s.t_ns = b.t_ns
    CROSS JOIN LATERAL (SELECT b.x_m - s.x_m AS dx, b.y_m - s.y_m AS dy) d
    WHERE coalesce(sqrt(dx ** 2 + dy ** 2) < CASE WHEN b.direction * (dx * s.vx_mps + dy * s.vy_mps) > 0
        THEN greatest(meeting_near_m(), s.speed_mps * b.reach_s) ELSE meeting_near_m() END, true)
),
-- Why it is not known whether another actor came, if the reason is the ego's own log or the sensor's range.
ego_log_reason AS (
    SELECT p.drive_id, p.ego_id, p.occurrence,
        CASE
            WHEN p.t_in_ns IS NULL THEN why('begins_in_junction')
            WHEN p.t_out_ns IS NULL THEN why('ends_in_junction')
            WHEN c.t_end_ns < p.t_leave_ns + watched_ns() THEN why('ends_after_junction')
            WHEN min(st.seg) < max(st.seg) THEN why('hole_after_junction')
            WHEN count(*) FILTER (s.t_ns <= p.t_leave_ns AND (s.x_m IS NULL OR s.y_m IS NULL OR s.yaw_rad IS NULL)) > 0 THEN why('ego_unplaced_in_junction')
            WHEN max(sqrt((s.x_m - p.x_m) ** 2 + (s.y_m - p.y_m) ** 2)) + 10 > g.sensor_range_m THEN why('sensors_short_of_junction')
        END AS reason
    FROM passage p
    JOIN clock c USING (drive_id, ego_id)
    JOIN data_log g USING (drive_id)
    JOIN ego_state s ON s.drive_id = p.drive_id AND s.ego_id = p.ego_id AND s.t_ns >= p.t_enter_ns AND s.t_ns <= p.t_leave_ns + watched_ns()
    JOIN step st ON st.drive_id = s.drive_id AND st.ego_id = s.ego_id AND st.t_ns = s.t_ns
    GROUP BY p.drive_id, p.ego_id, p.occurrence, p.t_in_ns, p.t_out_ns, p.t_leave_ns, c.t_end_ns, g.sensor_range_m
),
doubtful_object AS (
    SELECT drive_id, ego_id, occurrence, is_on_foot, min({'object_id': object_id, 'lack': lack}) AS other
    FROM (
        SELECT *, true AS is_on_foot FROM (FROM unclear_object_near UNION ALL FROM broken_track_near) WHERE may_walk(actor_class)
        UNION ALL
        SELECT *, false FROM (FROM unclear_object_near UNION ALL FROM broken_track_near) WHERE actor_class IS DISTINCT FROM 'pedestrian'
    )
    GROUP BY drive_id, ego_id, occurrence, is_on_foot
),
passage_relation AS (
    SELECT p.drive_id, p.ego_id, p.occurrence, v.relation, v.relation = 'pedestrian' AS is_on_foot
    FROM passage p CROSS JOIN (VALUES ('oncoming'), ('from_left'), ('from_right'), ('ahead_going'), ('pedestrian')) AS v(relation)
),
relation_result AS (
    SELECT
        a.drive_id, a.ego_id, a.occurrence, a.relation, h.braking,
        -- If one vehicle leaves enough time, another vehicle may still have left too little.
        CASE WHEN n.merging IS NULL OR n.other.pet_s < least_junction_s() THEN n.other END AS other,
        coalesce(o.reason, CASE WHEN d.other IS NOT NULL THEN why('actor_unplaced', d.other) WHEN n.merging IS NOT NULL THEN why('turns_in_behind', n.merging) END) AS reason
    FROM passage_relation a
    JOIN ego_log_reason o USING (drive_id, ego_id, occurrence)
    LEFT JOIN nearest_encounter n USING (drive_id, ego_id, occurrence, relation)
    LEFT JOIN hardest_braking h USING (drive_id, ego_id, occurrence, relation)
    LEFT JOIN doubtful_object d USING (drive_id, ego_id, occurrence, is_on_foot)
)
SELECT
    drive_id, ego_id, occurrence, relation, other.object_id AS object_id, other.actor_class AS actor_class,
    CASE WHEN other IS NOT NULL THEN other.pet_s WHEN reason IS NULL THEN 'inf'::DOUBLE END AS pet_s,
    CASE WHEN other IS NOT NULL THEN other.decel_mps2 WHEN reason IS NULL THEN 0.0 END AS decel_mps2,
    braking.object_id AS braked_id, braking.pet_s AS braked_pet_s, braking.decel_mps2 AS braked_mps2, braking.other_cause AS braked_cause,
    reason
FROM relation_result
