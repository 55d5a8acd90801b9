-- Objects that brake on a path that leads onto the ego's path. At its speed before the braking, the object would have arrived there within
-- 4 s of the ego. The object's path is the one that it drives after the start of the braking, extended by a straight line: the object may
-- arrive late, or stop and never arrive.
-- lifetime: part
CREATE TABLE forced_braking (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- another actor that slowed by more than 1.5 m/s2 (mean over 0.5 s, or one period). Its path led at more than 20 degrees onto ground that the ego took first, see conflict. It began to brake at most 4 s before the ego was there; or earlier, if it came head on (within 30 degrees) and stood before the ego left (while the ego was out in the opposing lane, also after gentle braking). At its earlier speed it would have come there within 4 s of the ego, and within 8 s after it began to brake: on its driven path, and straight on from its end
    actor_class VARCHAR,              -- [actor_class] see actor {class}
    t_from_ns BIGINT NOT NULL,        -- time at which the object begins to brake {position}
    t_to_ns BIGINT NOT NULL,          -- last sample at which the object still brakes {position}
    t_ego_in_ns BIGINT NOT NULL,      -- first step of the ego on the common ground, from t_from_ns on {position}
    t_ego_out_ns BIGINT NOT NULL,     -- last step of the ego on it {position}
    speed_mps DOUBLE NOT NULL,        -- speed of the object at t_from_ns {velocity}
    decel_mps2 DOUBLE NOT NULL,       -- the object's strongest mean deceleration over 0.5 s (or one period) until the ego has left, and before an impact of the two {velocity}
    pet_s DOUBLE NOT NULL,            -- post-encroachment time that would have resulted at speed_mps; negative: both there at once {position, velocity}
    angle_rad DOUBLE NOT NULL,        -- the object's path relative to the ego's, where the object would first have reached it, see conflict {heading}
    other_cause VARCHAR,              -- [braking_cause] another possible cause of the braking; NULL: none is seen
    waited BOOLEAN                   -- the object stood before the ego left the common ground, and moved off (faster than 1.5 m/s) at most 2 s before or 5 s after that; false: it did not stand, or stayed; NULL: it moved off earlier, or its moving off was not seen {position, velocity}
);

