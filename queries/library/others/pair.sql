-- The ego and every other actor, one row per ego step from the actor's first sample to its last. If an actor's sample has another time than
-- the step, its position is extrapolated with its own velocity while the sample is fresh. After that, the actor is present without a
-- position. An actor that is over or under the ego's road by the log's heights, or beside it on another level, has no row: the ego does not
-- meet it there. An actor that may be over or under the road has a row without a position: in plan it is on the road, but it is not known
-- whether the ego meets it.
-- lifetime: part
CREATE TABLE pair (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the ego's step
    object_id VARCHAR NOT NULL,       -- an actor that is not part of the ego; one row per step from its first to its last sample, but none while reliable heights show it over, under or beside the ego's road on another level
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    x_m DOUBLE,                       -- the object's box centre, x; NULL: no position (not recorded, stale, a hole in the track, or off_level) {position}
    y_m DOUBLE,                       -- the object's box centre, y {position}
    yaw_rad DOUBLE,                   -- the object's heading; of a reversing vehicle the opposite heading (see travel_rad of state_dynamics) {heading}
    speed_mps DOUBLE,                 -- the object's speed {velocity}
    accel_mps2 DOUBLE,                -- see state_dynamics {velocity}
    length_m DOUBLE,                  -- the object's box length {size}
    width_m DOUBLE,                   -- the object's box width {size}
    distance_m DOUBLE,                -- distance from centre to centre {position}
    off_level BOOLEAN NOT NULL,       -- the object is or may be over or under the ego's road: the map has another road there, or the log's heights are not reliable; no row if reliable heights show it {position}
    clearance_m DOUBLE,               -- distance between the two boxes (the trailer's box included); negative: depth of overlap; only a lower bound beyond 30 m and while off_level; NULL also if off_level and the boxes overlap in plan {position, heading, size}
    clearance_is_bound BOOLEAN,       -- clearance_m is only a lower bound {position, heading, size}
    s_m DOUBLE,                       -- station of the object's centre on the ego's running chain; NULL: outside the corridor's strip {position}
    d_m DOUBLE,                       -- offset of the object's centre from the running lane's centre line, left positive {position}
    front_s_m DOUBLE,                 -- the object's furthest station along the ego's direction {position, heading, size}
    rear_s_m DOUBLE,                  -- the object's nearest station along the ego's direction {position, heading, size}
    lat_half_m DOUBLE,                -- half the extent of the object's box across the corridor {heading, size}
    heading_diff_rad DOUBLE,          -- the object's heading relative to the corridor, -pi..pi {heading}
    half_width_m DOUBLE,              -- half width of the running lane at the object's station
    over_width_m DOUBLE,              -- see _corridor
    over_against BOOLEAN              -- see _corridor {position, heading, size}
);

INSERT INTO pair BY NAME
WITH sample_at_step AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, e.k, s.actor_id AS object_id, s.actor_class, s.t_ns AS t_sample_ns, s.x_m, s.y_m, s.z_m,
        yaw_along_travel_rad(s.yaw_rad, s.travel_rad) AS yaw_rad, s.speed_mps, s.accel_mps2, s.length_m, s.width_m
    FROM step e
    JOIN state_dynamics s ON s.drive_id = e.drive_id AND s.t_ns = e.t_ns AND s.actor_id <> e.ego_id
    ANTI JOIN _ego_part g ON g.drive_id = e.drive_id AND g.ego_id = e.ego_id AND g.object_id = s.actor_id
),
track AS (
    SELECT c.drive_id, c.ego_id, s.object_id, s.t_first_ns, s.t_last_ns, s.n_samples
    FROM clock c
    JOIN (
        SELECT drive_id, actor_id AS object_id, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns, count(*) AS n_samples FROM state_dynamics GROUP BY ALL
    ) s ON s.drive_id = c.drive_id AND s.object_id <> c.ego_id
    ANTI JOIN _ego_part g ON g.drive_id = c.drive_id AND g.ego_id = c.ego_id AND g.object_id = s.object_id
),
track_at_steps AS (
    SELECT drive_id, ego_id, object_id, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns, max(k) - min(k) + 1 AS n_steps, count(*) AS n_samples
    FROM sample_at_step
    GROUP BY ALL
),
-- Only actors that lack a step, or have samples between the steps, are examined further.
irregular_track AS (
    SELECT t.drive_id, t.ego_id, t.object_id, t.t_first_ns, t.t_last_ns
    FROM track t
    LEFT JOIN track_at_steps m USING (drive_id, ego_id, object_id)
    WHERE m.n_samples IS NULL OR m.n_samples <> t.n_samples OR m.n_steps <> m.n_samples
),
missed_step AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, r.object_id
    FROM irregular_track r
    JOIN step e ON e.drive_id = r.drive_id AND e.ego_id = r.ego_id AND e.t_ns >= r.t_first_ns AND e.t_ns <= r.t_last_ns
    ANTI JOIN sample_at_step s ON s.drive_id = e.drive_id AND s.ego_id = e.ego_id AND s.t_ns = e.t_ns AND s.object_id = r.object_id
),
last_sample AS (
    SELECT m.drive_id, m.ego_id, m.t_ns, m.object_id, (m.t_ns - s.t_ns) / 1e9 AS age_s, m.t_ns - s.t_ns <= c.max_gap_ns AS is_fresh, s.t_ns AS t_sample_ns, s.* EXCLUDE (drive_id, actor_id, t_ns)
    FROM missed_step m
    JOIN clock c USING (drive_id, ego_id)
    -- Only these tracks are sorted: to sort every track would cost more than all other work.
    ASOF JOIN (
        SELECT s.* FROM state_dynamics s
        SEMI JOIN irregular_track r ON r.drive_id = s.drive_id AND r.object_id = s.actor_id
    ) s ON s.drive_id = m.drive_id AND s.actor_id = m.object_id AND s.t_ns <= m.t_ns
),
object_at_step AS (
    SELECT * EXCLUDE (k) FROM sample_at_step
    UNION ALL BY NAME
    SELECT
        drive_id, ego_id, t_ns, object_id, actor_class, length_m, width_m, t_sample_ns, z_m,
        CASE WHEN is_fresh THEN x_m + vx_mps * age_s END AS x_m, CASE WHEN is_fresh THEN y_m + vy_mps * age_s END AS y_m,
        CASE WHEN is_fresh THEN yaw_along_travel_rad(yaw_rad, travel_rad) END AS yaw_rad, CASE WHEN is_fresh THEN speed_mps END AS speed_mps, CASE WHEN is_fresh THEN accel_mps2 END AS accel_mps2
    FROM last_sample
),
pair_offset AS MATERIALIZED (
    SELECT
        o.*, e.chain_id, e.s_m AS ego_s_m, e.z_m AS ego_z_m, e.yaw_rad AS ego_yaw_rad, e.length_m / 2 AS ego_half_length_m, e.width_m / 2 AS ego_half_width_m,
        o.length_m / 2 AS object_half_length_m, o.width_m / 2 AS object_half_width_m, o.x_m - e.x_m AS east_m, o.y_m - e.y_m AS north_m,
        sqrt((o.x_m - e.x_m) ** 2 + (o.y_m - e.y_m) ** 2) AS distance_m,
        row_number() OVER () AS pair_no
    FROM object_at_step o
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
),
pair_clearance AS (
    SELECT
        *,
        CASE
            WHEN least_m > exact_clearance_m() THEN least_m
            WHEN least_m + dx + c IS NOT NULL THEN box_clearance(dx, dy, c, s, ego_half_length_m, ego_half_width_m, object_half_length_m, object_half_width_m)
        END AS clearance_m,
        CASE WHEN least_m IS NOT NULL THEN least_m > exact_clearance_m() END AS clearance_is_bound
    FROM (
        -- The object's box in the frame of the ego's box. These are columns, because a macro repeats its arguments wherever it uses them.
        SELECT
            *, CASE WHEN is_near THEN east_m * cos(ego_yaw_rad) + north_m * sin(ego_yaw_rad) END AS dx, CASE WHEN is_near THEN north_m * cos(ego_yaw_rad) - east_m * sin(ego_yaw_rad) END AS dy,
            CASE WHEN is_near THEN cos(yaw_rad - ego_yaw_rad) END AS c, CASE WHEN is_near THEN sin(yaw_rad - ego_yaw_rad) END AS s
        FROM (
            SELECT *, least_m <= exact_clearance_m() AS is_near
            FROM (SELECT *, distance_m - sqrt(ego_half_length_m * ego_half_length_m + ego_half_width_m * ego_half_width_m) - sqrt(object_half_length_m * object_half_length_m + object_half_width_m * object_half_width_m) AS least_m FROM pair_offset)
        )
    )
),
segment_candidate AS (
    SELECT
        a.pair_no, a.drive_id, a.ego_id, a.chain_id, a.x_m, a.y_m, a.yaw_rad, a.ego_s_m, c.* EXCLUDE (drive_id, ego_id, cell),
        along0(a.x_m, a.y_m, c.x0_m, c.y0_m, c.tx0, c.ty0) AS a0,
        along1(a.x_m, a.y_m, c.x1_m, c.y1_m, c.tx1, c.ty1) AS a1
    FROM pair_offset a
    JOIN _corridor_cell c ON c.drive_id = a.drive_id AND c.ego_id = a.ego_id AND c.cell = corridor_cell_of(a.x_m, a.y_m)
    -- The conditions repeat the expressions of a0 and a1, because DuckDB then filters before it computes the other columns.
    WHERE a.ego_s_m IS NOT NULL
        AND along0(a.x_m, a.y_m, c.x0_m, c.y0_m, c.tx0, c.ty0) >= -c.slack0_m AND along1(a.x_m, a.y_m, c.x1_m, c.y1_m, c.tx1, c.ty1) > -c.slack1_m
),
object_on_strip AS (
    SELECT
        pair_no, drive_id, ego_id, chain_id, ego_s_m, lanelet_id, s0_m + u * len_m AS lane_s_m, d_m, hw0_m + u * (hw1_m - hw0_m) AS half_width_m,
        wrap_rad(yaw_rad - atan2(ty0 + u * (ty1 - ty0), tx0 + u * (tx1 - tx0))) AS lane_heading_diff_rad, ego_s_m - lane_s_m AS level_start_m
    FROM (
        SELECT *, a0 / (a0 + a1) AS u, offset_left(x_m, y_m, a0 / (a0 + a1), x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1) AS d_m
        FROM segment_candidate
        WHERE a0 + a1 > 0
    )
    WHERE abs(d_m) <= strip_m()
),
-- An ego on a ring road has a lanelet on its chain once per lap. `level_start_m` is the station at which the lanelet would start if the
-- object were level with the ego. The object's lap is the one whose start is nearest to this station: from_m < level_start_m <= to_m. An
-- oncoming object at most 1.2 km ahead is always ahead, even if it is nearer round the ring in the other direction.
lap_end AS (
    SELECT
        * EXCLUDE (next_start_m),
        -- NULL in the last lap: least() and greatest() would ignore it.
        CASE
            WHEN next_start_m IS NULL THEN NULL
            WHEN is_oncoming THEN least((s_start_m + next_start_m) / 2, greatest(s_start_m + exact_clearance_m(), next_start_m - 1200))
            ELSE (s_start_m + next_start_m) / 2
        END AS to_m
    FROM (
        SELECT *, lead(s_start_m) OVER (PARTITION BY drive_id, ego_id, chain_id, lanelet_id, is_oncoming ORDER BY s_start_m) AS next_start_m
        FROM _corridor CROSS JOIN (VALUES (false), (true)) AS v(is_oncoming)
    )
),
lap AS (
    SELECT *, lag(to_m) OVER (PARTITION BY drive_id, ego_id, chain_id, lanelet_id, is_oncoming ORDER BY s_start_m) AS from_m
    FROM lap_end
),
-- The laps by kilometre of level_start_m. Only objects within about 1.2 km of the ego count.
lap_bucket AS (
    SELECT
        *, unnest(range(floor(greatest(from_m, s_start_m - 2200 - length_m) / 1000)::BIGINT, floor(least(to_m, s_start_m + length_m + 2200) / 1000)::BIGINT + 1)) AS bucket,
        floor((s_start_m - 1200) / 1000) AS first_km, floor((s_start_m + length_m + 1200) / 1000) AS last_km
    FROM lap
),
chain_place AS MATERIALIZED (
    SELECT
        b.pair_no, c.s_start_m + b.lane_s_m AS s_m, b.d_m, b.half_width_m, b.lane_heading_diff_rad, c.over_width_m, c.over_against, b.lanelet_id, b.ego_s_m, c.is_oncoming
    FROM object_on_strip b
    JOIN lap_bucket c ON c.drive_id = b.drive_id AND c.ego_id = b.ego_id AND c.lanelet_id = b.lanelet_id AND c.chain_id = b.chain_id
        AND c.is_oncoming = coalesce(abs(b.lane_heading_diff_rad) > pi() / 2, false) AND c.bucket = floor(b.level_start_m / 1000)::BIGINT
    WHERE coalesce(b.level_start_m > c.from_m, true) AND coalesce(b.level_start_m <= c.to_m, true)
        AND floor(b.ego_s_m / 1000) BETWEEN c.first_km AND c.last_km
),
-- If a corridor meets itself, an object has several positions on it. The one nearest to the ego along the corridor counts, and if two are
-- equal, the lower station.
pair_with_several_places AS MATERIALIZED (SELECT pair_no FROM chain_place GROUP BY pair_no HAVING count(*) > 1),
nearest_place AS (
    SELECT
        pair_no,
        min({
            'off': abs(s_m - ego_s_m)
                -- An object is beside the road only if it is nowhere on it: the two arms of a hairpin bend are in each other's strip.
                + CASE WHEN abs(d_m) > half_width_m + coalesce(over_width_m, 2 * half_width_m) THEN 1e8 ELSE 0.0 END
                + CASE WHEN is_oncoming AND s_m < ego_s_m - exact_clearance_m() THEN 1e6 ELSE 0.0 END,
            's_m': s_m, 'd_m': d_m, 'half_width_m': half_width_m, 'lane_heading_diff_rad': lane_heading_diff_rad, 'over_width_m': over_width_m, 'over_against': over_against,
            'lanelet_id': lanelet_id
        }) AS p
    FROM chain_place SEMI JOIN pair_with_several_places USING (pair_no)
    GROUP BY pair_no
),
object_place AS (
    SELECT * EXCLUDE (ego_s_m, is_oncoming) FROM chain_place ANTI JOIN pair_with_several_places USING (pair_no)
    UNION ALL
    SELECT pair_no, p.s_m, p.d_m, p.half_width_m, p.lane_heading_diff_rad, p.over_width_m, p.over_against, p.lanelet_id FROM nearest_place
),
-- ---- levels: objects whose box, in plan, covers the running lane or one lane's width beside it, if heights or the map give the level
drive_with_overpass AS (SELECT DISTINCT g.drive_id FROM data_log g SEMI JOIN _lane_apart l ON l.environment_id = g.environment_id),
pair_over_road AS MATERIALIZED (
    SELECT a.pair_no, a.drive_id, a.ego_id, a.chain_id, a.object_id, a.t_sample_ns, p.lane_heading_diff_rad, p.lanelet_id
    FROM (
        SELECT * FROM pair_offset WHERE z_m IS NOT NULL
        UNION ALL
        SELECT * FROM pair_offset SEMI JOIN drive_with_overpass USING (drive_id) WHERE z_m IS NULL
    ) a
    JOIN object_place p USING (pair_no)
    WHERE abs(p.d_m) - coalesce(a.object_half_length_m * abs(sin(p.lane_heading_diff_rad)) + a.object_half_width_m * abs(cos(p.lane_heading_diff_rad)), 0.0) < p.half_width_m + greatest(coalesce(p.over_width_m, 0.0), 2 * p.half_width_m)
),
-- An ego that stands has several samples at one station: the lowest height is taken.
ego_height AS (SELECT drive_id, ego_id, chain_id, s_m, min({'z_m': z_m, 't_ns': t_ns}) AS lowest FROM ego_state WHERE s_m IS NOT NULL AND z_m IS NOT NULL GROUP BY ALL),
-- Actors with a height, and whether this is the height of a vehicle on a road. A simulator may let a vehicle fall through the ground.
actor_height AS (
    SELECT
        s.drive_id, s.actor_id, a.height_m,
        bool_or(is_measured_height(s.z_m, a.height_m))
            AND max(s.z_m) - min(s.z_m) <= level_m() + steepest() * from_picometres(sum(to_picometres(s.speed_mps))) / count(s.speed_mps) * (max(s.t_ns) - min(s.t_ns)) / 1e9 AS is_measured
    FROM state_dynamics s
    JOIN actor a USING (drive_id, actor_id)
    WHERE s.z_m IS NOT NULL
    GROUP BY ALL
),
pair_with_height AS MATERIALIZED (
    SELECT a.pair_no, a.drive_id, a.ego_id, a.chain_id, a.t_ns, a.z_m, a.ego_z_m, a.distance_m, p.s_m, level_gap_m(e.height_m, o.height_m) AS level_gap_m, e.is_measured AND o.is_measured AS is_measured
    FROM pair_offset a
    JOIN actor_height e ON e.drive_id = a.drive_id AND e.actor_id = a.ego_id
    JOIN actor_height o ON o.drive_id = a.drive_id AND o.actor_id = a.object_id
    LEFT JOIN object_place p USING (pair_no)
    WHERE a.z_m IS NOT NULL
),
-- The object's height relative to the ego's, where the ego is nearest to that place, before or after. If the object has no position on the
-- corridor, the height relative to the ego's at that step.
height_difference AS MATERIALIZED (
    SELECT
        pair_no, abs(dz_m) > level_gap_m + steepest() * along_m AS is_apart, abs(dz_m) <= level_m() AND steepest() * along_m <= level_m() AS is_same,
        is_measured AND abs(dz_m) < highest_m() AND abs(dz_m) > level_gap_m + steepest() * along_m + height_drift_mps() * later_s AS is_surely_apart
    FROM (
        SELECT
            o.pair_no, o.level_gap_m, o.is_measured, o.z_m - CASE WHEN b.s_m IS NULL OR a.s_m - o.s_m < o.s_m - b.s_m THEN a.lowest.z_m ELSE b.lowest.z_m END AS dz_m,
            abs(o.t_ns - CASE WHEN b.s_m IS NULL OR a.s_m - o.s_m < o.s_m - b.s_m THEN a.lowest.t_ns ELSE b.lowest.t_ns END) / 1e9 AS later_s,
            -- least() ignores NULL, as intended here.
            least(a.s_m - o.s_m, o.s_m - b.s_m) AS along_m
        FROM pair_with_height o
        ASOF LEFT JOIN ego_height b ON b.drive_id = o.drive_id AND b.ego_id = o.ego_id AND b.chain_id = o.chain_id AND b.s_m <= o.s_m
        ASOF LEFT JOIN ego_height a ON a.drive_id = o.drive_id AND a.ego_id = o.ego_id AND a.chain_id = o.chain_id AND a.s_m >= o.s_m
        WHERE o.s_m IS NOT NULL
        UNION ALL
        SELECT pair_no, level_gap_m, is_measured, z_m - ego_z_m, 0.0, distance_m FROM pair_with_height WHERE s_m IS NULL
    )
),
-- Pairs on different levels, certainly or possibly.
pair_off_level AS (
    SELECT pair_no FROM height_difference SEMI JOIN pair_over_road USING (pair_no) WHERE is_apart
    UNION
    -- As far as the map shows, the object is in a lane over or under the ego's, unless it heads along the ego's lane and not along the
    -- other lane.
    SELECT v.pair_no
    FROM pair_over_road v
    JOIN data_log g USING (drive_id)
    JOIN lane_occupancy o ON o.drive_id = v.drive_id AND o.actor_id = v.object_id AND o.t_ns = v.t_sample_ns
    JOIN _lane_apart l ON l.environment_id = g.environment_id AND l.lanelet_id = v.lanelet_id AND l.other_id = o.lanelet_id
    ANTI JOIN (FROM height_difference WHERE is_same) h ON h.pair_no = v.pair_no
    WHERE coalesce(NOT along_lane(v.lane_heading_diff_rad) OR along_lane(o.heading_diff_rad), true)
),
pair_level AS (
    SELECT pair_no, bool_or(is_surely_apart) AS is_surely_apart
    FROM (
        SELECT pair_no, false AS is_surely_apart FROM pair_off_level
        UNION ALL
        SELECT pair_no, true FROM height_difference WHERE is_surely_apart
    )
    GROUP BY pair_no
),
-- ---- the trailer's box also belongs to the ego: the nearer of the two boxes counts
trailer_clearance AS (
    SELECT
        pair_no,
        min(CASE
            WHEN least_m > exact_clearance_m() THEN least_m
            WHEN is_known THEN box_clearance(dx, dy, c, s, trailer_half_length_m, trailer_half_width_m, object_half_length_m, object_half_width_m)
        END) AS clearance_m
    FROM (
        -- The object's box in the frame of the trailer's box, as columns.
        SELECT
            a.pair_no, l.least_m, l.least_m + a.yaw_rad + s.yaw_rad IS NOT NULL AS is_known,
            (a.x_m - s.x_m) * cos(s.yaw_rad) + (a.y_m - s.y_m) * sin(s.yaw_rad) AS dx, (a.y_m - s.y_m) * cos(s.yaw_rad) - (a.x_m - s.x_m) * sin(s.yaw_rad) AS dy,
            cos(a.yaw_rad - s.yaw_rad) AS c, sin(a.yaw_rad - s.yaw_rad) AS s,
            s.length_m / 2 AS trailer_half_length_m, s.width_m / 2 AS trailer_half_width_m, a.object_half_length_m, a.object_half_width_m
        FROM pair_offset a
        JOIN (FROM _ego_part WHERE part = 'trailer') g ON g.drive_id = a.drive_id AND g.ego_id = a.ego_id
        LEFT JOIN state_dynamics s ON s.drive_id = g.drive_id AND s.actor_id = g.object_id AND s.t_ns = a.t_ns
        CROSS JOIN LATERAL (
            SELECT sqrt((a.x_m - s.x_m) ** 2 + (a.y_m - s.y_m) ** 2) - sqrt((s.length_m / 2) ** 2 + (s.width_m / 2) ** 2) - sqrt(a.object_half_length_m ** 2 + a.object_half_width_m ** 2) AS least_m
        ) l
    )
    GROUP BY pair_no
),
combined_clearance AS (
    SELECT
        * EXCLUDE (clearance_m, clearance_is_bound, has_trailer, trailer_m),
        CASE WHEN has_trailer THEN nearer_m > exact_clearance_m() ELSE clearance_is_bound END AS clearance_is_bound, nearer_m AS clearance_m
    FROM (
        SELECT
            c.*, d.pair_no IS NOT NULL AS has_trailer, d.clearance_m AS trailer_m,
            -- A contact of either box is a contact. To exclude a contact, both clearances must be known.
            CASE
                WHEN d.pair_no IS NULL OR c.clearance_m <= 0 THEN c.clearance_m
                WHEN d.clearance_m <= 0 OR c.clearance_m + d.clearance_m IS NOT NULL THEN least(c.clearance_m, d.clearance_m)
            END AS nearer_m
        FROM pair_clearance c
        LEFT JOIN trailer_clearance d USING (pair_no)
    )
),
pair_with_place AS (
    SELECT
        c.*, p.s_m, p.d_m, p.lane_heading_diff_rad, p.half_width_m, p.over_width_m, p.over_against,
        -- If the object has no position on the corridor, its level matters only in a contact.
        o.pair_no IS NOT NULL OR coalesce(p.pair_no IS NULL AND c.clearance_m <= 0 AND NOT same_level(c.z_m, c.ego_z_m), false) AS off_level
    FROM combined_clearance c
    LEFT JOIN pair_level o ON o.pair_no = c.pair_no
    -- The join uses only keys: a condition on the left side would make it a nested loop.
    LEFT JOIN object_place p ON p.pair_no = CASE WHEN o.pair_no IS NULL THEN c.pair_no END
    WHERE o.is_surely_apart IS DISTINCT FROM true
)
SELECT
    drive_id, ego_id, t_ns, object_id, actor_class, off_level,
    CASE WHEN NOT off_level THEN x_m END AS x_m, CASE WHEN NOT off_level THEN y_m END AS y_m, yaw_rad, speed_mps, accel_mps2,
    length_m, width_m, distance_m,
    -- On another level, the object is at least as far away as in plan.
    CASE WHEN NOT off_level OR clearance_m > 0 THEN clearance_m END AS clearance_m,
    CASE WHEN NOT off_level THEN clearance_is_bound WHEN clearance_m > 0 THEN true END AS clearance_is_bound,
    s_m, d_m,
    s_m + object_half_length_m * abs(cos(lane_heading_diff_rad)) + object_half_width_m * abs(sin(lane_heading_diff_rad)) AS front_s_m,
    s_m - object_half_length_m * abs(cos(lane_heading_diff_rad)) - object_half_width_m * abs(sin(lane_heading_diff_rad)) AS rear_s_m,
    object_half_length_m * abs(sin(lane_heading_diff_rad)) + object_half_width_m * abs(cos(lane_heading_diff_rad)) AS lat_half_m,
    lane_heading_diff_rad AS heading_diff_rad, half_width_m, over_width_m, over_against
FROM pair_with_place
