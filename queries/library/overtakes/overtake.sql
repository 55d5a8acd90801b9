-- Overtakes (Harper et al. 2021, Appendix A): the ego leaves its lane towards the overtaking lane with a vehicle ahead of it. The nearest
-- vehicle counts if the ego passes it, or if it is within 100 m and the ego's centre crossed the line. A smaller excursion that was
-- completely seen is only a wobble. Every further vehicle that the ego passes in the same excursion counts, too.
--
-- An ego that first stays over the line, to look past the vehicle ahead, overtakes when it pulls out from there. It pulls out for a
-- vehicle before it is level with that vehicle: what it does beside or beyond a vehicle, such as swinging its tail out, does not change
-- when it began to overtake that vehicle.
-- lifetime: part
CREATE TABLE overtake (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the overtake, from 0, in time order; each vehicle passed in one excursion has its own row
    chain_id INTEGER NOT NULL,        -- the running chain
    opposing BOOLEAN,                 -- the overtaking lane is driven in the opposite direction; NULL: no lane beside, or unknown {position}
    side INTEGER NOT NULL,            -- the overtaking side: 1 left, -1 right {position}
    vbp_id VARCHAR NOT NULL,          -- VBP: the vehicle being passed, or one that may be it {position}
    vbp_placed BOOLEAN NOT NULL,      -- the VBP's position was known at t0; false: only its presence is known {position}
    sure BOOLEAN NOT NULL,            -- it certainly is an overtake, as two of three hold: the VBP's position was known at t0; the ego passed the VBP; the ego's centre crossed the line, or the ego was astride of it for 3 s; and the ego does not turn in at a junction. If it did not pass the VBP, it must be in an opposing lane, and either astride for 3 s or seen from the beginning on. False: it may be one {position}
    begin_seen BOOLEAN NOT NULL,      -- t0 is certain: the step before t0 exists, and the ego is inside the lane there; false if t0 may lie in a turn at a junction, or if the ego may have begun later (t_begun_ns) {position}
    t0_ns BIGINT NOT NULL,            -- first step with a corner more than 0.05 m over the boundary or, if the ego stayed over it before it was level with the VBP: the last step at which it gained less than 0.1 m in a second and after which its centre gained 0.3 m {position}
    t_begun_ns BIGINT NOT NULL,       -- step at which the overtake certainly has begun: t0_ns or, if the centre then stayed and gained 0.1 to 0.3 m, the last step of this stay {position}
    t1_ns BIGINT,                     -- first step wholly in the overtaking lane {position}
    t_out_ns BIGINT NOT NULL,         -- end of pulling out: t1; in an overtake astride the line, the first step within 0.1 m of the furthest place of the centre before the ego is level with the VBP {position}
    t2_ns BIGINT,                     -- step at which the lateral speed changes its sign, see t_turn_ns of excursion {position}
    t3_ns BIGINT,                     -- first step wholly back in the running lane {position}
    t_end_ns BIGINT NOT NULL,         -- t3_ns, or the last step of the excursion {position}
    passed BOOLEAN NOT NULL,          -- the ego's front got ahead of the VBP's front {position}
    status VARCHAR NOT NULL,          -- [overtake_status] {position}
    v_av_mps DOUBLE,                  -- speed of the ego (AV: automated vehicle) at t0 {velocity}
    v_vbp_mps DOUBLE,                 -- speed of the VBP (vehicle being passed) at t0 {velocity}
    l_av_m DOUBLE,                    -- length of the ego, with its trailer {size}
    l_vbp_m DOUBLE,                   -- length of the VBP (vehicle being passed) {size}
    lane_width_m DOUBLE,              -- width of the running lane at t0 (w_L of Harper et al. 2021)
    vbp_gap_m DOUBLE,                 -- distance from the ego's front to the VBP's rear at t0, along the corridor; negative: the VBP is beside the ego {position, heading, size}
    span_m DOUBLE,                    -- from the rear of the first vehicle passed in this excursion to the front of this VBP, at t0; the VBP's length if it is the only one {position}
    t2_gap_m DOUBLE,                  -- distance from the VBP's front to the ego's rear at t2 {position, heading, size}
    t3_gap_m DOUBLE,                  -- distance from the VBP's front to the ego's rear at t3 {position, heading, size}
    v_vbp_t3_mps DOUBLE,              -- speed of the VBP (vehicle being passed) at t3 {velocity}
    ov_id VARCHAR,                    -- the oncoming vehicle (OV) at t0, see oncoming {position}
    da_m DOUBLE,                      -- distance ahead at t0: to the OV, or without an OV the free distance {position}
    v_ov_mps DOUBLE,                  -- OV's speed at t0; without an OV, the speed limit {velocity}
    n_unplaced BIGINT,                -- see oncoming, at t0; NULL: the ego's position is not known {position}
    unplaced_reason VARCHAR,          -- see oncoming
    free_reason VARCHAR,              -- [free_end] see oncoming
    pull_out_angle_rad DOUBLE,        -- observed: atan of lateral over longitudinal distance from t0 to t_out {heading}
    cut_in_angle_rad DOUBLE           -- observed: atan of lateral over longitudinal distance from t2 to t3 {heading}
);

