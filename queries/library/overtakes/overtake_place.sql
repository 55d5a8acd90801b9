-- The place where an overtake begins and ends, and the vehicle that approaches from behind when it begins.
-- lifetime: part
CREATE TABLE overtake_place (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- see overtake
    junction_m DOUBLE,                -- distance along the corridor from the ego's front at t0 to the next junction; infinite: none within the corridor; negative: inside a junction {position}
    crossing_m DOUBLE,                -- distance from the ego's front at t0 to the next pedestrian crossing, as junction_m {position}
    marking_out VARCHAR,              -- [marking] of the boundary that the ego crosses at t0, seen from the running lane; NULL: the map does not state it {position}
    marking_back VARCHAR,             -- [marking] of the boundary that the ego crosses back at t3, seen from the overtaking lane; NULL: the map does not state it, or the ego never comes back {position}
    no_overtaking BOOLEAN,            -- a no-overtaking sign applies at t0, or where the ego's front draws level with the rear of a vehicle that it passes; it applies until its end sign or the next junction; NULL: the map has no such signs, or neither a sign nor a junction behind the ego: one may stand further back; or the sign is variable or has a plate, and may not apply now {position}
    rear_id VARCHAR,                  -- a vehicle behind or beside the ego at t0, in the overtaking lane or moving into it; NULL: none {position, heading, size}
    rear_gap_m DOUBLE,                -- distance from that vehicle's front to the ego's rear; negative: alongside {position, heading, size}
    rear_ttc_s DOUBLE,                -- time until that vehicle reaches the ego's rear, at the ego's speed and the vehicle's highest speed in the 2 s before; infinite: never, or no vehicle; 0: alongside {position, velocity}
    rear_known BOOLEAN NOT NULL,      -- the positions and speeds of all vehicles behind or beside, within 200 m, are known {position, heading, size}
    rear_unseen_m DOUBLE              -- lower bound of the distance of a vehicle without a position that may be behind or beside; NULL: none, or a vehicle with a position has no class or speed {position, heading, size}
);

