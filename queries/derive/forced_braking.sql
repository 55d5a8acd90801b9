-- Actors that braked on a way that led onto the ego's: at their speed before that, they would have come there within 4 s of the ego. Its
-- way is what it drove from there on, and straight on where that ends: it may have come late, or stopped and never come.
WITH
-- the only look at a large table: one difference between samples is enough to look closer
seed AS MATERIALIZED (
    SELECT drive_id, ego_id, object_id, t_ns FROM pair WHERE accel_mps2 < -least_force_mps2() AND distance_m < forced_near_m()
),
-- head on, it stands while the ego is out in its lane: however gently it braked before that, it may have waited
halted AS MATERIALIZED (
    SELECT p.drive_id, p.ego_id, p.object_id, x.t0_ns, min(p.t_ns) AS t_ns
    FROM excursion x
    JOIN pair p ON p.drive_id = x.drive_id AND p.ego_id = x.ego_id AND p.t_ns >= x.t0_ns AND p.t_ns <= coalesce(x.t_back_ns, x.t_end_ns)
    WHERE x.overtaking AND x.over_against IS DISTINCT FROM false
        AND abs(p.heading_diff_rad) >= head_on_rad() AND p.speed_mps <= standing_mps() AND p.distance_m < forced_near_m()
    GROUP BY ALL
),
near_seed AS (
    SELECT drive_id, object_id AS actor_id, t_ns // 1_000_000_000 + d.i AS second FROM seed CROSS JOIN (VALUES (-1), (0), (1)) AS d(i)
    UNION
    SELECT drive_id, object_id, t_ns // 1_000_000_000 - d.i FROM halted CROSS JOIN range(2 * conflict_ns() // 1_000_000_000) AS d(i)
),
-- the mean over the half second before each sample, or over one period where that is longer
easing AS MATERIALIZED (
    SELECT *, (before.speed_mps - speed_mps) / ((t_ns - before.t_ns) / 1e9) AS decel_mps2
    FROM (
        SELECT
            s.drive_id, s.actor_id AS object_id, s.t_ns, s.speed_mps,
            CASE WHEN s.t_ns > first_value(s.t_ns) OVER half THEN first_value({'t_ns': s.t_ns, 'speed_mps': s.speed_mps}) OVER half
                ELSE lag({'t_ns': s.t_ns, 'speed_mps': s.speed_mps}) OVER w END AS before
        FROM state_dynamics s
        SEMI JOIN near_seed n ON n.drive_id = s.drive_id AND n.actor_id = s.actor_id AND n.second = s.t_ns // 1_000_000_000
        WINDOW
            w AS (PARTITION BY s.drive_id, s.actor_id ORDER BY s.t_ns),
            half AS (PARTITION BY s.drive_id, s.actor_id ORDER BY s.t_ns RANGE BETWEEN 500_000_000 PRECEDING AND CURRENT ROW)
    )
    JOIN (SELECT drive_id, max(max_gap_ns) AS max_gap_ns FROM ego_clock GROUP BY drive_id) USING (drive_id)
    WHERE t_ns - before.t_ns BETWEEN 400_000_000 AND greatest(max_gap_ns, 500_000_000)
        AND (before.speed_mps - speed_mps) / ((t_ns - before.t_ns) / 1e9) > gentle_mps2()
),
slowing AS (
    SELECT e.*, false AS gentle FROM easing e WHERE e.decel_mps2 > least_force_mps2()
    UNION ALL
    SELECT e.*, true
    FROM easing e
    WHERE EXISTS (FROM halted h WHERE h.drive_id = e.drive_id AND h.object_id = e.object_id AND e.t_ns <= h.t_ns AND e.t_ns >= h.t_ns - 2 * conflict_ns())
),
stretch AS (
    SELECT
        drive_id, object_id, gentle, min(before).t_ns AS t_from_ns, min(before).speed_mps AS speed_mps, max(t_ns) AS t_to_ns,
        -- going on like this it would have stood after so many metres: what lies far beyond that it did not brake for
        min(before).speed_mps ** 2 * (max(t_ns) - min(before).t_ns) / 1e9 / (2 * (min(before).speed_mps - max({'t_ns': t_ns, 'speed_mps': speed_mps}).speed_mps))
            + forced_beyond_m() AS reach_m
    FROM (
        SELECT *, sum((t_ns - last_ns > 1_000_000_000)::INTEGER) OVER (PARTITION BY drive_id, object_id, gentle ORDER BY t_ns) AS n
        FROM (SELECT *, lag(t_ns, 1, t_ns) OVER (PARTITION BY drive_id, object_id, gentle ORDER BY t_ns) AS last_ns FROM slowing)
    )
    GROUP BY drive_id, object_id, gentle, n
),
-- a gentle braking that became a stronger one is that one
braking AS MATERIALIZED (
    FROM stretch b
    WHERE NOT b.gentle
        OR NOT EXISTS (FROM stretch o WHERE NOT o.gentle AND o.drive_id = b.drive_id AND o.object_id = b.object_id AND o.t_from_ns <= b.t_to_ns AND o.t_to_ns >= b.t_from_ns)
),
-- ---- its way
driven AS (
    SELECT *, of_pm(sum(whole_pm(step_m)) OVER (PARTITION BY drive_id, object_id, t_from_ns ORDER BY t_ns)) AS way_m
    FROM (
        SELECT
            b.drive_id, b.object_id, b.t_from_ns, b.speed_mps, b.reach_m, s.t_ns, s.x_m, s.y_m,
            -- an actor without heading or size may be a car that heads where it goes
            coalesce(s.yaw_rad, atan2(s.vy_mps, s.vx_mps)) AS yaw_rad, coalesce(s.length_m, 4.8) AS length_m, coalesce(s.width_m, 1.8) AS width_m,
            coalesce(s.travel_rad, atan2(s.vy_mps, s.vx_mps)) AS dir_rad,
            -- positions of who stands tremble
            CASE WHEN s.speed_mps > standing_mps() THEN coalesce(sqrt((s.x_m - lag(s.x_m) OVER w) ** 2 + (s.y_m - lag(s.y_m) OVER w) ** 2), 0.0) ELSE 0.0 END AS step_m
        FROM braking b
        JOIN state_dynamics s ON s.drive_id = b.drive_id AND s.actor_id = b.object_id AND s.t_ns >= b.t_from_ns AND s.t_ns <= b.t_from_ns + 2 * conflict_ns()
        WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL
        WINDOW w AS (PARTITION BY b.drive_id, b.object_id, b.t_from_ns ORDER BY s.t_ns)
    )
),
last_driven AS (
    SELECT drive_id, object_id, t_from_ns, max(way_m) AS way_m, max({'t_ns': t_ns, 'x_m': x_m, 'y_m': y_m, 'yaw_rad': yaw_rad, 'length_m': length_m, 'width_m': width_m}) AS p,
        -- a standing actor may face anywhere; its way is the one that it went last
        max({'t_ns': t_ns, 'dir_rad': dir_rad}) FILTER (step_m > 0).dir_rad AS dir_rad, any_value(speed_mps) AS speed_mps, any_value(reach_m) AS reach_m
    FROM driven
    GROUP BY drive_id, object_id, t_from_ns
),
course AS MATERIALIZED (
    SELECT *, t_from_ns + (1e9 * way_m / speed_mps)::BIGINT AS at_ns, greatest(length_m, gone_m) / 2 AS hl, width_m / 2 AS hw, cos(yaw_rad) AS c, sin(yaw_rad) AS s
    FROM (
        SELECT
            drive_id, object_id, t_from_ns, speed_mps, reach_m, t_ns, x_m, y_m, yaw_rad, dir_rad, length_m, width_m, way_m,
            way_m - lag(way_m, 1, way_m) OVER w AS gone_m,
            abs(wrap_rad(dir_rad - first_value(dir_rad) OVER five)) / nullif(way_m - first_value(way_m) OVER five, 0) AS curvature
        FROM (
            FROM driven
            WHERE way_m <= speed_mps * 2 * forced_apart_ns() / 1e9
            -- a point every two metres is enough
            QUALIFY floor(way_m / 2) IS DISTINCT FROM lag(floor(way_m / 2)) OVER (PARTITION BY drive_id, object_id, t_from_ns ORDER BY t_ns)
        )
        WINDOW
            w AS (PARTITION BY drive_id, object_id, t_from_ns ORDER BY t_ns),
            five AS (PARTITION BY drive_id, object_id, t_from_ns ORDER BY way_m RANGE BETWEEN 5 PRECEDING AND CURRENT ROW)
        UNION ALL
        SELECT
            drive_id, object_id, t_from_ns, speed_mps, reach_m, NULL, p.x_m + on_m * cos(dir_rad), p.y_m + on_m * sin(dir_rad), p.yaw_rad, dir_rad,
            p.length_m, p.width_m, way_m + on_m, 2.0, 0.0
        FROM (
            SELECT *, unnest(range(2, greatest(2, ceil(speed_mps * 2 * forced_apart_ns() / 1e9 - way_m)::BIGINT), 2))::DOUBLE AS on_m FROM last_driven WHERE dir_rad IS NOT NULL
        )
    )
),
-- boxes whose centres are not further apart than a cell is wide meet in one cell or in neighbours
scale AS (
    SELECT c.drive_id, max(c.hl) + max(c.hw) + any_value(g.reach_m) AS cell_m
    FROM course c
    JOIN (
        SELECT s.drive_id, max(swept_half_m(s.length_m, s.speed_mps, k.period_s)) + max(s.width_m) / 2 + hardly_room_m() AS reach_m
        FROM state_dynamics s
        JOIN (SELECT drive_id, max(period_ns) / 1e9 AS period_s FROM ego_clock GROUP BY drive_id) k USING (drive_id)
        SEMI JOIN braking b ON b.drive_id = s.drive_id
        GROUP BY s.drive_id
    ) g USING (drive_id)
    GROUP BY c.drive_id
),
-- a slot is as long as from the earliest to the latest that counts: that lies in two of them at most
reached AS MATERIALIZED (
    SELECT c.*, meeting_cell(c.x_m, c.y_m, g.cell_m) + cell_key(x.i, y.i) AS cell, forced_slot(c.at_ns + z.i * forced_apart_ns()) AS slot
    FROM course c
    JOIN scale g USING (drive_id)
    CROSS JOIN (VALUES (-1), (0), (1)) AS x(i) CROSS JOIN (VALUES (-1), (0), (1)) AS y(i) CROSS JOIN (VALUES (-1), (1)) AS z(i)
    WHERE z.i < 0 OR forced_slot(c.at_ns - forced_apart_ns()) < forced_slot(c.at_ns + forced_apart_ns())
),
box AS NOT MATERIALIZED (
    SELECT
        s.drive_id, s.actor_id, s.t_ns, s.x_m, s.y_m, meeting_cell(s.x_m, s.y_m, g.cell_m) AS cell, forced_slot(s.t_ns) AS slot,
        s.travel_rad AS dir_rad,
        swept_half_m(s.length_m, s.speed_mps, k.period_s) AS hl, s.width_m / 2 AS hw, cos(s.yaw_rad) AS c, sin(s.yaw_rad) AS s
    FROM state_dynamics s
    JOIN scale g USING (drive_id)
    JOIN (SELECT drive_id, max(period_ns) / 1e9 AS period_s FROM ego_clock GROUP BY drive_id) k USING (drive_id)
    WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL AND s.yaw_rad IS NOT NULL AND s.length_m IS NOT NULL AND s.width_m IS NOT NULL
),
-- the trailer that it draws is the ego
-- nobody drives on head on past an ego that is out in its lane with hardly any room, even if the two would just have missed each other
ego_box AS NOT MATERIALIZED (
    SELECT o.ego_id, b.*, b.hw + CASE WHEN x.t0_ns IS NULL THEN 0.0 ELSE hardly_room_m() END AS out_hw
    FROM box b
    JOIN ego_actor o USING (drive_id, actor_id)
    SEMI JOIN step s ON s.drive_id = b.drive_id AND s.ego_id = o.ego_id AND s.t_ns = b.t_ns
    LEFT JOIN (FROM excursion WHERE overtaking AND over_against IS DISTINCT FROM false) x
        ON x.drive_id = b.drive_id AND x.ego_id = o.ego_id AND b.t_ns >= x.t0_ns AND b.t_ns <= coalesce(x.t_back_ns, x.t_end_ns)
),
-- where it would have met the ego, at the speed that it had
met AS MATERIALIZED (
    SELECT
        r.drive_id, r.object_id, r.t_from_ns, b.ego_id, b.t_ns AS t1, r.at_ns AS t2, r.t_ns AS t_came_ns,
        (r.x_m - b.x_m) ** 2 + (r.y_m - b.y_m) ** 2 AS d2, wrap_rad(r.dir_rad - b.dir_rad) AS angle_rad
    FROM reached r
    JOIN (SELECT drive_id, object_id, t_from_ns, bool_and(gentle) AS gentle FROM braking GROUP BY ALL) g USING (drive_id, object_id, t_from_ns)
    JOIN ego_box b ON b.drive_id = r.drive_id AND b.cell = r.cell AND b.slot = r.slot AND b.ego_id <> r.object_id
    WHERE b.t_ns >= r.t_from_ns AND abs(b.t_ns - r.at_ns) <= forced_apart_ns() AND boxes_meet(
        r.x_m - b.x_m, r.y_m - b.y_m, b.c, b.s, r.c, r.s, b.hl, CASE WHEN NOT g.gentle AND abs(wrap_rad(r.dir_rad - b.dir_rad)) >= head_on_rad() THEN b.out_hw ELSE b.hw END, r.hl, r.hw
    )
),
-- as in conflict, what counts is the angle against the ego's way where that comes nearest; and only ground that the ego took first
taken AS (
    SELECT
        m.drive_id, m.ego_id, m.object_id, m.t_from_ns, m.t2, min(m.t1) FILTER (abs(m.angle_rad) > conflict_angle_rad()) AS t1_first,
        max(m.t1) FILTER (abs(m.angle_rad) > conflict_angle_rad()) AS t1_last, min({'d2': m.d2, 't1': m.t1, 'angle_rad': m.angle_rad}).angle_rad AS angle_rad
    FROM met m
    SEMI JOIN (SELECT drive_id, ego_id, object_id FROM seed UNION SELECT drive_id, ego_id, object_id FROM halted) s
        ON s.drive_id = m.drive_id AND s.ego_id = m.ego_id AND s.object_id = m.object_id
    WHERE coalesce(m.t1 < m.t_came_ns, true)
    GROUP BY m.drive_id, m.ego_id, m.object_id, m.t_from_ns, m.t2
    HAVING t1_first IS NOT NULL AND abs(min({'d2': m.d2, 't1': m.t1, 'angle_rad': m.angle_rad}).angle_rad) > conflict_angle_rad()
),
-- it stopped, as one does that waits for the ego to come out of its lane
stood AS (
    SELECT b.drive_id, b.object_id, b.t_from_ns, min(s.t_ns) AS t_stood_ns
    FROM braking b
    JOIN state_dynamics s ON s.drive_id = b.drive_id AND s.actor_id = b.object_id AND s.t_ns >= b.t_from_ns AND s.t_ns <= b.t_from_ns + 2 * conflict_ns()
    WHERE s.speed_mps <= standing_mps()
    GROUP BY b.drive_id, b.object_id, b.t_from_ns
),
led AS MATERIALIZED (
    SELECT
        t.drive_id, t.ego_id, t.object_id, t.t_from_ns, b.t_to_ns, b.speed_mps, b.reach_m, min(t.t1_first) AS t_ego_in_ns, max(t.t1_last) AS t_ego_out_ns,
        (greatest(min(t.t1_first), min(t.t2)) - least(max(t.t1_last), max(t.t2))) / 1e9 AS pet_s, min({'t2': t.t2, 'angle_rad': t.angle_rad}).angle_rad AS angle_rad,
        min(w.t_stood_ns) AS t_stood_ns
    FROM taken t
    JOIN braking b USING (drive_id, object_id, t_from_ns)
    LEFT JOIN stood w USING (drive_id, object_id, t_from_ns)
    GROUP BY t.drive_id, t.ego_id, t.object_id, t.t_from_ns, b.t_to_ns, b.speed_mps, b.reach_m, b.gentle
    HAVING NOT b.gentle AND t.t_from_ns >= min(t.t1_first) - forced_apart_ns()
        -- an oncoming driver sees the ego from afar, and stops before the ego is there
        OR min(w.t_stood_ns) <= CASE WHEN b.gentle THEN least(max(t.t1_last), b.t_to_ns + waits_ns()) ELSE max(t.t1_last) END
            AND abs(min({'t2': t.t2, 'angle_rad': t.angle_rad}).angle_rad) >= head_on_rad()
),
-- an actor that waited for the ego moves off when the ego has left, or a moment before. One that keeps standing has another reason
went_on AS (
    SELECT l.drive_id, l.ego_id, l.object_id, l.t_from_ns, min(s.t_ns) FILTER (s.speed_mps > moves_mps()) AS t_on_ns, max(s.t_ns) AS t_seen_ns
    FROM led l
    JOIN state_dynamics s ON s.drive_id = l.drive_id AND s.actor_id = l.object_id AND s.t_ns >= l.t_stood_ns AND s.t_ns <= l.t_ego_out_ns + goes_on_ns()
    WHERE l.t_stood_ns <= l.t_ego_out_ns AND s.speed_mps IS NOT NULL
    GROUP BY ALL
),
-- ---- what else it may have braked for
-- somebody before it, or across its way
behind AS (
    SELECT DISTINCT l.drive_id, l.ego_id, l.object_id, l.t_from_ns
    FROM led l
    JOIN reached r ON r.drive_id = l.drive_id AND r.object_id = l.object_id AND r.t_from_ns = l.t_from_ns AND r.way_m <= r.reach_m
    JOIN (SELECT b.* FROM box b SEMI JOIN led l ON l.drive_id = b.drive_id AND b.t_ns >= l.t_from_ns AND b.t_ns <= l.t_from_ns + 2 * conflict_ns()) b
        ON b.drive_id = r.drive_id AND b.cell = r.cell AND b.slot = r.slot AND b.actor_id <> l.object_id
    ANTI JOIN ego_actor o ON o.drive_id = l.drive_id AND o.ego_id = l.ego_id AND o.actor_id = b.actor_id
    WHERE b.t_ns >= r.t_from_ns AND abs(b.t_ns - r.at_ns) <= forced_apart_ns() / 2
        AND boxes_meet(r.x_m - b.x_m, r.y_m - b.y_m, b.c, b.s, r.c, r.s, b.hl, b.hw, r.hl, r.hw)
        AND (b.t_ns <= r.at_ns OR abs(wrap_rad(r.dir_rad - b.dir_rad)) > conflict_angle_rad())
),
-- a bend too tight for its speed
bend AS (SELECT DISTINCT drive_id, object_id, t_from_ns FROM course WHERE way_m <= reach_m AND speed_mps ** 2 * curvature > bend_mps2()),
-- a line, or a light that was not seen to be green
lane AS (
    SELECT b.drive_id, b.object_id, b.t_from_ns, b.t_to_ns, b.reach_m, g.environment_id, n.lanelet_id, -o.s_m AS from_m, n.length_m
    FROM braking b
    JOIN data_log g USING (drive_id)
    JOIN lane_occupancy o ON o.drive_id = b.drive_id AND o.actor_id = b.object_id AND o.t_ns = b.t_from_ns AND abs(o.heading_diff_rad) < pi() / 2
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
),
next_lane AS (
    SELECT l.* REPLACE (n.lanelet_id AS lanelet_id, l.from_m + l.length_m AS from_m, n.length_m AS length_m)
    FROM lane l
    JOIN lane_link k ON k.environment_id = l.environment_id AND k.from_id = l.lanelet_id
    JOIN lanelet n ON n.environment_id = l.environment_id AND n.lanelet_id = k.to_id
),
signed AS (
    SELECT DISTINCT l.drive_id, l.object_id, l.t_from_ns
    FROM (FROM lane UNION ALL FROM next_lane) l
    JOIN traffic_signal t ON t.environment_id = l.environment_id AND t.lanelet_id = l.lanelet_id AND t.kind IN ('traffic_light', 'stop', 'give_way')
    WHERE l.from_m + t.lane_s_m BETWEEN 0 AND l.reach_m
        AND NOT EXISTS (
            FROM signal_phase f
            WHERE f.drive_id = l.drive_id AND f.signal_id = t.signal_id AND f.state = 'green'
                AND f.t_from_ns <= l.t_from_ns AND coalesce(f.t_to_ns > l.t_to_ns, true)
        )
),
-- the ego had not begun: it was let go
let_go AS (
    SELECT l.drive_id, l.ego_id, l.object_id, l.t_from_ns
    FROM led l
    JOIN state_dynamics s ON s.drive_id = l.drive_id AND s.actor_id = l.ego_id AND s.t_ns >= l.t_from_ns AND s.t_ns <= l.t_from_ns + 500_000_000
    WHERE l.t_ego_in_ns > l.t_from_ns + 500_000_000
    GROUP BY ALL
    HAVING bool_and(s.speed_mps <= standing_mps())
),
-- braking of an actor whose heading or size is guessed is no ground for a fail
guessed AS (
    SELECT DISTINCT l.drive_id, l.object_id, l.t_from_ns
    FROM led l
    JOIN state_dynamics s ON s.drive_id = l.drive_id AND s.actor_id = l.object_id AND s.t_ns >= l.t_from_ns AND s.t_ns <= l.t_to_ns
    WHERE s.yaw_rad IS NULL OR s.length_m IS NULL OR s.width_m IS NULL
),
hardest AS (
    SELECT l.drive_id, l.ego_id, l.object_id, l.t_from_ns, max(s.decel_mps2) AS decel_mps2
    FROM led l
    JOIN slowing s ON s.drive_id = l.drive_id AND s.object_id = l.object_id AND s.t_ns >= l.t_from_ns AND s.t_ns <= least(l.t_to_ns, l.t_ego_out_ns)
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
        WHEN n.t_on_ns >= l.t_ego_out_ns - waits_ns() THEN true
        WHEN n.t_on_ns IS NULL AND n.t_seen_ns >= l.t_ego_out_ns + goes_on_ns() - c.max_gap_ns THEN false
    END AS waited
FROM led l
JOIN clock c USING (drive_id, ego_id)
JOIN hardest h USING (drive_id, ego_id, object_id, t_from_ns)
JOIN road_user a ON a.drive_id = l.drive_id AND a.actor_id = l.object_id
LEFT JOIN guessed u USING (drive_id, object_id, t_from_ns)
LEFT JOIN let_go g USING (drive_id, ego_id, object_id, t_from_ns)
LEFT JOIN behind w USING (drive_id, ego_id, object_id, t_from_ns)
LEFT JOIN signed s USING (drive_id, object_id, t_from_ns)
LEFT JOIN bend d USING (drive_id, object_id, t_from_ns)
LEFT JOIN went_on n USING (drive_id, ego_id, object_id, t_from_ns)