INSERT INTO overtake BY NAME
WITH overtaking_excursion AS (
    SELECT x.* EXCLUDE (t0_ns, t_out_ns), x.t0_ns AS t_excursion_ns, coalesce(x.t_back_ns, x.t_end_ns) AS t_last_ns
    FROM excursion x
    WHERE x.overtaking AND EXISTS (
        FROM ego_state e WHERE e.drive_id = x.drive_id AND e.ego_id = x.ego_id AND e.t_ns >= x.t0_ns AND e.t_ns <= x.t_end_ns AND e.chain_id = x.chain_id
    )
),
-- The positions of the ego and all objects during an excursion, read once from the large table pair. Later queries read these rows by key.
pair_in_excursion AS MATERIALIZED (
    SELECT x.chain_id, x.t_excursion_ns, e.front_s_m AS ego_front_m, e.rear_s_m AS ego_rear_m, e.yaw_rad - e.heading_diff_rad AS lane_rad, p.*
    FROM overtaking_excursion x
    JOIN ego_state e ON e.drive_id = x.drive_id AND e.ego_id = x.ego_id AND e.t_ns >= x.t_excursion_ns AND e.t_ns <= x.t_last_ns
    JOIN (
        SELECT drive_id, ego_id, t_ns, object_id, actor_class, x_m, y_m, s_m, d_m, front_s_m, rear_s_m, lat_half_m, half_width_m,
            heading_diff_rad, speed_mps, length_m
        FROM pair
    ) p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.t_ns = e.t_ns
),
-- The steps over the line. At a step with `stays`, the ego's centre is in the lane, and the ego gained less than 0.1 m in the last second.
step_over_line AS MATERIALIZED (
    SELECT
        *, t_ns < coalesce(t_over_ns, t_end_ns) AND lateral_m <= half_width_m AND t_ns - earlier.t_ns >= 900_000_000 AND out_m - earlier.out_m < 0.1 AS stays
    FROM (
        SELECT
            x.drive_id, x.ego_id, x.chain_id, x.side, x.t_excursion_ns, x.t_over_ns, x.t_end_ns, c.t_ns, x.side * c.d_m AS lateral_m, c.half_width_m,
            CASE x.side WHEN 1 THEN c.left_out_m ELSE c.right_out_m END AS out_m, first_value({'t_ns': c.t_ns, 'out_m': out_m}) OVER w AS earlier
        FROM overtaking_excursion x
        JOIN ego_corridor c ON c.drive_id = x.drive_id AND c.ego_id = x.ego_id AND c.chain_id = x.chain_id AND c.t_ns >= x.t_excursion_ns AND c.t_ns <= x.t_end_ns
        WHERE c.left_out_m IS NOT NULL
        WINDOW w AS (PARTITION BY x.drive_id, x.ego_id, x.chain_id, x.t_excursion_ns ORDER BY c.t_ns RANGE BETWEEN 1_000_000_000 PRECEDING AND CURRENT ROW)
    )
),
-- Steps at which the ego is level with the rear of an object, or further; also with one that has no position but must be behind.
level_or_past AS (
    SELECT drive_id, ego_id, chain_id, t_excursion_ns, object_id, t_ns FROM pair_in_excursion WHERE ego_front_m >= coalesce(rear_s_m, s_m)
    UNION ALL
    SELECT x.drive_id, x.ego_id, x.chain_id, x.t_excursion_ns, h.object_id, h.t_ns
    FROM overtaking_excursion x
    JOIN hidden h ON h.drive_id = x.drive_id AND h.ego_id = x.ego_id AND h.t_ns >= x.t_excursion_ns AND h.t_ns <= x.t_last_ns
    WHERE NOT h.ahead
),
-- Vehicles ahead in the ego's lane whose track ends shortly before the ego leaves this lane: one of them may be the overtaken vehicle, although
-- it may also have left the road, if the recorder's range is not limited and it was further away than a lost actor is near (table `unplaced`).
lost_ahead AS (
    SELECT x.drive_id, x.ego_id, x.chain_id, x.t_excursion_ns, h.object_id
    FROM overtaking_excursion x
    JOIN hidden h ON h.drive_id = x.drive_id AND h.ego_id = x.ego_id AND h.t_ns = x.t_excursion_ns AND h.vehicle AND h.least_m <= 100 AND h.ahead IS DISTINCT FROM false
    JOIN pair p ON p.drive_id = h.drive_id AND p.ego_id = h.ego_id AND p.object_id = h.object_id AND p.t_ns >= x.t_excursion_ns - longest_track_gap_ns()
    JOIN ego_state e ON e.drive_id = p.drive_id AND e.ego_id = p.ego_id AND e.t_ns = p.t_ns
    ANTI JOIN unplaced u ON u.drive_id = h.drive_id AND u.ego_id = h.ego_id AND u.t_ns = h.t_ns AND u.object_id = h.object_id
    GROUP BY ALL
    HAVING max(p.t_ns) < x.t_excursion_ns AND max({
        't_ns': p.t_ns,
        'in_lane': in_lane(p.d_m, p.lat_half_m, p.half_width_m) AND p.s_m > e.s_m AND abs(p.heading_diff_rad) < pi() / 2
    }).in_lane
),
-- The first of these steps after the object was ahead; later than the excursion if there is none. Objects that the log does not have during
-- the excursion belong to it, too.
level_step AS (
    SELECT o.drive_id, o.ego_id, o.chain_id, o.t_excursion_ns, o.object_id, coalesce(min(p.t_ns), 9_223_372_036_854_775_807) AS t_level_ns
    FROM (
        SELECT drive_id, ego_id, chain_id, t_excursion_ns, object_id, min(t_ns) FILTER (ego_front_m < coalesce(rear_s_m, s_m)) AS t_ahead_ns
        FROM pair_in_excursion
        GROUP BY ALL
        UNION ALL
        SELECT DISTINCT x.drive_id, x.ego_id, x.chain_id, x.t_excursion_ns, u.object_id, NULL::BIGINT
        FROM overtaking_excursion x
        JOIN unplaced u ON u.drive_id = x.drive_id AND u.ego_id = x.ego_id AND u.t_ns >= x.t_excursion_ns AND u.t_ns <= x.t_end_ns
        ANTI JOIN pair_in_excursion p ON p.drive_id = x.drive_id AND p.ego_id = x.ego_id AND p.chain_id = x.chain_id
            AND p.t_excursion_ns = x.t_excursion_ns AND p.object_id = u.object_id
        UNION
        SELECT l.drive_id, l.ego_id, l.chain_id, l.t_excursion_ns, l.object_id, NULL FROM lost_ahead l
        ANTI JOIN pair_in_excursion p ON p.drive_id = l.drive_id AND p.ego_id = l.ego_id AND p.chain_id = l.chain_id
            AND p.t_excursion_ns = l.t_excursion_ns AND p.object_id = l.object_id
    ) o
    LEFT JOIN level_or_past p ON p.drive_id = o.drive_id AND p.ego_id = o.ego_id AND p.chain_id = o.chain_id
        AND p.t_excursion_ns = o.t_excursion_ns AND p.object_id = o.object_id AND p.t_ns > o.t_ahead_ns
    GROUP BY ALL
),
-- What the ego's centre gains after a step at which it stays, until it is level with an object.
gain_after_stay AS (
    SELECT *
    FROM (
        SELECT
            s.drive_id, s.ego_id, s.chain_id, s.t_excursion_ns, l.t_level_ns, s.t_ns, s.stays,
            max(s.lateral_m) OVER (PARTITION BY s.drive_id, s.ego_id, s.chain_id, s.t_excursion_ns, l.t_level_ns ORDER BY s.t_ns ROWS BETWEEN 1 FOLLOWING AND UNBOUNDED FOLLOWING) - s.lateral_m AS gain_m
        FROM step_over_line s
        JOIN (SELECT DISTINCT drive_id, ego_id, chain_id, t_excursion_ns, t_level_ns FROM level_step) l USING (drive_id, ego_id, chain_id, t_excursion_ns)
        WHERE s.t_ns <= l.t_level_ns
    )
    WHERE stays AND gain_m >= measured_m()
),
-- The step at which the ego pulls out for an object: the last at which it stays and then gains enough, or the first over the line. If it
-- then stays and gains less, it is not known whether it pulled out then: it may have begun as late as t_begun_ns.
pull_out AS (
    SELECT
        l.drive_id, l.ego_id, l.chain_id, l.t_excursion_ns, l.object_id, l.t_level_ns,
        coalesce(max(g.t_ns) FILTER (g.gain_m >= pulls_out_m()), l.t_excursion_ns) AS t0_ns, coalesce(max(g.t_ns), l.t_excursion_ns) AS t_begun_ns
    FROM level_step l
    LEFT JOIN (
        SELECT l.drive_id, l.ego_id, l.chain_id, l.t_excursion_ns, l.object_id, g.t_ns, g.gain_m
        FROM level_step l
        JOIN gain_after_stay g USING (drive_id, ego_id, chain_id, t_excursion_ns, t_level_ns)
        -- The ego does not pull out for an object that is behind it.
        ANTI JOIN level_or_past h ON h.drive_id = l.drive_id AND h.ego_id = l.ego_id AND h.chain_id = l.chain_id
            AND h.t_excursion_ns = l.t_excursion_ns AND h.object_id = l.object_id AND h.t_ns = g.t_ns
    ) g USING (drive_id, ego_id, chain_id, t_excursion_ns, object_id)
    GROUP BY l.drive_id, l.ego_id, l.chain_id, l.t_excursion_ns, l.object_id, l.t_level_ns
),
begin AS (
    SELECT x.*, o.t0_ns, b.k - st.k + 1 AS n_steps, e.front_s_m, e.rear_s_m, e.s_m, e.d_m, e.lat_half_m, e.width_m, e.speed_mps, e.combination_m AS length_m, e.limit_mps,
        e.in_junction, e.yaw_rad - e.heading_diff_rad AS lane_rad
    FROM (SELECT DISTINCT drive_id, ego_id, chain_id, t_excursion_ns, t0_ns FROM pull_out) o
    JOIN overtaking_excursion x USING (drive_id, ego_id, chain_id, t_excursion_ns)
    JOIN ego_state e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.t_ns = o.t0_ns
    JOIN step st ON st.drive_id = o.drive_id AND st.ego_id = o.ego_id AND st.t_ns = o.t0_ns
    LEFT JOIN step b ON b.drive_id = o.drive_id AND b.ego_id = o.ego_id AND b.t_ns = x.t_last_ns
    -- Only excursions from the running chain at t0. The ego is outside a chain all the time before it enters it, which is no excursion.
    WHERE e.chain_id = x.chain_id
),
ahead AS (
    SELECT g.drive_id, g.ego_id, g.chain_id, g.t0_ns, p.object_id, CASE WHEN is_vehicle(p.actor_class) THEN p.rear_s_m - g.front_s_m END AS gap_m, p.speed_mps,
        p.length_m, is_vehicle(p.actor_class) IS NOT DISTINCT FROM true AS is_placed, p.rear_s_m - g.front_s_m AS near_m
    FROM begin g
    JOIN pair_in_excursion p ON p.drive_id = g.drive_id AND p.ego_id = g.ego_id AND p.chain_id = g.chain_id AND p.t_excursion_ns = g.t_excursion_ns AND p.t_ns = g.t0_ns
    WHERE may_be_vehicle_or_obstacle(p.actor_class, p.d_m - g.d_m, p.lat_half_m + g.lat_half_m) AND p.s_m > g.s_m
        AND abs(p.d_m) - p.lat_half_m < p.half_width_m - over_boundary_m()
        AND (abs(p.heading_diff_rad) < 2 * pi() / 3 OR p.speed_mps <= standing_mps())
        -- An ego that has room to pass a standing object within its lane, and is still partly in this lane, does not cross the line for
        -- that object.
        AND NOT coalesce(p.speed_mps <= standing_mps() AND NOT g.centre_over AND p.half_width_m - g.side * p.d_m - p.lat_half_m >= g.width_m + room_beside_standing_m(), false)
),
-- Vehicles that are first seen after t0 and come towards the ego: none is the overtaken vehicle.
oncoming_object AS (
    SELECT drive_id, ego_id, t0_ns, object_id
    FROM (
        SELECT u.*, p.t_ns, coalesce(abs(p.heading_diff_rad) >= 2 * pi() / 3 AND p.speed_mps > standing_mps(), false) AS towards
        FROM (
            SELECT DISTINCT g.drive_id, g.ego_id, g.t0_ns, u.object_id
            FROM begin g
            JOIN unplaced u ON u.drive_id = g.drive_id AND u.ego_id = g.ego_id AND u.t_ns = g.t0_ns
        ) u
        JOIN pair p ON p.drive_id = u.drive_id AND p.ego_id = u.ego_id AND p.object_id = u.object_id
        WHERE p.front_s_m IS NOT NULL
    )
    GROUP BY ALL
    HAVING min(t_ns) > t0_ns AND min({'t_ns': t_ns, 'towards': towards}).towards
),
-- An object without a position, heading or size, or with a track that ends or begins nearby, may be the overtaken vehicle, unless it was
-- further away or behind (table `hidden`).
candidate_without_place AS (
    SELECT g.drive_id, g.ego_id, g.chain_id, g.t0_ns, u.object_id, NULL::DOUBLE AS gap_m, p.speed_mps, a.length_m, false AS is_placed,
        p.s_m - g.front_s_m AS near_m
    FROM begin g
    JOIN unplaced u ON u.drive_id = g.drive_id AND u.ego_id = g.ego_id AND u.t_ns = g.t0_ns
    JOIN actor a ON a.drive_id = u.drive_id AND a.actor_id = u.object_id
    ANTI JOIN oncoming_object m ON m.drive_id = u.drive_id AND m.ego_id = u.ego_id AND m.t0_ns = u.t_ns AND m.object_id = u.object_id
    LEFT JOIN pair_in_excursion p ON p.drive_id = g.drive_id AND p.ego_id = g.ego_id AND p.chain_id = g.chain_id AND p.t_excursion_ns = g.t_excursion_ns
        AND p.t_ns = g.t0_ns AND p.object_id = u.object_id
    WHERE p.front_s_m IS NULL AND p.s_m > g.s_m AND abs(p.d_m) < 2 * p.half_width_m
        OR (p.x_m IS NULL OR p.y_m IS NULL)
            AND EXISTS (FROM hidden h WHERE h.drive_id = u.drive_id AND h.ego_id = u.ego_id AND h.t_ns = u.t_ns AND h.object_id = u.object_id
                AND h.least_m <= 100 AND h.ahead IS DISTINCT FROM false)
            AND NOT EXISTS (FROM ahead a WHERE a.drive_id = g.drive_id AND a.ego_id = g.ego_id AND a.chain_id = g.chain_id AND a.t0_ns = g.t0_ns AND a.near_m <= 100)
),
-- A corridor that ends while the ego is over the line, as where the map lacks a link, hides whom the ego passes further on.
candidate_beyond_corridor AS (
    SELECT g.drive_id, g.ego_id, g.chain_id, g.t0_ns, h.object_id, NULL::DOUBLE AS gap_m, NULL::DOUBLE AS speed_mps, a.length_m, false AS is_placed, min(h.least_m) AS near_m
    FROM (SELECT * FROM begin WHERE t_back_ns IS NULL) g
    JOIN step st ON st.drive_id = g.drive_id AND st.ego_id = g.ego_id AND st.t_ns = g.t_end_ns
    JOIN step n ON n.drive_id = st.drive_id AND n.ego_id = st.ego_id AND n.seg = st.seg AND n.k = st.k + 1
    JOIN ego_state e ON e.drive_id = n.drive_id AND e.ego_id = n.ego_id AND e.t_ns = n.t_ns AND e.x_m IS NOT NULL AND e.front_s_m IS NULL
    JOIN hidden h ON h.drive_id = g.drive_id AND h.ego_id = g.ego_id AND h.t_ns >= g.t0_ns AND h.t_ns <= g.t_end_ns
    JOIN actor a ON a.drive_id = h.drive_id AND a.actor_id = h.object_id
    WHERE h.vehicle AND h.ahead IS DISTINCT FROM false
    GROUP BY ALL
),
candidate_lost AS (
    SELECT g.drive_id, g.ego_id, g.chain_id, g.t0_ns, l.object_id, NULL::DOUBLE AS gap_m, NULL::DOUBLE AS speed_mps, a.length_m, false AS is_placed, NULL::DOUBLE AS near_m
    FROM begin g
    JOIN lost_ahead l USING (drive_id, ego_id, chain_id, t_excursion_ns)
    JOIN actor a ON a.drive_id = l.drive_id AND a.actor_id = l.object_id
    ANTI JOIN (FROM ahead WHERE near_m <= 100) n ON n.drive_id = g.drive_id AND n.ego_id = g.ego_id AND n.chain_id = g.chain_id AND n.t0_ns = g.t0_ns
),
-- An object that gets a position on the corridor only after t0, ahead in the lane, and that the ego passes, is an overtaken vehicle, too.
late_candidate AS (
    SELECT drive_id, ego_id, chain_id, t0_ns, object_id, NULL::DOUBLE AS gap_m, NULL::DOUBLE AS speed_mps, max(length_m) AS length_m, false AS is_placed, NULL::DOUBLE AS near_m
    FROM pull_out
    JOIN pair_in_excursion USING (drive_id, ego_id, chain_id, t_excursion_ns, object_id)
    WHERE t_ns >= t0_ns AND may_be_vehicle(actor_class) AND abs(d_m) - lat_half_m < half_width_m - over_boundary_m() AND abs(heading_diff_rad) < 2 * pi() / 3
    GROUP BY drive_id, ego_id, chain_id, t0_ns, object_id
    HAVING min(t_ns) > t0_ns AND min(ego_front_m - front_s_m) < 0 AND max(ego_front_m - front_s_m) > 0
),
-- Each object at the step at which the ego pulls out for it.
overtaken_candidate AS (
    SELECT c.*, o.t_excursion_ns, o.t_level_ns, o.t_begun_ns
    FROM (
        SELECT * FROM ahead
        UNION ALL
        SELECT * FROM candidate_without_place
        UNION ALL
        SELECT l.* FROM candidate_lost l
        ANTI JOIN candidate_without_place h USING (drive_id, ego_id, chain_id, t0_ns, object_id)
        ANTI JOIN candidate_beyond_corridor b USING (drive_id, ego_id, chain_id, t0_ns, object_id)
        UNION ALL
        SELECT b.* FROM candidate_beyond_corridor b
        ANTI JOIN ahead p USING (drive_id, ego_id, chain_id, t0_ns, object_id)
        ANTI JOIN candidate_without_place h USING (drive_id, ego_id, chain_id, t0_ns, object_id)
        UNION ALL
        SELECT l.* FROM late_candidate l
        ANTI JOIN pair_in_excursion p ON p.drive_id = l.drive_id AND p.ego_id = l.ego_id AND p.chain_id = l.chain_id AND p.t_ns = l.t0_ns AND p.object_id = l.object_id AND p.front_s_m IS NOT NULL
        ANTI JOIN candidate_without_place h ON h.drive_id = l.drive_id AND h.ego_id = l.ego_id AND h.chain_id = l.chain_id AND h.t0_ns = l.t0_ns AND h.object_id = l.object_id
    ) c
    JOIN pull_out o USING (drive_id, ego_id, chain_id, t0_ns, object_id)
),
-- The end of pulling out astride the line: the first step within 0.1 m of the furthest place of the centre until the ego is level with the
-- object.
furthest_step AS (
    SELECT drive_id, ego_id, chain_id, t0_ns, object_id, min(t_ns) AS t_furthest_ns
    FROM (
        SELECT c.*, s.t_ns, s.lateral_m, max(s.lateral_m) OVER (PARTITION BY c.drive_id, c.ego_id, c.chain_id, c.t0_ns, c.object_id) AS furthest_m
        FROM overtaken_candidate c
        JOIN step_over_line s USING (drive_id, ego_id, chain_id, t_excursion_ns)
        WHERE s.t_ns >= c.t0_ns AND s.t_ns <= c.t_level_ns
    )
    WHERE lateral_m >= furthest_m - measured_m()
    GROUP BY ALL
),
passing AS (
    SELECT c.drive_id, c.ego_id, c.chain_id, c.t0_ns, c.object_id, bool_or(p.ego_front_m > coalesce(p.front_s_m, p.s_m)) AS passed,
        count(p.front_s_m) AS n_seen,
        -- The direction of the ego's lane where the ego comes level with the vehicle's rear, or at the end of the excursion.
        coalesce(min({'t_ns': p.t_ns, 'rad': p.lane_rad}) FILTER (p.ego_front_m >= p.rear_s_m), max({'t_ns': p.t_ns, 'rad': p.lane_rad})).rad AS level_lane_rad
    FROM overtaken_candidate c
    JOIN pair_in_excursion p USING (drive_id, ego_id, chain_id, t_excursion_ns, object_id)
    WHERE p.t_ns >= c.t0_ns
    GROUP BY ALL
),
overtaken_vehicle AS (
    SELECT
        g.* EXCLUDE (overtaking), coalesce(g.t_over_ns, f.t_furthest_ns) AS t_out_ns, c.t_begun_ns, c.object_id, c.gap_m, c.speed_mps AS v_vbp_mps, c.length_m AS l_vbp_m, c.is_placed, coalesce(a.passed, false) AS passed,
        -- An ego that turns at a junction cuts the corner or swings wide there. It did not leave its lane for a vehicle beyond the turn.
        coalesce(g.in_junction AND (NOT g.begin_seen OR abs(wrap_rad(a.level_lane_rad - g.lane_rad)) > along_lane_rad()), false) AS turns_in
    FROM overtaken_candidate c
    JOIN begin g USING (drive_id, ego_id, chain_id, t0_ns)
    JOIN furthest_step f USING (drive_id, ego_id, chain_id, t0_ns, object_id)
    LEFT JOIN passing a USING (drive_id, ego_id, chain_id, t0_ns, object_id)
    CROSS JOIN LATERAL (SELECT coalesce(a.n_seen, 0) >= g.n_steps AS is_seen) n
    -- A vehicle beside the ego from t0 on that the ego never passes: the ego is only over the line beside it, as in a queue. An ego that
    -- reaches slightly over the boundary beside a parked car has not left its lane for that car.
    CROSS JOIN LATERAL (SELECT coalesce(c.speed_mps <= standing_mps() AND g.max_out_m < surely_out_m() AND g.t_back_ns IS NOT NULL, false) AS is_in_lane) l
    CROSS JOIN LATERAL (SELECT coalesce(NOT a.passed AND c.near_m < 0 AND n.is_seen, false) AND g.begin_seen AND NOT g.centre_over AS is_beside) w
    WHERE NOT l.is_in_lane
    QUALIFY coalesce(a.passed, false)
        OR row_number() OVER (PARTITION BY c.drive_id, c.ego_id, c.chain_id, c.t0_ns ORDER BY w.is_beside, coalesce(c.near_m, 0.0), c.object_id) = 1
            AND NOT w.is_beside AND coalesce(c.near_m, 0.0) <= 100
            AND (g.centre_over OR NOT g.begin_seen OR g.t_back_ns IS NULL OR NOT n.is_seen)
),
later_gap AS (
    SELECT k.drive_id, k.ego_id, k.chain_id, k.t0_ns, k.object_id, w.moment, p.ego_rear_m - p.front_s_m AS gap_m, p.speed_mps
    FROM overtaken_vehicle k
    CROSS JOIN (VALUES ('t2'), ('t3')) AS w(moment)
    JOIN pair_in_excursion p ON p.drive_id = k.drive_id AND p.ego_id = k.ego_id AND p.chain_id = k.chain_id AND p.t_excursion_ns = k.t_excursion_ns AND p.object_id = k.object_id
        AND p.t_ns = CASE w.moment WHEN 't2' THEN k.t_turn_ns ELSE k.t_back_ns END
),
path_angle AS (
    SELECT
        k.drive_id, k.ego_id, k.chain_id, k.t0_ns, k.object_id,
        atan2(k.side * (b.d_m - a.d_m), b.s_m - a.s_m) AS pull_out_angle_rad,
        atan2(k.side * (c.d_m - d.d_m), d.s_m - c.s_m) AS cut_in_angle_rad
    FROM overtaken_vehicle k
    JOIN ego_corridor a ON a.drive_id = k.drive_id AND a.ego_id = k.ego_id AND a.chain_id = k.chain_id AND a.t_ns = k.t0_ns
    LEFT JOIN ego_corridor b ON b.drive_id = k.drive_id AND b.ego_id = k.ego_id AND b.chain_id = k.chain_id AND b.t_ns = k.t_out_ns
    LEFT JOIN ego_corridor c ON c.drive_id = k.drive_id AND c.ego_id = k.ego_id AND c.chain_id = k.chain_id AND c.t_ns = k.t_turn_ns
    LEFT JOIN ego_corridor d ON d.drive_id = k.drive_id AND d.ego_id = k.ego_id AND d.chain_id = k.chain_id AND d.t_ns = k.t_back_ns
)
SELECT
    k.drive_id, k.ego_id,
    (row_number() OVER (PARTITION BY k.drive_id, k.ego_id ORDER BY k.t0_ns, k.chain_id, k.gap_m, k.object_id) - 1)::INTEGER AS occurrence,
    k.chain_id, k.over_against AS opposing, k.side, k.object_id AS vbp_id, k.is_placed AS vbp_placed,
    -- The ego may only have followed a vehicle that it did not pass: on its own side of the road, it changes lane or sways behind that
    -- vehicle. An ego that turns in may not have pulled out at all.
    NOT k.turns_in AND CASE WHEN k.passed THEN k.is_placed OR k.centre_over OR w.stays_out
        ELSE k.is_placed AND coalesce(k.over_against, false) AND (k.begin_seen AND k.centre_over OR w.stays_out)
    END AS sure, k.begin_seen AND NOT k.turns_in AND k.t_begun_ns = k.t0_ns AS begin_seen,
    k.t0_ns, k.t_begun_ns, k.t_over_ns AS t1_ns, k.t_out_ns, k.t_turn_ns AS t2_ns, k.t_back_ns AS t3_ns, coalesce(k.t_back_ns, k.t_end_ns) AS t_end_ns, k.passed,
    CASE
        WHEN k.t_back_ns IS NOT NULL AND k.passed THEN 'completed'
        WHEN k.t_back_ns IS NOT NULL THEN 'aborted'
        WHEN k.t_over_ns IS NOT NULL AND NOT k.over_against THEN 'lane_change'
        ELSE 'truncated'
    END AS status,
    k.speed_mps AS v_av_mps, k.v_vbp_mps, k.length_m AS l_av_m, k.l_vbp_m, k.lane_width_m, k.gap_m AS vbp_gap_m,
    k.gap_m + k.l_vbp_m - min(k.gap_m) OVER (PARTITION BY k.drive_id, k.ego_id, k.chain_id, k.t0_ns) AS span_m,
    t2.gap_m AS t2_gap_m, t3.gap_m AS t3_gap_m, t3.speed_mps AS v_vbp_t3_mps,
    o.object_id AS ov_id, coalesce(o.da_m, o.free_m) AS da_m, CASE WHEN o.object_id IS NULL THEN k.limit_mps ELSE o.speed_mps END AS v_ov_mps,
    o.n_unplaced, o.unplaced_reason, o.free_reason,
    a.pull_out_angle_rad, a.cut_in_angle_rad
FROM overtaken_vehicle k
CROSS JOIN LATERAL (SELECT coalesce(coalesce(k.t_turn_ns, k.t_end_ns) - k.t_out_ns >= stays_out_ns(), false) AS stays_out) w
LEFT JOIN oncoming o ON o.drive_id = k.drive_id AND o.ego_id = k.ego_id AND o.t_ns = k.t0_ns
LEFT JOIN path_angle a ON a.drive_id = k.drive_id AND a.ego_id = k.ego_id AND a.chain_id = k.chain_id AND a.t0_ns = k.t0_ns AND a.object_id = k.object_id
LEFT JOIN later_gap t2 ON t2.moment = 't2' AND t2.drive_id = k.drive_id AND t2.ego_id = k.ego_id AND t2.chain_id = k.chain_id AND t2.t0_ns = k.t0_ns AND t2.object_id = k.object_id
LEFT JOIN later_gap t3 ON t3.moment = 't3' AND t3.drive_id = k.drive_id AND t3.ego_id = k.ego_id AND t3.chain_id = k.chain_id AND t3.t0_ns = k.t0_ns AND t3.object_id = k.object_id