INSERT INTO overtake_place BY NAME
WITH overtake_begin AS (
    SELECT
        o.drive_id, o.ego_id, o.occurrence, o.chain_id, o.side, o.vbp_id, o.passed, o.t0_ns, o.t3_ns, o.t_end_ns, g.environment_id, e.s_m, e.front_s_m, e.rear_s_m, e.speed_mps
    FROM overtake o
    JOIN data_log g USING (drive_id)
    JOIN ego_state e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.t_ns = o.t0_ns
),
-- Two roads that meet in a junction are one road for a driver.
road_count AS (
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
    LEFT JOIN _road_half h USING (environment_id, road_id)
    GROUP BY ALL
),
chain_lanelet AS (
    SELECT g.drive_id, g.ego_id, g.occurrence, g.environment_id, g.front_s_m, g.rear_s_m, c.lanelet_id, c.s_start_m, c.length_m
    FROM overtake_begin g
    JOIN chain c USING (drive_id, ego_id, chain_id)
),
next_junction AS (
    SELECT w.drive_id, w.ego_id, w.occurrence, min(w.s_start_m - w.front_s_m) AS ahead_m
    FROM chain_lanelet w
    JOIN lanelet n ON n.environment_id = w.environment_id AND n.lanelet_id = w.lanelet_id
    JOIN road_count r ON r.environment_id = n.environment_id AND r.junction_id = n.junction_id
    WHERE w.s_start_m + w.length_m > w.rear_s_m AND r.n > 2
    GROUP BY ALL
),
next_crossing AS (
    SELECT w.drive_id, w.ego_id, w.occurrence, min(w.s_start_m + x.s_start_m - w.front_s_m) AS ahead_m
    FROM chain_lanelet w
    JOIN crossing x ON x.environment_id = w.environment_id AND x.lanelet_id = w.lanelet_id
    WHERE w.s_start_m + x.s_end_m > w.rear_s_m
    GROUP BY ALL
),
-- The position of the ego's front at t0, and later where it draws level with the vehicle that it passes.
front_place AS (
    SELECT drive_id, ego_id, occurrence, false AS is_level, front_s_m FROM overtake_begin
    UNION ALL
    SELECT l.drive_id, l.ego_id, l.occurrence, true, x.front_s_m
    FROM (
        SELECT g.drive_id, g.ego_id, g.occurrence, g.chain_id, min(e.t_ns) AS t_ns
        FROM overtake_begin g
        JOIN ego_state e ON e.drive_id = g.drive_id AND e.ego_id = g.ego_id AND e.t_ns >= g.t0_ns AND e.t_ns <= g.t_end_ns
        JOIN pair p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.t_ns = e.t_ns AND p.object_id = g.vbp_id
        WHERE g.passed AND e.front_s_m > coalesce(p.rear_s_m, p.s_m)
        GROUP BY ALL
    ) l
    JOIN ego_corridor x ON x.drive_id = l.drive_id AND x.ego_id = l.ego_id AND x.chain_id = l.chain_id AND x.t_ns = l.t_ns
),
map_with_unknown_codes AS (SELECT environment_id FROM environment WHERE NOT signs_mapped),
lanelet_with_plate AS (SELECT DISTINCT environment_id, lanelet_id FROM map_quality WHERE check_id = 'sign_condition_unread'),
-- The last sign or junction that the ego has passed. A sign applies until its end is signed, or until the next junction. If there is
-- neither, a sign may stand further back than the corridor extends, or before the map's beginning. A sign that was not recognised, in a map
-- with signs of countries whose codes are not known, may forbid overtaking or end a ban, and so may a board that changes.
last_sign_passed AS (
    SELECT w.drive_id, w.ego_id, w.occurrence, f.is_level, max({'s_m': w.s_m, 'holds': w.holds}).holds AS holds
    FROM (
        SELECT w.drive_id, w.ego_id, w.occurrence, w.s_start_m + t.lane_s_m AS s_m,
            CASE WHEN NOT t.dynamic AND (t.kind = 'no_overtaking_end' OR q.lanelet_id IS NULL) THEN t.kind = 'no_overtaking' END AS holds
        FROM chain_lanelet w
        JOIN traffic_signal t ON t.environment_id = w.environment_id AND t.lanelet_id = w.lanelet_id
        LEFT JOIN lanelet_with_plate q ON q.environment_id = w.environment_id AND q.lanelet_id = w.lanelet_id
        LEFT JOIN map_with_unknown_codes u ON u.environment_id = w.environment_id
        WHERE t.kind IN ('no_overtaking', 'no_overtaking_end') OR t.type IN ('vmsBoard', 'multiBoard')
            OR (t.kind IS NULL AND NOT t.dynamic AND u.environment_id IS NOT NULL AND t.type NOT IN ('', '-1', 'none', 'staticBoard'))
        UNION ALL
        SELECT w.drive_id, w.ego_id, w.occurrence, w.s_start_m + w.length_m, false
        FROM chain_lanelet w
        JOIN lanelet n ON n.environment_id = w.environment_id AND n.lanelet_id = w.lanelet_id
        JOIN road_count r ON r.environment_id = n.environment_id AND r.junction_id = n.junction_id
        WHERE r.n > 2
    ) w
    JOIN front_place f ON f.drive_id = w.drive_id AND f.ego_id = w.ego_id AND f.occurrence = w.occurrence AND w.s_m <= f.front_s_m
    GROUP BY ALL
),
map_with_signs AS (SELECT DISTINCT environment_id FROM traffic_signal WHERE kind IN ('no_overtaking', 'no_overtaking_end')),
-- The boundary of the running lane on the overtaking side, where the ego leaves the lane and where it comes back.
crossed_line AS (
    SELECT g.drive_id, g.ego_id, g.occurrence, v.is_way_back, min(b.marking) AS marking
    FROM overtake_begin g
    CROSS JOIN (VALUES (false), (true)) AS v(is_way_back)
    JOIN ego_corridor x ON x.drive_id = g.drive_id AND x.ego_id = g.ego_id AND x.chain_id = g.chain_id
        AND x.t_ns = CASE WHEN v.is_way_back THEN g.t3_ns ELSE g.t0_ns END
    JOIN chain c ON c.drive_id = g.drive_id AND c.ego_id = g.ego_id AND c.chain_id = g.chain_id
        AND c.s_start_m <= x.s_m AND x.s_m < c.s_start_m + c.length_m
    JOIN lane_boundary b ON b.environment_id = g.environment_id AND b.lanelet_id = c.lanelet_id
        AND b.side = CASE g.side WHEN 1 THEN 'left' ELSE 'right' END
        AND b.s_start_m <= x.s_m - c.s_start_m AND x.s_m - c.s_start_m < b.s_end_m
    GROUP BY ALL
),
-- The highest known speed of each actor just before t0: a vehicle that approaches in the overtaking lane may have begun to brake when the
-- ego began to move over.
earlier_speed AS (
    SELECT g.drive_id, g.ego_id, g.occurrence, p.object_id, max(p.speed_mps) AS fastest_mps, count(p.speed_mps) = count(*) AS is_whole
    FROM overtake_begin g
    JOIN pair p ON p.drive_id = g.drive_id AND p.ego_id = g.ego_id AND p.t_ns >= g.t0_ns - braked_before_ns() AND p.t_ns <= g.t0_ns
    GROUP BY ALL
),
-- Vehicles in the overtaking lane, or in the running lane and moving over at more than 0.3 m/s. A vehicle that is partly beside the ego has
-- not passed yet. A vehicle with its middle ahead of the ego's is excluded, unless it is or may be faster: the ego passes it, or drives
-- beside it.
rear_vehicle AS (
    SELECT
        g.drive_id, g.ego_id, g.occurrence,
        min({
            'ttc_s': CASE
                WHEN p.front_s_m >= g.rear_s_m THEN 0.0::DOUBLE
                WHEN p.speed_mps IS NULL THEN NULL
                WHEN f.fastest_mps > g.speed_mps THEN (g.rear_s_m - p.front_s_m) / (f.fastest_mps - g.speed_mps)
                WHEN f.fastest_mps <= g.speed_mps AND f.is_whole THEN 'infinity'::DOUBLE
            END,
            'gap_m': g.rear_s_m - p.front_s_m, 'object_id': p.object_id
        }) FILTER (is_vehicle(p.actor_class)) AS o,
        bool_and((f.is_whole OR p.front_s_m >= g.rear_s_m) AND is_vehicle(p.actor_class) IS NOT NULL) AS known
    FROM overtake_begin g
    JOIN pair p ON p.drive_id = g.drive_id AND p.ego_id = g.ego_id AND p.t_ns = g.t0_ns
    JOIN earlier_speed f ON f.drive_id = g.drive_id AND f.ego_id = g.ego_id AND f.occurrence = g.occurrence AND f.object_id = p.object_id
    WHERE may_be_vehicle(p.actor_class) AND p.rear_s_m <= g.front_s_m AND abs(p.heading_diff_rad) < pi() / 2 AND g.rear_s_m - p.front_s_m <= follower_m()
        AND (p.s_m <= g.s_m OR coalesce(p.speed_mps > g.speed_mps, true))
        AND (
            in_lane(g.side * p.d_m - 2 * p.half_width_m, p.lat_half_m, p.half_width_m)
            OR (in_lane(p.d_m, p.lat_half_m, p.half_width_m) AND g.side * p.speed_mps * sin(p.heading_diff_rad) > 0.3)
        )
    GROUP BY ALL
),
hidden_vehicle AS (
    SELECT drive_id, ego_id, t_ns, min(least_m) AS least_m FROM hidden WHERE vehicle AND ahead IS DISTINCT FROM true AND least_m < follower_m() GROUP BY ALL
)
SELECT
    g.drive_id, g.ego_id, g.occurrence, coalesce(j.ahead_m, 'infinity'::DOUBLE) AS junction_m, coalesce(x.ahead_m, 'infinity'::DOUBLE) AS crossing_m,
    o.marking AS marking_out, seen_from_beyond(b.marking) AS marking_back,
    CASE WHEN d.environment_id IS NOT NULL THEN s.holds OR CASE WHEN u.front_s_m IS NOT NULL OR NOT g.passed THEN CASE WHEN v.drive_id IS NULL THEN false ELSE v.holds END END END AS no_overtaking,
    r.o.object_id AS rear_id, r.o.gap_m AS rear_gap_m, CASE WHEN r.o.object_id IS NULL THEN 'infinity'::DOUBLE ELSE r.o.ttc_s END AS rear_ttc_s,
    h.t_ns IS NULL AND coalesce(r.known, true) AS rear_known, CASE WHEN coalesce(r.known, true) THEN h.least_m END AS rear_unseen_m
FROM overtake_begin g
LEFT JOIN next_junction j USING (drive_id, ego_id, occurrence)
LEFT JOIN next_crossing x USING (drive_id, ego_id, occurrence)
LEFT JOIN (FROM crossed_line WHERE NOT is_way_back) o USING (drive_id, ego_id, occurrence)
LEFT JOIN (FROM crossed_line WHERE is_way_back) b USING (drive_id, ego_id, occurrence)
LEFT JOIN map_with_signs d ON d.environment_id = g.environment_id
LEFT JOIN (FROM last_sign_passed WHERE NOT is_level) s USING (drive_id, ego_id, occurrence)
LEFT JOIN (FROM last_sign_passed WHERE is_level) v USING (drive_id, ego_id, occurrence)
LEFT JOIN (FROM front_place WHERE is_level) u USING (drive_id, ego_id, occurrence)
LEFT JOIN rear_vehicle r USING (drive_id, ego_id, occurrence)
LEFT JOIN hidden_vehicle h ON h.drive_id = g.drive_id AND h.ego_id = g.ego_id AND h.t_ns = g.t0_ns