INSERT INTO forced_braking BY NAME
WITH
-- First search in a large table: one hard deceleration between two samples is enough to look closer.
hard_braking AS MATERIALIZED (
    SELECT drive_id, ego_id, object_id, t_ns FROM pair WHERE accel_mps2 < -least_braking_mps2() AND distance_m < forced_near_m()
),
-- The object stands, head on to the ego, while the ego is out in the object's lane. It may have waited for the ego, even if it braked
-- gently before.
head_on_stop AS MATERIALIZED (
    SELECT p.drive_id, p.ego_id, p.object_id, x.t0_ns, min(p.t_ns) AS t_ns
    FROM excursion x
    JOIN pair p ON p.drive_id = x.drive_id AND p.ego_id = x.ego_id AND p.t_ns >= x.t0_ns AND p.t_ns <= coalesce(x.t_back_ns, x.t_end_ns)
    WHERE x.overtaking AND x.over_against IS DISTINCT FROM false
        AND abs(p.heading_diff_rad) >= head_on_rad() AND p.speed_mps <= standing_mps() AND p.distance_m < forced_near_m()
    GROUP BY ALL
),
clock_second_to_search AS (
    SELECT drive_id, object_id AS actor_id, t_ns // 1_000_000_000 + d.i AS second FROM hard_braking CROSS JOIN (VALUES (-1), (0), (1)) AS d(i)
    UNION
    SELECT drive_id, object_id, t_ns // 1_000_000_000 - d.i FROM head_on_stop CROSS JOIN range(2 * conflict_ns() // 1_000_000_000) AS d(i)
),
-- occasion: clock_second_to_search
-- Mean deceleration over the half second before each sample, or over one sample period if that is longer. If the periods do not add up to
-- half a second, it is over as many as fit. A window that the start of the track cuts off does not count.
slowing_sample AS MATERIALIZED (
    SELECT *, (earlier.speed_mps - speed_mps) / ((t_ns - earlier.t_ns) / 1e9) AS decel_mps2
    FROM (
        SELECT
            s.drive_id, s.actor_id AS object_id, s.t_ns, s.speed_mps,
            CASE WHEN s.t_ns > first_value(s.t_ns) OVER half_second THEN first_value({'t_ns': s.t_ns, 'speed_mps': s.speed_mps}) OVER half_second
                ELSE lag({'t_ns': s.t_ns, 'speed_mps': s.speed_mps}) OVER w END AS earlier
        FROM state_dynamics s
        SEMI JOIN clock_second_to_search n ON n.drive_id = s.drive_id AND n.actor_id = s.actor_id AND n.second = s.t_ns // 1_000_000_000
        WINDOW
            w AS (PARTITION BY s.drive_id, s.actor_id ORDER BY s.t_ns),
            half_second AS (PARTITION BY s.drive_id, s.actor_id ORDER BY s.t_ns RANGE BETWEEN 500_000_000 PRECEDING AND CURRENT ROW)
    )
    JOIN (SELECT drive_id, max(max_gap_ns) AS max_gap_ns, max(period_ns) AS period_ns FROM _ego_clock GROUP BY drive_id) USING (drive_id)
    WHERE t_ns - earlier.t_ns BETWEEN least(400_000_000, 500_000_000 - 1.1 * period_ns) AND greatest(max_gap_ns, 500_000_000)
        AND (earlier.speed_mps - speed_mps) / ((t_ns - earlier.t_ns) / 1e9) > gentle_mps2()
),
braking_sample AS (
    SELECT e.*, false AS is_gentle FROM slowing_sample e WHERE e.decel_mps2 > least_braking_mps2()
    UNION ALL
    SELECT e.*, true
    FROM slowing_sample e
    WHERE EXISTS (FROM head_on_stop h WHERE h.drive_id = e.drive_id AND h.object_id = e.object_id AND e.t_ns <= h.t_ns AND e.t_ns >= h.t_ns - 2 * conflict_ns())
),
braking_stretch AS (
    SELECT
        drive_id, object_id, is_gentle, min(earlier).t_ns AS t_from_ns, min(earlier).speed_mps AS speed_mps, max(t_ns) AS t_to_ns,
        -- With this deceleration, the object would have stopped within this distance. A cause far beyond this distance is excluded.
        min(earlier).speed_mps ** 2 * (max(t_ns) - min(earlier).t_ns) / 1e9 / (2 * (min(earlier).speed_mps - max({'t_ns': t_ns, 'speed_mps': speed_mps}).speed_mps))
            + stopping_before_m() AS reach_m
    FROM (
        SELECT *, sum((t_ns - previous_ns > 1_000_000_000)::INTEGER) OVER (PARTITION BY drive_id, object_id, is_gentle ORDER BY t_ns) AS n
        FROM (SELECT *, lag(t_ns, 1, t_ns) OVER (PARTITION BY drive_id, object_id, is_gentle ORDER BY t_ns) AS previous_ns FROM braking_sample)
    )
    GROUP BY drive_id, object_id, is_gentle, n
),
-- A gentle braking that becomes a stronger one counts only as the stronger one.
braking AS MATERIALIZED (
    FROM braking_stretch b
    WHERE NOT b.is_gentle
        OR NOT EXISTS (FROM braking_stretch o WHERE NOT o.is_gentle AND o.drive_id = b.drive_id AND o.object_id = b.object_id AND o.t_from_ns <= b.t_to_ns AND o.t_to_ns >= b.t_from_ns)
),
-- ---- the path of the object
driven_point AS (
    SELECT *, from_picometres(sum(to_picometres(step_m)) OVER (PARTITION BY drive_id, object_id, t_from_ns ORDER BY t_ns)) AS way_m
    FROM (
        SELECT
            b.drive_id, b.object_id, b.t_from_ns, b.speed_mps, b.reach_m, s.t_ns, s.x_m, s.y_m,
            -- An object without a heading or size may be a car that heads in its direction of motion.
            coalesce(s.yaw_rad, atan2(s.vy_mps, s.vx_mps)) AS yaw_rad, coalesce(s.length_m, 4.8) AS length_m, coalesce(s.width_m, 1.8) AS width_m,
            coalesce(s.travel_rad, atan2(s.vy_mps, s.vx_mps)) AS dir_rad,
            -- Recorded positions of a standing object jitter.
            CASE WHEN s.speed_mps > standing_mps() THEN coalesce(sqrt((s.x_m - lag(s.x_m) OVER w) ** 2 + (s.y_m - lag(s.y_m) OVER w) ** 2), 0.0) ELSE 0.0 END AS step_m
        FROM braking b
        JOIN state_dynamics s ON s.drive_id = b.drive_id AND s.actor_id = b.object_id AND s.t_ns >= b.t_from_ns AND s.t_ns <= b.t_from_ns + 2 * conflict_ns()
        WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL
        WINDOW w AS (PARTITION BY b.drive_id, b.object_id, b.t_from_ns ORDER BY s.t_ns)
    )
),
last_driven_point AS (
    SELECT drive_id, object_id, t_from_ns, max(way_m) AS way_m, max({'t_ns': t_ns, 'x_m': x_m, 'y_m': y_m, 'yaw_rad': yaw_rad, 'length_m': length_m, 'width_m': width_m}) AS p,
        -- A standing object may face in any direction. Its path goes on in the direction in which it moved last.
        max({'t_ns': t_ns, 'dir_rad': dir_rad}) FILTER (step_m > 0).dir_rad AS dir_rad, any_value(speed_mps) AS speed_mps, any_value(reach_m) AS reach_m
    FROM driven_point
    GROUP BY drive_id, object_id, t_from_ns
),
path_point AS MATERIALIZED (
    SELECT *, t_from_ns + (1e9 * way_m / speed_mps)::BIGINT AS t_expected_ns, greatest(length_m, advance_m) / 2 AS half_length_m, width_m / 2 AS half_width_m, cos(yaw_rad) AS c, sin(yaw_rad) AS s
    FROM (
        SELECT
            drive_id, object_id, t_from_ns, speed_mps, reach_m, t_ns, x_m, y_m, yaw_rad, dir_rad, length_m, width_m, way_m,
            way_m - lag(way_m, 1, way_m) OVER w AS advance_m,
            abs(wrap_rad(dir_rad - first_value(dir_rad) OVER five_metres)) / nullif(way_m - first_value(way_m) OVER five_metres, 0) AS curvature
        FROM (
            FROM driven_point
            WHERE way_m <= speed_mps * 2 * forced_apart_ns() / 1e9
            -- One point every two metres is enough.
            QUALIFY floor(way_m / 2) IS DISTINCT FROM lag(floor(way_m / 2)) OVER (PARTITION BY drive_id, object_id, t_from_ns ORDER BY t_ns)
        )
        WINDOW
            w AS (PARTITION BY drive_id, object_id, t_from_ns ORDER BY t_ns),
            five_metres AS (PARTITION BY drive_id, object_id, t_from_ns ORDER BY way_m RANGE BETWEEN 5 PRECEDING AND CURRENT ROW)
        UNION ALL
        SELECT
            drive_id, object_id, t_from_ns, speed_mps, reach_m, NULL, p.x_m + beyond_m * cos(dir_rad), p.y_m + beyond_m * sin(dir_rad), p.yaw_rad, dir_rad,
            p.length_m, p.width_m, way_m + beyond_m, 2.0, 0.0
        FROM (
            SELECT *, unnest(range(2, greatest(2, ceil(speed_mps * 2 * forced_apart_ns() / 1e9 - way_m)::BIGINT), 2))::DOUBLE AS beyond_m FROM last_driven_point WHERE dir_rad IS NOT NULL
        )
    )
),
-- A cell is as wide as the largest distance between the centres of two boxes that touch. Such centres lie in one cell or in neighbouring
-- cells.
grid_scale AS (
    SELECT c.drive_id, max(c.half_length_m) + max(c.half_width_m) + any_value(g.reach_m) AS cell_m
    FROM path_point c
    JOIN (
        SELECT s.drive_id, max(swept_half_m(s.length_m, s.speed_mps, k.period_s)) + max(s.width_m) / 2 + hardly_room_m() AS reach_m
        FROM state_dynamics s
        JOIN (SELECT drive_id, max(period_ns) / 1e9 AS period_s FROM _ego_clock GROUP BY drive_id) k USING (drive_id)
        SEMI JOIN braking b ON b.drive_id = s.drive_id
        GROUP BY s.drive_id
    ) g USING (drive_id)
    GROUP BY c.drive_id
),
-- A time slot is as long as the period from the earliest to the latest moment that counts. Such a period extends over two slots at most.
path_cell AS MATERIALIZED (
    SELECT
        c.*, meeting_cell(c.x_m, c.y_m, g.cell_m) + cell_key(x.i, y.i) AS cell,
        unnest(list_distinct([forced_slot(c.t_expected_ns - forced_apart_ns()), forced_slot(c.t_expected_ns + forced_apart_ns())])) AS slot
    FROM path_point c
    JOIN grid_scale g USING (drive_id)
    CROSS JOIN (VALUES (-1), (0), (1)) AS x(i) CROSS JOIN (VALUES (-1), (0), (1)) AS y(i)
),
box AS NOT MATERIALIZED (
    SELECT
        s.drive_id, s.actor_id, s.t_ns, s.x_m, s.y_m, meeting_cell(s.x_m, s.y_m, g.cell_m) AS cell, forced_slot(s.t_ns) AS slot,
        s.travel_rad AS dir_rad,
        swept_half_m(s.length_m, s.speed_mps, k.period_s) AS half_length_m, s.width_m / 2 AS half_width_m, cos(s.yaw_rad) AS c, sin(s.yaw_rad) AS s
    FROM state_dynamics s
    JOIN grid_scale g USING (drive_id)
    JOIN (SELECT drive_id, max(period_ns) / 1e9 AS period_s FROM _ego_clock GROUP BY drive_id) k USING (drive_id)
    WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL AND s.yaw_rad IS NOT NULL AND s.length_m IS NOT NULL AND s.width_m IS NOT NULL
),
-- The boxes of the ego and of the trailer that it tows. An oncoming driver also brakes if the ego is out in the driver's lane and leaves
-- hardly any room, so that the two would just miss each other.
ego_box AS NOT MATERIALIZED (
    SELECT o.ego_id, b.*, b.half_width_m + CASE WHEN x.t0_ns IS NULL THEN 0.0 ELSE hardly_room_m() END AS half_width_out_m
    FROM box b
    JOIN _ego_actor o USING (drive_id, actor_id)
    SEMI JOIN step s ON s.drive_id = b.drive_id AND s.ego_id = o.ego_id AND s.t_ns = b.t_ns
    LEFT JOIN (FROM excursion WHERE overtaking AND over_against IS DISTINCT FROM false) x
        ON x.drive_id = b.drive_id AND x.ego_id = o.ego_id AND b.t_ns >= x.t0_ns AND b.t_ns <= coalesce(x.t_back_ns, x.t_end_ns)
),
-- Where and when the object would have met the ego at its speed before the braking.
encounter AS MATERIALIZED (
    SELECT
        r.drive_id, r.object_id, r.t_from_ns, b.ego_id, b.t_ns AS t_ego_ns, r.t_expected_ns AS t_object_ns, r.t_ns AS t_actual_ns,
        (r.x_m - b.x_m) ** 2 + (r.y_m - b.y_m) ** 2 AS distance_m2, wrap_rad(r.dir_rad - b.dir_rad) AS angle_rad
    FROM path_cell r
    JOIN (SELECT drive_id, object_id, t_from_ns, bool_and(is_gentle) AS is_gentle FROM braking GROUP BY ALL) g USING (drive_id, object_id, t_from_ns)
    JOIN ego_box b ON b.drive_id = r.drive_id AND b.cell = r.cell AND b.slot = r.slot AND b.ego_id <> r.object_id
    WHERE b.t_ns >= r.t_from_ns AND abs(b.t_ns - r.t_expected_ns) <= forced_apart_ns() AND boxes_meet(
        r.x_m - b.x_m, r.y_m - b.y_m, b.c, b.s, r.c, r.s, b.half_length_m, CASE WHEN NOT g.is_gentle AND abs(wrap_rad(r.dir_rad - b.dir_rad)) >= head_on_rad() THEN b.half_width_out_m ELSE b.half_width_m END, r.half_length_m, r.half_width_m
    )
),
-- As in conflict, the angle is relative to the ego's path at its nearest point. Only ground that the ego takes first counts.
taken_ground AS (
    SELECT
        m.drive_id, m.ego_id, m.object_id, m.t_from_ns, m.t_object_ns, min(m.t_ego_ns) FILTER (abs(m.angle_rad) > conflict_angle_rad()) AS t_ego_first_ns,
        max(m.t_ego_ns) FILTER (abs(m.angle_rad) > conflict_angle_rad()) AS t_ego_last_ns, min({'distance_m2': m.distance_m2, 't_ego_ns': m.t_ego_ns, 'angle_rad': m.angle_rad}).angle_rad AS angle_rad
    FROM encounter m
    SEMI JOIN (SELECT drive_id, ego_id, object_id FROM hard_braking UNION SELECT drive_id, ego_id, object_id FROM head_on_stop) s
        ON s.drive_id = m.drive_id AND s.ego_id = m.ego_id AND s.object_id = m.object_id
    WHERE coalesce(m.t_ego_ns < m.t_actual_ns, true)
    GROUP BY m.drive_id, m.ego_id, m.object_id, m.t_from_ns, m.t_object_ns
    HAVING t_ego_first_ns IS NOT NULL AND abs(min({'distance_m2': m.distance_m2, 't_ego_ns': m.t_ego_ns, 'angle_rad': m.angle_rad}).angle_rad) > conflict_angle_rad()
),
-- The first stop of the object: an object that waits for the ego to leave its lane stops.
first_stop AS (
    SELECT b.drive_id, b.object_id, b.t_from_ns, min(s.t_ns) AS t_ns
    FROM braking b
    JOIN state_dynamics s ON s.drive_id = b.drive_id AND s.actor_id = b.object_id AND s.t_ns >= b.t_from_ns AND s.t_ns <= b.t_from_ns + 2 * conflict_ns()
    WHERE s.speed_mps <= standing_mps()
    GROUP BY b.drive_id, b.object_id, b.t_from_ns
),
braking_for_ego AS MATERIALIZED (
    SELECT
        t.drive_id, t.ego_id, t.object_id, t.t_from_ns, b.t_to_ns, b.speed_mps, b.reach_m, min(t.t_ego_first_ns) AS t_ego_in_ns, max(t.t_ego_last_ns) AS t_ego_out_ns,
        (greatest(min(t.t_ego_first_ns), min(t.t_object_ns)) - least(max(t.t_ego_last_ns), max(t.t_object_ns))) / 1e9 AS pet_s, min({'t_object_ns': t.t_object_ns, 'angle_rad': t.angle_rad}).angle_rad AS angle_rad,
        -- A stop after the impact is no stop by braking.
        min(w.t_ns) FILTER (coalesce(w.t_ns < i.t_ns, true)) AS t_stop_ns
    FROM taken_ground t
    JOIN braking b USING (drive_id, object_id, t_from_ns)
    LEFT JOIN impact i USING (drive_id, ego_id, object_id)
    LEFT JOIN first_stop w USING (drive_id, object_id, t_from_ns)
    GROUP BY t.drive_id, t.ego_id, t.object_id, t.t_from_ns, b.t_to_ns, b.speed_mps, b.reach_m, b.is_gentle
    HAVING NOT b.is_gentle AND t.t_from_ns >= min(t.t_ego_first_ns) - forced_apart_ns()
        -- An oncoming driver sees the ego from afar and stops before the ego is there.
        OR t_stop_ns <= CASE WHEN b.is_gentle THEN least(max(t.t_ego_last_ns), b.t_to_ns + waits_ns()) ELSE max(t.t_ego_last_ns) END
            AND abs(min({'t_object_ns': t.t_object_ns, 'angle_rad': t.angle_rad}).angle_rad) >= head_on_rad()
),
-- An object that waited for the ego moves off when the ego has left, or a moment before. An object that continues to stand has another
-- reason.
restart AS (
    SELECT l.drive_id, l.ego_id, l.object_id, l.t_from_ns, min(s.t_ns) FILTER (s.speed_mps > moves_mps()) AS t_restart_ns, max(s.t_ns) AS t_last_seen_ns
    FROM braking_for_ego l
    JOIN state_dynamics s ON s.drive_id = l.drive_id AND s.actor_id = l.object_id AND s.t_ns >= l.t_stop_ns AND s.t_ns <= l.t_ego_out_ns + drives_on_ns()
    WHERE l.t_stop_ns <= l.t_ego_out_ns AND s.speed_mps IS NOT NULL
    GROUP BY ALL
),
-- ---- other possible causes of the braking
-- Another actor ahead of the object, or across its path.
other_obstacle AS (
    SELECT DISTINCT l.drive_id, l.ego_id, l.object_id, l.t_from_ns
    FROM braking_for_ego l
    JOIN path_cell r ON r.drive_id = l.drive_id AND r.object_id = l.object_id AND r.t_from_ns = l.t_from_ns AND r.way_m <= r.reach_m
    JOIN (SELECT b.* FROM box b SEMI JOIN braking_for_ego l ON l.drive_id = b.drive_id AND b.t_ns >= l.t_from_ns AND b.t_ns <= l.t_from_ns + 2 * conflict_ns()) b
        ON b.drive_id = r.drive_id AND b.cell = r.cell AND b.slot = r.slot AND b.actor_id <> l.object_id
    ANTI JOIN _ego_actor o ON o.drive_id = l.drive_id AND o.ego_id = l.ego_id AND o.actor_id = b.actor_id
    WHERE b.t_ns >= r.t_from_ns AND abs(b.t_ns - r.t_expected_ns) <= forced_apart_ns() / 2
        AND boxes_meet(r.x_m - b.x_m, r.y_m - b.y_m, b.c, b.s, r.c, r.s, b.half_length_m, b.half_width_m, r.half_length_m, r.half_width_m)
        AND (b.t_ns <= r.t_expected_ns OR abs(wrap_rad(r.dir_rad - b.dir_rad)) > conflict_angle_rad())
),
-- A bend that is too tight for the speed of the object.
tight_bend AS (SELECT DISTINCT drive_id, object_id, t_from_ns FROM path_point WHERE way_m <= reach_m AND speed_mps ** 2 * curvature > bend_mps2()),
-- The lane of the object when it begins to brake.
braking_lane AS (
    SELECT b.drive_id, b.object_id, b.t_from_ns, b.t_to_ns, b.reach_m, g.environment_id, n.lanelet_id, -o.s_m AS lane_start_m, n.length_m
    FROM braking b
    JOIN data_log g USING (drive_id)
    JOIN lane_occupancy o ON o.drive_id = b.drive_id AND o.actor_id = b.object_id AND o.t_ns = b.t_from_ns AND abs(o.heading_diff_rad) < pi() / 2
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
),
next_lane AS (
    SELECT l.* REPLACE (n.lanelet_id AS lanelet_id, l.lane_start_m + l.length_m AS lane_start_m, n.length_m AS length_m)
    FROM braking_lane l
    JOIN lane_link k ON k.environment_id = l.environment_id AND k.from_id = l.lanelet_id
    JOIN lanelet n ON n.environment_id = l.environment_id AND n.lanelet_id = k.to_id
),
-- A stop sign, a give-way sign, or a traffic light that is not known to be green during the whole braking.
signal_ahead AS (
    SELECT DISTINCT l.drive_id, l.object_id, l.t_from_ns
    FROM (FROM braking_lane UNION ALL FROM next_lane) l
    JOIN traffic_signal t ON t.environment_id = l.environment_id AND t.lanelet_id = l.lanelet_id AND t.kind IN ('traffic_light', 'stop', 'give_way')
    WHERE l.lane_start_m + t.lane_s_m BETWEEN 0 AND l.reach_m
        AND NOT EXISTS (
            FROM _signal_phase f
            WHERE f.drive_id = l.drive_id AND f.signal_id = t.signal_id AND f.state = 'green'
                AND f.t_from_ns <= l.t_from_ns AND coalesce(f.t_to_ns > l.t_to_ns, true)
        )
),
-- The ego stands, and is not yet on the common ground, when the braking begins: the object lets the ego go first.
standing_ego AS (
    SELECT l.drive_id, l.ego_id, l.object_id, l.t_from_ns
    FROM braking_for_ego l
    JOIN state_dynamics s ON s.drive_id = l.drive_id AND s.actor_id = l.ego_id AND s.t_ns >= l.t_from_ns AND s.t_ns <= l.t_from_ns + 500_000_000
    WHERE l.t_ego_in_ns > l.t_from_ns + 500_000_000
    GROUP BY ALL
    HAVING bool_and(s.speed_mps <= standing_mps())
),
-- If the heading or size of the object is assumed, its braking must not lead to a fail.
incomplete_object AS (
    SELECT DISTINCT l.drive_id, l.object_id, l.t_from_ns
    FROM braking_for_ego l
    JOIN state_dynamics s ON s.drive_id = l.drive_id AND s.actor_id = l.object_id AND s.t_ns >= l.t_from_ns AND s.t_ns <= l.t_to_ns
    WHERE s.yaw_rad IS NULL OR s.length_m IS NULL OR s.width_m IS NULL
),
hardest_braking AS (
    SELECT l.drive_id, l.ego_id, l.object_id, l.t_from_ns, max(s.decel_mps2) AS decel_mps2
    FROM braking_for_ego l
    JOIN braking_sample s ON s.drive_id = l.drive_id AND s.object_id = l.object_id AND s.t_ns >= l.t_from_ns AND s.t_ns <= least(l.t_to_ns, l.t_ego_out_ns)
    LEFT JOIN impact i ON i.drive_id = l.drive_id AND i.ego_id = l.ego_id AND i.object_id = l.object_id
    WHERE coalesce(s.t_ns < i.t_ns, true)
    GROUP BY ALL
)
SELECT
    l.drive_id, l.ego_id, l.object_id, a.actor_class, l.t_from_ns, l.t_to_ns, l.t_ego_in_ns, l.t_ego_out_ns, l.speed_mps, h.decel_mps2, l.pet_s, l.angle_rad,
    CASE
        WHEN u.t_from_ns IS NOT NULL THEN 'incomplete'
        WHEN g.t_from_ns IS NOT NULL THEN 'let_go'
        WHEN w.t_from_ns IS NOT NULL THEN 'somebody_else'
        WHEN s.t_from_ns IS NOT NULL THEN 'signal'
        WHEN d.t_from_ns IS NOT NULL THEN 'bend'
    END AS other_cause,
    CASE
        WHEN n.t_from_ns IS NULL THEN false
        WHEN n.t_restart_ns >= l.t_ego_out_ns - waits_ns() THEN true
        WHEN n.t_restart_ns IS NULL AND n.t_last_seen_ns >= l.t_ego_out_ns + drives_on_ns() - c.max_gap_ns THEN false
    END AS waited
FROM braking_for_ego l
JOIN clock c USING (drive_id, ego_id)
JOIN hardest_braking h USING (drive_id, ego_id, object_id, t_from_ns)
JOIN road_user a ON a.drive_id = l.drive_id AND a.actor_id = l.object_id
LEFT JOIN incomplete_object u USING (drive_id, object_id, t_from_ns)
LEFT JOIN standing_ego g USING (drive_id, ego_id, object_id, t_from_ns)
LEFT JOIN other_obstacle w USING (drive_id, ego_id, object_id, t_from_ns)
LEFT JOIN signal_ahead s USING (drive_id, object_id, t_from_ns)
LEFT JOIN tight_bend d USING (drive_id, object_id, t_from_ns)
LEFT JOIN restart n USING (drive_id, ego_id, object_id, t_from_ns)
