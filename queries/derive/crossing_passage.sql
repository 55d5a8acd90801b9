-- The ego goes over a pedestrian crossing: when, and who was on its half, or stood at its end.
WITH placed AS (
    SELECT
        *, running AND front_m >= 0 AND ((rear_m < 0 AND NOT joined) OR front_before_m < 0) AS forwards,
        -- it comes back over the far edge
        coalesce(running AND joined AND rear_m < 0 AND rear_before_m >= 0 AND front_m >= 0 AND front_before_m >= 0, false) AS backwards
    FROM near_mark
    WHERE kind = 'crossing'
),
near AS (
    SELECT
        *, forwards OR backwards AS begins,
        count(*) FILTER (forwards OR backwards) OVER (PARTITION BY drive_id, ego_id, chain_id, mark_id, s_start_m ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS n
    FROM placed
),
-- what trembles at its edge has entered it once, see stop_line_crossing
back AS (
    SELECT drive_id, ego_id, chain_id, mark_id, s_start_m, n + 1 AS n, min(front_m) < -0.5 AS was_before, max(rear_m) > 0.5 AS was_past
    FROM near
    GROUP BY drive_id, ego_id, chain_id, mark_id, s_start_m, n
),
began AS (
    SELECT o.drive_id, o.ego_id, o.chain_id, o.mark_id, o.s_start_m, o.t_ns, o.seg, o.backwards,
        CASE WHEN o.joined AND (o.backwards OR o.front_before_m < 0) THEN o.t_ns END AS t_in_ns
    FROM near o
    LEFT JOIN back b USING (drive_id, ego_id, chain_id, mark_id, s_start_m, n)
    WHERE o.begins AND (o.n = 1 OR CASE WHEN o.backwards THEN b.was_past ELSE b.was_before END OR NOT o.joined)
),
bounded AS (
    SELECT *, lead(t_ns, 1, 9223372036854775807) OVER (PARTITION BY drive_id, ego_id, chain_id, mark_id, s_start_m ORDER BY t_ns) AS t_next_ns FROM began
),
passed AS (
    SELECT
        b.drive_id, b.ego_id, b.chain_id, b.mark_id, b.s_start_m, b.t_ns, b.t_in_ns, b.backwards,
        min(n.t_ns) FILTER ((n.rear_m >= 0 OR (b.backwards AND n.front_m < 0)) AND n.seg = b.seg) AS t_out_ns,
        max(n.t_ns) FILTER (n.rear_m < 0 AND NOT (b.backwards AND n.front_m < 0) AND n.seg = b.seg) AS t_last_ns
    FROM bounded b
    JOIN near n ON n.drive_id = b.drive_id AND n.ego_id = b.ego_id AND n.chain_id = b.chain_id AND n.mark_id = b.mark_id AND n.s_start_m = b.s_start_m
        AND n.t_ns >= b.t_ns AND n.t_ns < b.t_next_ns
    GROUP BY b.drive_id, b.ego_id, b.chain_id, b.mark_id, b.s_start_m, b.t_ns, b.t_in_ns, b.backwards
),
said AS (SELECT environment_id, crossing_id, min(kind) AS kind FROM crossing GROUP BY environment_id, crossing_id),
visit AS (
    SELECT
        p.*, g.environment_id, g.sensor_range_m, n.along_road, m.lanelet_id, m.s_end_m, m.control, m.signal_id, c.max_gap_ns, c.t_start_ns, c.t_end_ns,
        p.t_in_ns - 2_000_000_000 AS t_a_ns, coalesce(p.t_out_ns, p.t_last_ns, p.t_ns) AS t_b_ns, e.x_m, e.y_m
    FROM passed p
    JOIN data_log g USING (drive_id)
    JOIN clock c USING (drive_id, ego_id)
    JOIN way_mark m USING (drive_id, ego_id, chain_id, mark_id, s_start_m)
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = m.lanelet_id
    JOIN ego_state e ON e.drive_id = p.drive_id AND e.ego_id = p.ego_id AND e.t_ns = p.t_ns
    WHERE m.kind = 'crossing'
),
-- ---- on it, and at its end
-- the ego's middle on the other half, or only its side
other AS (
    SELECT
        v.drive_id, v.ego_id, v.mark_id, v.t_ns, -v.along_road AS along_road,
        bool_or(v.side * x.d_m - x.half_width_m > o.gap_m) AS driven,
        bool_or(coalesce(CASE v.side WHEN 1 THEN x.left_out_m ELSE x.right_out_m END > o.gap_m + over_boundary_m(), true)) AS reached
    FROM (FROM visit CROSS JOIN (VALUES (1), (-1)) AS b(side)) v
    JOIN (
        SELECT environment_id, lanelet_id, side, min(gap_m) AS gap_m FROM lane_beside WHERE against GROUP BY ALL
    ) o ON o.environment_id = v.environment_id AND o.lanelet_id = v.lanelet_id AND o.side = CASE v.side WHEN 1 THEN 'left' ELSE 'right' END
    JOIN ego_corridor x ON x.drive_id = v.drive_id AND x.ego_id = v.ego_id AND x.chain_id = v.chain_id
        AND x.t_ns >= coalesce(v.t_in_ns, v.t_ns) AND x.t_ns <= v.t_b_ns
    -- its middle past it, it may move over behind it
    WHERE x.s_m <= v.s_end_m OR x.t_ns = v.t_in_ns
    GROUP BY ALL
),
half AS (
    SELECT drive_id, ego_id, mark_id, t_ns, along_road FROM visit
    UNION SELECT drive_id, ego_id, mark_id, t_ns, along_road FROM other WHERE driven
),
occupied AS (
    SELECT
        v.drive_id, v.ego_id, v.mark_id, v.t_ns,
        min({'t_ns': o.t_from_ns, 'id': o.object_id}) FILTER (a.actor_class = 'pedestrian') AS who, bool_or(a.actor_class IS DISTINCT FROM 'pedestrian') AS classless
    FROM visit v
    JOIN half h USING (drive_id, ego_id, mark_id, t_ns)
    JOIN crossing_occupancy o ON o.drive_id = v.drive_id AND o.crossing_id = v.mark_id AND o.along_road = h.along_road AND o.object_id <> v.ego_id
        AND o.t_from_ns <= v.t_b_ns AND o.t_to_ns >= coalesce(v.t_in_ns, v.t_ns)
    JOIN road_user a ON a.drive_id = o.drive_id AND a.actor_id = o.object_id
    GROUP BY v.drive_id, v.ego_id, v.mark_id, v.t_ns
),
-- on the other half, and what becomes of them: who went straight on came to the ego's half, who had been there or left it there did not
beyond AS (
    SELECT
        v.drive_id, v.ego_id, v.mark_id, v.t_ns, o.object_id, a.actor_class, o.t_to_ns, v.t_end_ns - v.max_gap_ns AS t_seen_ns,
        min(q.t_from_ns) FILTER (q.t_from_ns > v.t_in_ns) AS t_next_ns, coalesce(bool_or(q.t_from_ns <= v.t_in_ns), false) AS came,
        coalesce(x.reached, false) AS reached
    FROM visit v
    LEFT JOIN other x ON x.drive_id = v.drive_id AND x.ego_id = v.ego_id AND x.mark_id = v.mark_id AND x.t_ns = v.t_ns
    JOIN crossing_occupancy o ON o.drive_id = v.drive_id AND o.crossing_id = v.mark_id AND o.along_road = -v.along_road AND o.object_id <> v.ego_id
        AND o.t_from_ns <= v.t_in_ns AND o.t_to_ns >= v.t_in_ns
    JOIN road_user a ON a.drive_id = o.drive_id AND a.actor_id = o.object_id
    LEFT JOIN crossing_occupancy q ON q.drive_id = o.drive_id AND q.crossing_id = o.crossing_id AND q.object_id = o.object_id AND q.along_road = v.along_road
    GROUP BY ALL
),
coming AS (
    SELECT drive_id, ego_id, mark_id, t_ns, min(object_id) FILTER (comes AND actor_class = 'pedestrian') AS coming_id,
        bool_and(comes IS NOT NULL AND NOT (comes AND actor_class IS DISTINCT FROM 'pedestrian')) AS known
    FROM (
        SELECT *, CASE WHEN t_next_ns - t_to_ns <= straight_on_ns() THEN true WHEN reached THEN NULL WHEN came OR t_to_ns < t_seen_ns THEN false END AS comes FROM beyond
    )
    GROUP BY drive_id, ego_id, mark_id, t_ns
),
-- the outer bound of the outermost of the half's lanes, where the crossing ends
outer_lane AS (
    SELECT x.environment_id, x.crossing_id, n.along_road, x.lanelet_id, x.s_start_m, x.s_end_m, v.handedness
    FROM crossing x
    JOIN environment v USING (environment_id)
    JOIN lanelet n USING (environment_id, lanelet_id)
    ANTI JOIN crossing y ON y.environment_id = x.environment_id AND y.crossing_id = x.crossing_id
        AND y.lanelet_id = CASE v.handedness WHEN 'lht' THEN n.left_id ELSE n.right_id END
),
kerb AS (
    SELECT
        o.environment_id, o.crossing_id, o.along_road, CASE o.handedness WHEN 'lht' THEN p.left_x_m ELSE p.right_x_m END AS x0,
        CASE o.handedness WHEN 'lht' THEN p.left_y_m ELSE p.right_y_m END AS y0, p.tx, p.ty, p.s_m, o.s_start_m, o.s_end_m
    FROM outer_lane o
    ASOF JOIN lane_point p ON p.environment_id = o.environment_id AND p.lanelet_id = o.lanelet_id AND p.s_m <= o.s_start_m
),
standing AS (
    SELECT v.drive_id, v.ego_id, v.mark_id, v.t_ns, v.t_in_ns, v.max_gap_ns, s.actor_id, s.actor_class, s.t_ns AS t_at_ns, s.speed_mps <= standing_mps() AS stands,
        min(end_distance_m(s.x_m, s.y_m, k.x0, k.y0, k.tx, k.ty, k.s_start_m - k.s_m, k.s_end_m - k.s_m)) AS off_m
    FROM visit v
    JOIN state_dynamics s ON s.drive_id = v.drive_id AND s.actor_id <> v.ego_id AND s.t_ns >= v.t_a_ns AND s.t_ns <= v.t_in_ns
    JOIN kerb k ON k.environment_id = v.environment_id AND k.crossing_id = v.mark_id AND k.along_road = v.along_road
    -- who is on it waits no more
    ANTI JOIN crossing_occupancy o ON o.drive_id = v.drive_id AND o.crossing_id = v.mark_id AND o.object_id = s.actor_id
        AND o.t_from_ns <= v.t_in_ns AND o.t_to_ns >= v.t_a_ns
    WHERE may_walk(s.actor_class)
    GROUP BY ALL
),
waiting AS (
    SELECT drive_id, ego_id, mark_id, t_ns, min(actor_id) FILTER (actor_class = 'pedestrian') AS waiting_id, bool_and(actor_class IS NOT NULL) AS known
    FROM (
        SELECT drive_id, ego_id, mark_id, t_ns, actor_id, actor_class
        FROM standing
        GROUP BY drive_id, ego_id, mark_id, t_ns, t_in_ns, max_gap_ns, actor_id, actor_class
        HAVING bool_and(coalesce(stands AND off_m <= 2, false)) AND min(t_at_ns) <= t_in_ns - 2_000_000_000 + max_gap_ns AND max(t_at_ns) >= t_in_ns - max_gap_ns
    )
    GROUP BY drive_id, ego_id, mark_id, t_ns
),
-- ---- whether nobody else can have been there
blind AS (
    SELECT v.drive_id, v.ego_id, v.mark_id, v.t_ns, o.object_id, v.x_m, v.y_m, v.t_a_ns, v.t_b_ns,
        CASE WHEN o.actor_class IS NULL THEN 30.0 ELSE 3.0 END * count(*) * any_value(c.period_ns) / 1e9 AS reach_m
    FROM visit v
    JOIN clock c USING (drive_id, ego_id)
    JOIN (FROM pair WHERE (x_m IS NULL OR y_m IS NULL) AND may_walk(actor_class)) o
        ON o.drive_id = v.drive_id AND o.ego_id = v.ego_id AND o.t_ns >= v.t_a_ns AND o.t_ns <= v.t_b_ns
    GROUP BY v.drive_id, v.ego_id, v.mark_id, v.t_ns, o.object_id, o.actor_class, v.x_m, v.y_m, v.t_a_ns, v.t_b_ns
),
blind_near AS (
    SELECT b.drive_id, b.ego_id, b.mark_id, b.t_ns
    FROM blind b
    LEFT JOIN (
        SELECT b.drive_id, b.ego_id, b.mark_id, b.t_ns, b.object_id, min(sqrt((o.x_m - b.x_m) ** 2 + (o.y_m - b.y_m) ** 2)) AS least_m
        FROM blind b
        JOIN pair o ON o.drive_id = b.drive_id AND o.ego_id = b.ego_id AND o.object_id = b.object_id
            AND o.t_ns >= b.t_a_ns - conflict_ns() AND o.t_ns <= b.t_b_ns + conflict_ns()
        GROUP BY b.drive_id, b.ego_id, b.mark_id, b.t_ns, b.object_id
    ) k USING (drive_id, ego_id, mark_id, t_ns, object_id)
    WHERE k.least_m IS NULL OR k.least_m < meeting_near_m() + b.reach_m
),
-- tracks that begin or end (a jump ends one as well), by their first and last places
edge AS (
    SELECT s.drive_id, s.actor_id, min(s.t_ns) AS t_first_ns, max(s.t_ns) AS t_last_ns
    FROM state_dynamics s
    WHERE may_walk(s.actor_class) AND s.x_m IS NOT NULL AND s.y_m IS NOT NULL
    GROUP BY s.drive_id, s.actor_id
),
broken AS (
    SELECT v.drive_id, v.ego_id, v.mark_id, v.t_ns
    FROM visit v
    JOIN clock c USING (drive_id, ego_id)
    JOIN edge d ON d.drive_id = v.drive_id AND d.actor_id <> v.ego_id
    CROSS JOIN LATERAL (
        VALUES (d.t_first_ns, greatest(0, d.t_first_ns - v.t_b_ns), d.t_first_ns - v.t_a_ns), (d.t_last_ns, greatest(0, v.t_a_ns - d.t_last_ns), v.t_b_ns - d.t_last_ns)
    ) AS w(t_at_ns, apart_ns, walk_ns)
    JOIN state_dynamics s ON s.drive_id = v.drive_id AND s.actor_id = d.actor_id AND s.t_ns = w.t_at_ns
    WHERE w.walk_ns >= 0 AND w.apart_ns <= conflict_ns() AND w.t_at_ns > c.t_start_ns + c.max_gap_ns AND w.t_at_ns < c.t_end_ns - c.max_gap_ns
        -- seen while the ego passed: near is near enough; before or after it: as far as it walks until then
        AND sqrt((s.x_m - v.x_m) ** 2 + (s.y_m - v.y_m) ** 2)
            < CASE WHEN w.apart_ns = 0 THEN meeting_near_m() ELSE greatest(5.0, 3.0 * w.walk_ns / 1e9) END
),
holed AS (
    SELECT v.drive_id, v.ego_id, v.mark_id, v.t_ns
    FROM visit v JOIN step st ON st.drive_id = v.drive_id AND st.ego_id = v.ego_id AND st.t_ns >= v.t_a_ns AND st.t_ns <= v.t_b_ns
    GROUP BY v.drive_id, v.ego_id, v.mark_id, v.t_ns
    HAVING min(st.seg) < max(st.seg)
),
unknown AS (
    SELECT drive_id, ego_id, mark_id, t_ns FROM blind_near
    UNION SELECT drive_id, ego_id, mark_id, t_ns FROM broken
    UNION SELECT drive_id, ego_id, mark_id, t_ns FROM holed
    UNION SELECT drive_id, ego_id, mark_id, t_ns FROM occupied WHERE classless
    UNION SELECT drive_id, ego_id, mark_id, t_ns FROM visit WHERE t_in_ns IS NULL OR t_out_ns IS NULL OR t_start_ns > t_a_ns OR sensor_range_m < 20
),
-- ---- it stood before it
halted AS (
    SELECT
        v.drive_id, v.ego_id, v.mark_id, v.t_ns,
        CASE
            WHEN bool_or(e.speed_mps <= stood_mps() AND n.front_m >= -5) THEN true
            WHEN bool_or(e.speed_mps IS NULL AND n.front_m >= -5) THEN NULL
            WHEN bool_or(n.front_m < -5) OR min(n.t_ns) <= v.t_in_ns - 10_000_000_000 + v.max_gap_ns THEN false
        END AS stood_before
    FROM visit v
    JOIN near n ON n.drive_id = v.drive_id AND n.ego_id = v.ego_id AND n.chain_id = v.chain_id AND n.mark_id = v.mark_id AND n.s_start_m = v.s_start_m
        AND n.t_ns < v.t_in_ns AND n.t_ns >= v.t_in_ns - 10_000_000_000
    JOIN ego_state e ON e.drive_id = n.drive_id AND e.ego_id = n.ego_id AND e.t_ns = n.t_ns
    WHERE n.front_m < 0 AND NOT v.backwards
    GROUP BY v.drive_id, v.ego_id, v.mark_id, v.t_ns, v.t_in_ns, v.max_gap_ns
),
lit AS (
    SELECT v.drive_id, v.ego_id, v.mark_id, v.t_ns, f.state
    FROM visit v
    JOIN mark_phase f USING (drive_id, ego_id, chain_id, mark_id, s_start_m)
    WHERE f.kind = 'crossing' AND f.t_from_ns <= v.t_in_ns AND v.t_in_ns < coalesce(f.t_to_ns, v.t_in_ns + 1)
)
SELECT
    v.drive_id, v.ego_id, (row_number() OVER (PARTITION BY v.drive_id, v.ego_id ORDER BY v.t_ns, v.mark_id) - 1)::INTEGER AS occurrence,
    v.mark_id AS crossing_id, coalesce(s.kind, CASE WHEN v.signal_id IS NOT NULL THEN 'signalled' END) AS kind,
    v.t_in_ns, CASE WHEN v.t_last_ns IS NOT NULL OR v.t_in_ns IS NOT NULL THEN v.t_out_ns END AS t_out_ns,
    o.who.id AS on_id, o.who.t_ns AS t_on_ns, f.coming_id, coalesce(f.known, true) AS coming_known, w.waiting_id, coalesce(w.known, true) AS waiting_known, u.t_ns IS NULL AS known,
    v.signal_id, l.state, h.stood_before
FROM visit v
LEFT JOIN said s ON s.environment_id = v.environment_id AND s.crossing_id = v.mark_id
LEFT JOIN occupied o USING (drive_id, ego_id, mark_id, t_ns)
LEFT JOIN waiting w USING (drive_id, ego_id, mark_id, t_ns)
LEFT JOIN coming f USING (drive_id, ego_id, mark_id, t_ns)
LEFT JOIN unknown u USING (drive_id, ego_id, mark_id, t_ns)
LEFT JOIN halted h USING (drive_id, ego_id, mark_id, t_ns)
LEFT JOIN lit l USING (drive_id, ego_id, mark_id, t_ns)
