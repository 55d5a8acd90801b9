-- Where an overtake begins and ends, and who comes up from behind when it begins.
WITH gone AS (
    SELECT
        o.drive_id, o.ego_id, o.occurrence, o.chain_id, o.side, o.vbp_id, o.passed, o.t0_ns, o.t3_ns, o.t_end_ns, g.environment_id, e.s_m, e.front_s_m, e.rear_s_m, e.speed_mps
    FROM overtake o
    JOIN data_log g USING (drive_id)
    JOIN ego_state e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.t_ns = o.t0_ns
),
-- two roads that meet in a junction are one for a driver
roads AS (
    SELECT environment_id, junction_id, count(DISTINCT coalesce(h.of_road_id, r.road_id)) AS n
    FROM (
        SELECT l.environment_id, a.junction_id, b.road_id
        FROM lane_link l
        JOIN lanelet a ON a.environment_id = l.environment_id AND a.lanelet_id = l.from_id
        JOIN lanelet b ON b.environment_id = l.environment_id AND b.lanelet_id = l.to_id
        WHERE a.junction_id IS NOT NULL AND b.junction_id IS NULL
        UNION ALL
        SELECT l.environment_id, b.junction_id, a.road_id
        FROM lane_link l
        JOIN lanelet a ON a.environment_id = l.environment_id AND a.lanelet_id = l.from_id
        JOIN lanelet b ON b.environment_id = l.environment_id AND b.lanelet_id = l.to_id
        WHERE b.junction_id IS NOT NULL AND a.junction_id IS NULL
    ) r
    LEFT JOIN road_half h USING (environment_id, road_id)
    GROUP BY ALL
),
way AS (
    SELECT g.drive_id, g.ego_id, g.occurrence, g.environment_id, g.front_s_m, g.rear_s_m, c.lanelet_id, c.s_start_m, c.length_m
    FROM gone g
    JOIN chain c USING (drive_id, ego_id, chain_id)
),
junction AS (
    SELECT w.drive_id, w.ego_id, w.occurrence, min(w.s_start_m - w.front_s_m) AS m
    FROM way w
    JOIN lanelet n ON n.environment_id = w.environment_id AND n.lanelet_id = w.lanelet_id
    JOIN roads r ON r.environment_id = n.environment_id AND r.junction_id = n.junction_id
    WHERE w.s_start_m + w.length_m > w.rear_s_m AND r.n > 2
    GROUP BY ALL
),
crossed AS (
    SELECT w.drive_id, w.ego_id, w.occurrence, min(w.s_start_m + x.s_start_m - w.front_s_m) AS m
    FROM way w
    JOIN crossing x ON x.environment_id = w.environment_id AND x.lanelet_id = w.lanelet_id
    WHERE w.s_start_m + x.s_end_m > w.rear_s_m
    GROUP BY ALL
),
-- where the ego's front is at t0, and later where it draws level with the vehicle that it passes
front AS (
    SELECT drive_id, ego_id, occurrence, false AS level, front_s_m FROM gone
    UNION ALL
    SELECT l.drive_id, l.ego_id, l.occurrence, true, x.front_s_m
    FROM (
        SELECT g.drive_id, g.ego_id, g.occurrence, g.chain_id, min(e.t_ns) AS t_ns
        FROM gone g
        JOIN ego_state e ON e.drive_id = g.drive_id AND e.ego_id = g.ego_id AND e.t_ns >= g.t0_ns AND e.t_ns <= g.t_end_ns
        JOIN pair p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.t_ns = e.t_ns AND p.object_id = g.vbp_id
        WHERE g.passed AND e.front_s_m > coalesce(p.rear_s_m, p.s_m)
        GROUP BY ALL
    ) l
    JOIN ego_corridor x ON x.drive_id = l.drive_id AND x.ego_id = l.ego_id AND x.chain_id = l.chain_id AND x.t_ns = l.t_ns
),
-- the last word before the ego: a sign holds until its end is said, or until the next junction. Where there is none, one may stand further
-- back than the corridor reaches, or where the map begins.
sign AS (
    SELECT w.drive_id, w.ego_id, w.occurrence, f.level, max({'s_m': w.s_m, 'holds': w.holds}).holds AS holds
    FROM (
        SELECT w.drive_id, w.ego_id, w.occurrence, w.s_start_m + t.lane_s_m AS s_m, t.kind = 'no_overtaking' AS holds
        FROM way w
        JOIN traffic_signal t ON t.environment_id = w.environment_id AND t.lanelet_id = w.lanelet_id
        WHERE t.kind IN ('no_overtaking', 'no_overtaking_end')
        UNION ALL
        SELECT w.drive_id, w.ego_id, w.occurrence, w.s_start_m + w.length_m, false
        FROM way w
        JOIN lanelet n ON n.environment_id = w.environment_id AND n.lanelet_id = w.lanelet_id
        JOIN roads r ON r.environment_id = n.environment_id AND r.junction_id = n.junction_id
        WHERE r.n > 2
    ) w
    JOIN front f ON f.drive_id = w.drive_id AND f.ego_id = w.ego_id AND f.occurrence = w.occurrence AND w.s_m <= f.front_s_m
    GROUP BY ALL
),
signed AS (SELECT DISTINCT environment_id FROM traffic_signal WHERE kind IN ('no_overtaking', 'no_overtaking_end')),
-- the running lane's own boundary on the overtaking side, when it is left and when it is come back over
line AS (
    SELECT g.drive_id, g.ego_id, g.occurrence, v.back, min(b.marking) AS marking
    FROM gone g
    CROSS JOIN (VALUES (false), (true)) AS v(back)
    JOIN ego_corridor x ON x.drive_id = g.drive_id AND x.ego_id = g.ego_id AND x.chain_id = g.chain_id
        AND x.t_ns = CASE WHEN v.back THEN g.t3_ns ELSE g.t0_ns END
    JOIN chain c ON c.drive_id = g.drive_id AND c.ego_id = g.ego_id AND c.chain_id = g.chain_id
        AND c.s_start_m <= x.s_m AND x.s_m < c.s_start_m + c.length_m
    JOIN lane_boundary b ON b.environment_id = g.environment_id AND b.lanelet_id = c.lanelet_id
        AND b.side = CASE g.side WHEN 1 THEN 'left' ELSE 'right' END
        AND b.s_start_m <= x.s_m - c.s_start_m AND x.s_m - c.s_start_m < b.s_end_m
    GROUP BY ALL
),
-- how fast everybody was just before, as far as it is known: who comes up in the overtaking lane may have begun to brake as the ego began to
-- move over
before AS (
    SELECT g.drive_id, g.ego_id, g.occurrence, p.object_id, max(p.speed_mps) AS fastest_mps, count(p.speed_mps) = count(*) AS whole
    FROM gone g
    JOIN pair p ON p.drive_id = g.drive_id AND p.ego_id = g.ego_id AND p.t_ns >= g.t0_ns - braked_for_ns() AND p.t_ns <= g.t0_ns
    GROUP BY ALL
),
-- in the overtaking lane, or in the running one and moving over at more than 0.3 m/s. As long as some of it is beside the ego it is not yet
-- past; but one whose middle is ahead is one that the ego passes, or drives beside, unless it is faster.
rear AS (
    SELECT
        g.drive_id, g.ego_id, g.occurrence,
        min({
            'ttc_s': CASE
                WHEN p.front_s_m >= g.rear_s_m THEN 0.0::DOUBLE
                WHEN p.speed_mps IS NULL THEN NULL
                WHEN f.fastest_mps > g.speed_mps THEN (g.rear_s_m - p.front_s_m) / (f.fastest_mps - g.speed_mps)
                WHEN f.fastest_mps <= g.speed_mps AND f.whole THEN 'infinity'::DOUBLE
            END,
            'gap_m': g.rear_s_m - p.front_s_m, 'object_id': p.object_id
        }) FILTER (is_vehicle(p.actor_class)) AS o,
        bool_and((f.whole OR p.front_s_m >= g.rear_s_m) AND is_vehicle(p.actor_class) IS NOT NULL) AS known
    FROM gone g
    JOIN pair p ON p.drive_id = g.drive_id AND p.ego_id = g.ego_id AND p.t_ns = g.t0_ns
    JOIN before f ON f.drive_id = g.drive_id AND f.ego_id = g.ego_id AND f.occurrence = g.occurrence AND f.object_id = p.object_id
    WHERE may_be_vehicle(p.actor_class) AND p.rear_s_m <= g.front_s_m AND abs(p.heading_diff_rad) < pi() / 2 AND g.rear_s_m - p.front_s_m <= follower_m()
        AND (p.s_m <= g.s_m OR coalesce(p.speed_mps > g.speed_mps, true))
        AND (
            in_lane(g.side * p.d_m - 2 * p.half_width_m, p.lat_half_m, p.half_width_m)
            OR (in_lane(p.d_m, p.lat_half_m, p.half_width_m) AND g.side * p.speed_mps * sin(p.heading_diff_rad) > 0.3)
        )
    GROUP BY ALL
),
doubt AS (
    SELECT drive_id, ego_id, t_ns, min(least_m) AS least_m FROM hidden WHERE vehicle AND ahead IS DISTINCT FROM true AND least_m < follower_m() GROUP BY ALL
)
SELECT
    g.drive_id, g.ego_id, g.occurrence, coalesce(j.m, 'infinity'::DOUBLE) AS junction_m, coalesce(x.m, 'infinity'::DOUBLE) AS crossing_m,
    o.marking AS marking_out, seen_from_beyond(b.marking) AS marking_back,
    CASE WHEN d.environment_id IS NOT NULL THEN s.holds OR CASE WHEN u.front_s_m IS NOT NULL OR NOT g.passed THEN coalesce(v.holds, false) END END AS no_overtaking,
    r.o.object_id AS rear_id, r.o.gap_m AS rear_gap_m, CASE WHEN r.o.object_id IS NULL THEN 'infinity'::DOUBLE ELSE r.o.ttc_s END AS rear_ttc_s,
    h.t_ns IS NULL AND coalesce(r.known, true) AS rear_known, CASE WHEN coalesce(r.known, true) THEN h.least_m END AS rear_unseen_m
FROM gone g
LEFT JOIN junction j USING (drive_id, ego_id, occurrence)
LEFT JOIN crossed x USING (drive_id, ego_id, occurrence)
LEFT JOIN (FROM line WHERE NOT back) o USING (drive_id, ego_id, occurrence)
LEFT JOIN (FROM line WHERE back) b USING (drive_id, ego_id, occurrence)
LEFT JOIN signed d ON d.environment_id = g.environment_id
LEFT JOIN (FROM sign WHERE NOT level) s USING (drive_id, ego_id, occurrence)
LEFT JOIN (FROM sign WHERE level) v USING (drive_id, ego_id, occurrence)
LEFT JOIN (FROM front WHERE level) u USING (drive_id, ego_id, occurrence)
LEFT JOIN rear r USING (drive_id, ego_id, occurrence)
LEFT JOIN doubt h ON h.drive_id = g.drive_id AND h.ego_id = g.ego_id AND h.t_ns = g.t0_ns
