-- Before whom the ego went through a junction, by where they came from; and whether nobody else can have come.
WITH passed AS (
    SELECT
        p.drive_id, p.ego_id, p.occurrence, p.t_in_ns, p.t_out_ns, coalesce(p.t_in_ns, p.t_first_ns) AS t_a_ns, coalesce(p.t_out_ns, p.t_last_ns) AS t_b_ns,
        a.yaw_rad AS heading_rad, p.straightest_rad, a.travel_m AS travel_in_m, b.travel_m, b.x_m, b.y_m
    FROM junction_passage p
    JOIN ego_state a ON a.drive_id = p.drive_id AND a.ego_id = p.ego_id AND a.t_ns = coalesce(p.t_in_ns, p.t_first_ns)
    JOIN ego_state b ON b.drive_id = p.drive_id AND b.ego_id = p.ego_id AND b.t_ns = p.t_last_ns
),
-- those who came to ground that the ego went over in the junction, people on foot up to 12 m before and beyond as well: the mouths of the roads
-- that it turns out of and into
met AS (
    SELECT
        p.drive_id, p.ego_id, p.occurrence, p.heading_rad, p.straightest_rad, c.object_id, c.actor_class, c.pet_s, c.decel_mps2, c.t_object_in_ns,
        -- who has no class may be either
        may_walk(c.actor_class) AS on_foot,
        -- and into whose side it drove: the ego's front came onto its way before its rear was past
        c.actor_class IS DISTINCT FROM 'pedestrian' AND c.t_ego_out_ns >= p.t_a_ns AND e.t_ns <= p.t_b_ns AND (c.ego_first OR coalesce(
            (e.x_m + e.length_m / 2 * cos(e.yaw_rad) - s.x_m) * cos(s.yaw_rad) + (e.y_m + e.length_m / 2 * sin(e.yaw_rad) - s.y_m) * sin(s.yaw_rad)
                + e.width_m / 2 * abs(sin(e.yaw_rad - s.yaw_rad)) > -s.length_m / 2,
            true
        )) AS driven
    FROM passed p
    JOIN conflict c ON c.drive_id = p.drive_id AND c.ego_id = p.ego_id
    JOIN ego_state e ON e.drive_id = c.drive_id AND e.ego_id = c.ego_id AND e.t_ns = c.t_ego_in_ns
    ASOF LEFT JOIN state_dynamics s ON s.drive_id = c.drive_id AND s.actor_id = c.object_id AND s.t_ns <= c.t_ego_in_ns
    WHERE ((c.t_ego_out_ns >= p.t_a_ns AND e.t_ns <= p.t_b_ns)
            OR (may_walk(c.actor_class) AND e.travel_m <= p.travel_m + mouth_m() AND e.travel_m >= p.travel_in_m - mouth_m()))
        -- and into whom it went: somebody still there
        AND (c.ego_first OR c.pet_s < 0)
        AND c.actor_class IS DISTINCT FROM 'object'
),
-- where they came from: their heading two seconds before they came, against the ego's on its way in
came AS (
    SELECT m.drive_id, m.ego_id, m.occurrence, m.object_id, m.t_object_in_ns, wrap_rad(min({'t_ns': s.t_ns, 'travel_rad': s.travel_rad}).travel_rad - m.heading_rad) AS from_rad
    FROM met m
    JOIN state_dynamics s ON s.drive_id = m.drive_id AND s.actor_id = m.object_id
        AND s.t_ns >= m.t_object_in_ns - 2_000_000_000 AND s.t_ns <= m.t_object_in_ns
    WHERE s.yaw_rad IS NOT NULL
    GROUP BY m.drive_id, m.ego_id, m.occurrence, m.object_id, m.t_object_in_ns, m.heading_rad
),
related AS (
    SELECT drive_id, ego_id, occurrence, 'pedestrian' AS relation, object_id, actor_class, pet_s, decel_mps2 FROM met WHERE on_foot
    UNION ALL
    SELECT m.drive_id, m.ego_id, m.occurrence, unnest(relations_of(c.from_rad, m.straightest_rad)), m.object_id, m.actor_class, m.pet_s, m.decel_mps2
    FROM met m JOIN came c USING (drive_id, ego_id, occurrence, object_id, t_object_in_ns)
    WHERE m.driven
),
nearest AS (
    SELECT drive_id, ego_id, occurrence, relation, min({'pet_s': pet_s, 'object_id': object_id, 'actor_class': actor_class, 'decel_mps2': decel_mps2}) AS who
    FROM related
    GROUP BY drive_id, ego_id, occurrence, relation
),
-- those who braked where their way led onto the ego's: of each relation the one with the least to have braked for otherwise
forced AS (
    SELECT
        p.drive_id, p.ego_id, p.occurrence, f.object_id, f.pet_s, f.decel_mps2, f.other_cause,
        may_walk(f.actor_class) AS on_foot, f.actor_class IS DISTINCT FROM 'pedestrian' AND e.t_ns <= p.t_b_ns AS driven,
        relations_of(wrap_rad(s.yaw_rad - p.heading_rad), p.straightest_rad) AS relations
    FROM passed p
    JOIN forced_braking f ON f.drive_id = p.drive_id AND f.ego_id = p.ego_id AND f.t_ego_out_ns >= p.t_a_ns
    JOIN ego_state e ON e.drive_id = f.drive_id AND e.ego_id = f.ego_id AND e.t_ns = f.t_ego_in_ns
    JOIN state_dynamics s ON s.drive_id = f.drive_id AND s.actor_id = f.object_id AND s.t_ns = f.t_from_ns
    WHERE (e.t_ns <= p.t_b_ns OR (f.actor_class IS NOT DISTINCT FROM 'pedestrian' AND e.travel_m <= p.travel_m + mouth_m()))
        AND f.actor_class IS DISTINCT FROM 'object' AND f.decel_mps2 > least_force_mps2()
),
hardest AS (
    SELECT
        drive_id, ego_id, occurrence, relation,
        min({
            'other': other_cause IS NOT NULL, 'ease_mps2': -decel_mps2, 'pet_s': pet_s, 'object_id': object_id, 'decel_mps2': decel_mps2, 'other_cause': other_cause
        }) AS braked
    FROM (
        SELECT *, unnest(relations) AS relation FROM forced WHERE driven
        UNION ALL
        SELECT *, 'pedestrian' FROM forced WHERE on_foot
    )
    GROUP BY drive_id, ego_id, occurrence, relation
),
-- ---- what stands against "nobody else": somebody present who cannot be compared
blind AS (
    SELECT
        drive_id, ego_id, t_ns, object_id, actor_class, x_m, y_m, x_m IS NULL OR y_m IS NULL AS nowhere,
        CASE WHEN off_level THEN 'may be over or under the road' WHEN x_m IS NULL OR y_m IS NULL THEN 'has no position' WHEN yaw_rad IS NULL THEN 'has no heading' ELSE 'has no size' END AS what
    FROM pair
    WHERE (x_m IS NULL OR y_m IS NULL OR yaw_rad IS NULL OR length_m IS NULL OR width_m IS NULL) AND actor_class IS DISTINCT FROM 'object'
),
unclear AS (
    SELECT p.drive_id, p.ego_id, p.occurrence, b.object_id, b.actor_class, min(b.what) AS what, p.x_m, p.y_m, p.t_a_ns, p.t_b_ns,
        count(*) FILTER (b.nowhere) * any_value(c.period_ns) / 1e9 AS nowhere_s
    FROM passed p
    JOIN clock c USING (drive_id, ego_id)
    JOIN blind b ON b.drive_id = p.drive_id AND b.ego_id = p.ego_id AND b.t_ns <= p.t_b_ns + conflict_ns()
        -- on foot it may have crossed the mouth behind the ego before that
        AND b.t_ns >= p.t_a_ns - CASE WHEN may_walk(b.actor_class) THEN 2_000_000_000 ELSE 0 END
    GROUP BY p.drive_id, p.ego_id, p.occurrence, b.object_id, b.actor_class, p.x_m, p.y_m, p.t_a_ns, p.t_b_ns
),
-- seen before or after at a place from which it cannot have come (30 m/s), it does not matter
unclear_near AS (
    SELECT u.drive_id, u.ego_id, u.occurrence, u.object_id, u.actor_class, u.what
    FROM unclear u
    LEFT JOIN (
        SELECT u.drive_id, u.ego_id, u.occurrence, u.object_id, min(sqrt((o.x_m - u.x_m) ** 2 + (o.y_m - u.y_m) ** 2)) AS least_m
        FROM unclear u
        JOIN pair o ON o.drive_id = u.drive_id AND o.ego_id = u.ego_id AND o.object_id = u.object_id
            AND o.t_ns >= u.t_a_ns - conflict_ns() AND o.t_ns <= u.t_b_ns + conflict_ns()
        GROUP BY u.drive_id, u.ego_id, u.occurrence, u.object_id
    ) k USING (drive_id, ego_id, occurrence, object_id)
    WHERE k.least_m IS NULL OR k.least_m < meeting_near_m() + 30 * u.nowhere_s
),
-- somebody whose track begins or ends there while the ego passes, or so soon before that he may have come
edge AS (
    SELECT s.drive_id, s.actor_id, s.actor_class, min(s.t_ns) AS t_first_ns, max(s.t_ns) AS t_last_ns
    FROM state_dynamics s
    WHERE s.actor_class IS DISTINCT FROM 'object' AND s.x_m IS NOT NULL AND s.y_m IS NOT NULL
    GROUP BY s.drive_id, s.actor_id, s.actor_class
),
broken AS (
    SELECT p.drive_id, p.ego_id, p.occurrence, d.actor_id AS object_id, d.actor_class, v.what, v.t_ns, p.x_m, p.y_m,
        -- towards the junction, or away from it, and in how long
        2 * v.lost - 1 AS sense, (CASE v.lost WHEN 1 THEN p.t_b_ns + watched_ns() - v.t_ns ELSE v.t_ns - p.t_a_ns END) / 1e9 AS reach_s
    FROM passed p
    JOIN clock c USING (drive_id, ego_id)
    JOIN edge d ON d.drive_id = p.drive_id AND d.actor_id <> p.ego_id
    CROSS JOIN LATERAL (VALUES (unplaced_words('appeared'), d.t_first_ns, 0), (unplaced_words('lost'), d.t_last_ns, 1)) AS v(what, t_ns, lost)
    WHERE v.t_ns >= p.t_a_ns - v.lost * conflict_ns() AND v.t_ns <= p.t_b_ns + conflict_ns() AND v.t_ns > c.t_start_ns + c.max_gap_ns AND v.t_ns < c.t_end_ns - c.max_gap_ns
),
broken_near AS (
    SELECT b.drive_id, b.ego_id, b.occurrence, b.object_id, b.actor_class, b.what
    FROM broken b
    JOIN state_dynamics s ON s.drive_id = b.drive_id AND s.actor_id = b.object_id AND s.t_ns = b.t_ns
    CROSS JOIN LATERAL (SELECT b.x_m - s.x_m AS dx, b.y_m - s.y_m AS dy) d
    WHERE coalesce(sqrt(dx ** 2 + dy ** 2) < CASE WHEN b.sense * (dx * s.vx_mps + dy * s.vy_mps) > 0
        THEN greatest(meeting_near_m(), s.speed_mps * b.reach_s) ELSE meeting_near_m() END, true)
),
-- the ego's own log, and how far it sees back
own AS (
    SELECT p.drive_id, p.ego_id, p.occurrence,
        CASE
            WHEN p.t_in_ns IS NULL THEN 'the log, or a hole in it, begins in the junction'
            WHEN p.t_out_ns IS NULL THEN 'the log, or a hole in it, ends in the junction'
            WHEN c.t_end_ns < p.t_b_ns + watched_ns() THEN 'the log ends too soon after the junction'
            WHEN min(st.seg) < max(st.seg) THEN 'there is a hole in the log soon after the junction'
            WHEN count(*) FILTER (s.t_ns <= p.t_b_ns AND (s.x_m IS NULL OR s.y_m IS NULL OR s.yaw_rad IS NULL)) > 0 THEN 'the ego has no position in the junction'
            WHEN max(sqrt((s.x_m - p.x_m) ** 2 + (s.y_m - p.y_m) ** 2)) + 10 > g.sensor_range_m THEN 'the sensor''s range ends too near to the junction'
        END AS reason
    FROM passed p
    JOIN clock c USING (drive_id, ego_id)
    JOIN data_log g USING (drive_id)
    JOIN ego_state s ON s.drive_id = p.drive_id AND s.ego_id = p.ego_id AND s.t_ns >= p.t_a_ns AND s.t_ns <= p.t_b_ns + watched_ns()
    JOIN step st ON st.drive_id = s.drive_id AND st.ego_id = s.ego_id AND st.t_ns = s.t_ns
    GROUP BY p.drive_id, p.ego_id, p.occurrence, p.t_in_ns, p.t_out_ns, p.t_b_ns, c.t_end_ns, g.sensor_range_m
),
doubt AS (
    SELECT drive_id, ego_id, occurrence, on_foot, min({'id': object_id, 'what': what}) AS who
    FROM (
        SELECT *, true AS on_foot FROM (FROM unclear_near UNION ALL FROM broken_near) WHERE may_walk(actor_class)
        UNION ALL
        SELECT *, false FROM (FROM unclear_near UNION ALL FROM broken_near) WHERE actor_class IS DISTINCT FROM 'pedestrian'
    )
    GROUP BY drive_id, ego_id, occurrence, on_foot
),
asked AS (
    SELECT p.drive_id, p.ego_id, p.occurrence, v.relation, v.relation = 'pedestrian' AS on_foot
    FROM passed p CROSS JOIN (VALUES ('oncoming'), ('from_left'), ('from_right'), ('ahead_going'), ('pedestrian')) AS v(relation)
),
answered AS (
    SELECT
        a.drive_id, a.ego_id, a.occurrence, a.relation, n.who, h.braked,
        coalesce(o.reason, 'actor ' || d.who.id || ' ' || d.who.what) AS reason
    FROM asked a
    JOIN own o USING (drive_id, ego_id, occurrence)
    LEFT JOIN nearest n USING (drive_id, ego_id, occurrence, relation)
    LEFT JOIN hardest h USING (drive_id, ego_id, occurrence, relation)
    LEFT JOIN doubt d USING (drive_id, ego_id, occurrence, on_foot)
)
SELECT
    drive_id, ego_id, occurrence, relation, who.object_id AS object_id, who.actor_class AS actor_class,
    CASE WHEN who IS NOT NULL THEN who.pet_s WHEN reason IS NULL THEN 'inf'::DOUBLE END AS pet_s,
    CASE WHEN who IS NOT NULL THEN who.decel_mps2 WHEN reason IS NULL THEN 0.0 END AS decel_mps2,
    braked.object_id AS braked_id, braked.pet_s AS braked_pet_s, braked.decel_mps2 AS braked_mps2, braked.other_cause AS braked_cause,
    reason
FROM answered
