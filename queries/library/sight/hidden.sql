-- Every actor that is or may be present without a position on the corridor, with a lower bound of its distance. After its last and before
-- its next sighting, it comes nearer at 60 m/s at most, within the limits of its tyres. Between two sightings, these limits keep a vehicle
-- near the straight line from one to the other, and beyond both near that through two sightings, whatever its velocities. An actor that drives along the road, in the ego's
-- direction or against it, neither turns round nor reverses. If the log is assumed to record every actor in plain view (data_log.in_sight),
-- an actor that is not recorded for a while is not in plain view. An actor off all lanes is not listed if the corridor extends further than
-- the actor's distance, ahead and behind, without a hole: the actor is then certainly off the road. What is in doubt of a sighting bounds
-- nothing: a sighting whose position is in doubt counts as none, and one whose velocity, heading or size is in doubt lacks it.
-- lifetime: part
CREATE TABLE hidden (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- an actor that is or may be present without a position on the corridor: it has no position or box, is lost, is beyond the map's end, or is straight ahead of a missing link or in a hole between two lanes
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    vehicle BOOLEAN NOT NULL,         -- the actor may be a vehicle {class}
    least_m DOUBLE NOT NULL,          -- lower bound of the distance from box to box, from the time and place of the last and next sighting that are not in doubt; if late, also from the part that is in plain view {position, heading, size}
    ahead BOOLEAN,                    -- the actor is ahead of the ego; NULL: it may be ahead or not {position}
    along BOOLEAN NOT NULL,           -- the actor moves in the ego's direction: by its last or next sighting on the corridor, not in doubt {position}
    late BOOLEAN NOT NULL,            -- the actor is not in plain view, where it would have been recorded: see _track_end {position}
    lane_m DOUBLE NOT NULL,           -- lower bound of the distance ahead, if the actor is in the ego's lane: least_m; if late, the part of the lane in plain view; if it is not on the map, the corridor's length {position}
    beside_lane BOOLEAN NOT NULL      -- the actor is not in the ego's lane: it is seen too far beside the lane, too short a time before or after, to be in it {position, heading, velocity}
);

INSERT INTO hidden BY NAME
WITH pair_without_position AS (
    SELECT drive_id, ego_id, t_ns, object_id, actor_class, off_level FROM pair WHERE x_m IS NULL OR y_m IS NULL
),
object_sample AS (
    SELECT s.drive_id, s.actor_id, s.t_ns
    FROM state_dynamics s
    SEMI JOIN pair_without_position n ON n.drive_id = s.drive_id AND n.object_id = s.actor_id
),
missing_step AS (
    -- A sample without a position still shows that the object is there.
    SELECT
        n.drive_id, n.ego_id, n.t_ns, n.object_id, n.actor_class, NOT n.off_level AND n.t_ns - s.t_ns > c.max_gap_ns AS is_unrecorded,
        NULL::DOUBLE AS ahead_m, NULL::DOUBLE AS behind_m, NULL::DOUBLE AS off_ahead_m, NULL::DOUBLE AS off_behind_m
    FROM pair_without_position n
    JOIN clock c USING (drive_id, ego_id)
    ASOF LEFT JOIN object_sample s ON s.drive_id = n.drive_id AND s.actor_id = n.object_id AND s.t_ns <= n.t_ns
    UNION ALL
    SELECT u.drive_id, u.ego_id, u.t_ns, u.object_id, a.actor_class, true, u.ahead_m, u.behind_m, u.off_ahead_m, u.off_behind_m
    FROM _unseen u
    JOIN road_user a ON a.drive_id = u.drive_id AND a.actor_id = u.object_id
),
corridor_range AS (
    SELECT drive_id, ego_id, chain_id, min(s_start_m) AS begin_m, max(s_start_m + length_m) AS end_m FROM _corridor GROUP BY ALL
),
-- Places where the lanes of a chain do not meet: an end without a link although the map continues, and holes between two consecutive lanes.
lanelet_end AS (
    SELECT
        c.drive_id, c.ego_id, c.chain_id, c.seq, c.seq = max(c.seq) OVER (PARTITION BY c.drive_id, c.ego_id, c.chain_id) AS is_last,
        g.environment_id, c.lanelet_id, c.s_start_m + c.length_m AS end_m,
        p.x1_m AS x_m, p.y1_m AS y_m, p.tx1 AS tx, p.ty1 AS ty, p.hw1_m AS half_width_m
    FROM _corridor c
    JOIN data_log g USING (drive_id)
    JOIN _lane_segment p ON p.environment_id = g.environment_id AND p.lanelet_id = c.lanelet_id AND p.slack1_m > 0
),
lane_hole AS (
    -- If only the link is missing, an object straight beyond the end of the lane is ahead.
    SELECT e.*, 'inf'::DOUBLE AS hole_length_m
    FROM lanelet_end e
    JOIN lane_next n ON n.environment_id = e.environment_id AND n.lanelet_id = e.lanelet_id
    WHERE e.is_last AND n.ahead_id IS NULL
    UNION ALL
    SELECT e.*, along0(f.x0_m, f.y0_m, e.x_m, e.y_m, e.tx, e.ty) AS hole_length_m
    FROM lanelet_end e
    JOIN _corridor c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.chain_id = e.chain_id AND c.seq = e.seq + 1
    JOIN _lane_segment f ON f.environment_id = e.environment_id AND f.lanelet_id = c.lanelet_id AND f.k = 0
    WHERE hole_length_m > f.slack0_m
),
object_without_position AS (SELECT DISTINCT drive_id, ego_id, object_id FROM missing_step),
-- The steps at which the log doubts a quantity of an object, or of the ego, from which the distances of objects are measured.
doubted_step AS (
    SELECT
        st.drive_id, st.ego_id, d.actor_id, st.t_ns, bool_or(doubts_place(d.quantity)) AS place, bool_or(d.quantity = 'velocity') AS velocity, bool_or(d.quantity = 'heading') AS heading, bool_or(d.quantity = 'size') AS size
    FROM doubt d
    JOIN step st ON st.drive_id = d.drive_id AND st.t_ns BETWEEN d.t_from_ns AND d.t_to_ns
    LEFT JOIN object_without_position o ON o.drive_id = st.drive_id AND o.ego_id = st.ego_id AND o.object_id = d.actor_id
    WHERE d.quantity <> 'class' AND (o.object_id IS NOT NULL OR d.actor_id = st.ego_id)
    GROUP BY ALL
),
credible_pair AS (
    SELECT
        p.drive_id, p.ego_id, p.object_id, p.t_ns, p.actor_class, p.distance_m, p.x_m, p.y_m, p.d_m, p.half_width_m, p.off_level, p.front_s_m, p.rear_s_m,
        coalesce(d.velocity, false) AS is_velocity_doubted,
        CASE WHEN d.velocity IS NOT true THEN p.speed_mps END AS speed_mps,
        CASE WHEN d.heading IS NOT true THEN p.yaw_rad END AS yaw_rad,
        CASE WHEN d.heading IS NOT true THEN p.heading_diff_rad END AS heading_diff_rad,
        CASE WHEN d.heading IS NOT true AND d.size IS NOT true THEN p.lat_half_m END AS lat_half_m,
        CASE WHEN d.size IS NOT true THEN p.length_m END AS length_m,
        CASE WHEN d.size IS NOT true THEN p.width_m END AS width_m,
        d.velocity IS true OR d.size IS true AS is_course_doubted
    FROM object_without_position u
    JOIN pair p ON p.drive_id = u.drive_id AND p.ego_id = u.ego_id AND p.object_id = u.object_id
    LEFT JOIN doubted_step d ON d.drive_id = p.drive_id AND d.ego_id = p.ego_id AND d.actor_id = p.object_id AND d.t_ns = p.t_ns
    ANTI JOIN (FROM doubted_step WHERE place AND actor_id = ego_id) e ON e.drive_id = p.drive_id AND e.ego_id = p.ego_id AND e.t_ns = p.t_ns
    WHERE p.distance_m IS NOT NULL AND d.place IS NOT true
),
sighting AS (
    SELECT
        p.drive_id, p.ego_id, p.object_id, p.t_ns, p.distance_m, p.x_m, p.y_m, box_half_diagonal_m(p.actor_class, p.length_m, p.width_m) AS half_diagonal_m,
        CASE WHEN p.actor_class = 'pedestrian' THEN 0.0 ELSE p.speed_mps * cos(p.yaw_rad) END AS vx_mps,
        CASE WHEN p.actor_class = 'pedestrian' THEN 0.0 ELSE p.speed_mps * sin(p.yaw_rad) END AS vy_mps,
        -- How far beside the ego's lane the object is, and how fast it may come nearer to that lane. The first velocity of a track may be
        -- missing: the velocity of the next sample replaces it. An object without a position beside a corridor without holes is outside the
        -- corridor's strip.
        CASE WHEN NOT p.is_velocity_doubted THEN coalesce(p.speed_mps, lead(p.speed_mps) OVER w, lag(p.speed_mps) OVER w) END AS v_mps,
        {
            'chain_id': e.chain_id, 'across_mps': v_mps * coalesce(abs(sin(p.heading_diff_rad)), 1.0), 'v_mps': v_mps,
            'm': CASE
                WHEN p.d_m IS NOT NULL THEN abs(p.d_m) - coalesce(p.lat_half_m, half_diagonal_m) - p.half_width_m
                WHEN NOT p.off_level AND h.chain_id IS NULL AND p.distance_m < least(z.end_m - e.s_m, e.s_m - z.begin_m) THEN strip_m() - half_diagonal_m - widest_lane_half_m()
            END
        } AS beside,
        -- Sightings half a second before and after this one.
        last_value({'t_ns': p.t_ns, 'x_m': p.x_m, 'y_m': p.y_m}) OVER (PARTITION BY p.drive_id, p.ego_id, p.object_id ORDER BY p.t_ns RANGE BETWEEN 1_000_000_000 PRECEDING AND 490_000_000 PRECEDING) AS earlier,
        first_value({'t_ns': p.t_ns, 'x_m': p.x_m, 'y_m': p.y_m}) OVER (PARTITION BY p.drive_id, p.ego_id, p.object_id ORDER BY p.t_ns RANGE BETWEEN 490_000_000 FOLLOWING AND 1_000_000_000 FOLLOWING) AS later,
        -- Position along the road of an object that moves in the ego's direction (1) or against it (-1).
        CASE
            WHEN p.actor_class IS NOT DISTINCT FROM 'pedestrian' OR p.is_course_doubted THEN NULL
            WHEN abs(p.heading_diff_rad) < pi() / 4
                THEN {'road': r.road, 'chain_id': r.chain_id, 'direction': 1, 'front_m': p.front_s_m + r.offset_m, 'rear_m': p.rear_s_m + r.offset_m, 'v_mps': p.speed_mps}
            WHEN abs(p.heading_diff_rad) > 3 * pi() / 4 AND p.speed_mps > moves_mps() AND is_vehicle(p.actor_class)
                THEN {'road': r.road, 'chain_id': r.chain_id, 'direction': -1, 'front_m': p.front_s_m + r.offset_m, 'rear_m': p.rear_s_m + r.offset_m, 'v_mps': p.speed_mps}
        END AS along
    FROM credible_pair p
    JOIN ego_state e ON e.drive_id = p.drive_id AND e.ego_id = p.ego_id AND e.t_ns = p.t_ns
    LEFT JOIN _ego_road r ON r.drive_id = e.drive_id AND r.ego_id = e.ego_id AND r.chain_id = e.chain_id
    LEFT JOIN corridor_range z ON z.drive_id = e.drive_id AND z.ego_id = e.ego_id AND z.chain_id = e.chain_id
    LEFT JOIN (SELECT DISTINCT drive_id, ego_id, chain_id FROM lane_hole WHERE NOT is_last) h ON h.drive_id = e.drive_id AND h.ego_id = e.ego_id AND h.chain_id = e.chain_id
    WINDOW w AS (PARTITION BY p.drive_id, p.ego_id, p.object_id ORDER BY p.t_ns)
),
-- Samples that the recorder wrote, in doubt or not: while it writes one, the object is not out of its sight.
written_sample AS (
    SELECT p.drive_id, p.ego_id, p.object_id, p.t_ns
    FROM object_without_position u
    JOIN pair p ON p.drive_id = u.drive_id AND p.ego_id = u.ego_id AND p.object_id = u.object_id
    WHERE p.distance_m IS NOT NULL
),
-- The least distance of the object after its last and before its next sighting. It moves straight on, or brakes or turns as hard as tyres
-- allow.
step_with_sightings AS (
    SELECT
        m.*, b.t_ns AS t_before_ns, a.t_ns AS t_after_ns, r.road, e.speed_mps, e.front_s_m + r.offset_m AS front_m, e.rear_s_m + r.offset_m AS rear_m, e.length_m, e.width_m, e.combination_m, coalesce(greatest(b.half_diagonal_m, a.half_diagonal_m), box_half_diagonal_m(m.actor_class, NULL, NULL)) AS half_diagonal_m,
        coalesce(
            g.in_sight AND m.is_unrecorded AND coalesce(wb.t_ns, wa.t_ns) IS NOT NULL
            AND (wb.t_ns IS NULL OR m.t_ns > tb.plain_ns) AND (wa.t_ns IS NULL OR m.t_ns < ta.plain_ns), false
        ) AS late,
        CASE WHEN b.along.road = r.road THEN b.along END AS last_place, CASE WHEN a.along.road = r.road THEN a.along END AS next_place,
        CASE WHEN b.along.chain_id = r.chain_id THEN 0.0 ELSE lane_station_error_m() END AS last_error_m,
        CASE WHEN a.along.chain_id = r.chain_id THEN 0.0 ELSE lane_station_error_m() END AS next_error_m,
        b.distance_m - unseen_closing_mps() * (m.t_ns - b.t_ns) / 1e9 AS least_since_m, a.distance_m - unseen_closing_mps() * (a.t_ns - m.t_ns) / 1e9 AS least_until_m,
        (m.t_ns - b.t_ns) / 1e9 AS since_s, (a.t_ns - m.t_ns) / 1e9 AS until_s,
        coalesce(b.beside.chain_id = e.chain_id AND b.beside.m > comes_beside_m(m.actor_class, b.beside.across_mps, b.beside.v_mps, since_s), false)
            OR coalesce(a.beside.chain_id = e.chain_id AND a.beside.m > comes_beside_m(m.actor_class, a.beside.across_mps, a.beside.v_mps, until_s), false) AS beside_lane,
        -- The place on the straight line between the two sightings, and how far from it a vehicle can be.
        b.x_m + (a.x_m - b.x_m) * since_s / nullif(since_s + until_s, 0) - e.x_m AS between_x_m, b.y_m + (a.y_m - b.y_m) * since_s / nullif(since_s + until_s, 0) - e.y_m AS between_y_m,
        CASE WHEN is_vehicle(m.actor_class) THEN measured_m() + line_error_m(since_s, until_s) END AS between_error_m,
        -- The same beyond the line through two sightings half a second apart.
        (b.t_ns - b.earlier.t_ns) / 1e9 AS back_s, (a.later.t_ns - a.t_ns) / 1e9 AS on_s,
        b.x_m + (b.x_m - b.earlier.x_m) * since_s / back_s - e.x_m AS since_x_m, b.y_m + (b.y_m - b.earlier.y_m) * since_s / back_s - e.y_m AS since_y_m,
        a.x_m + (a.x_m - a.later.x_m) * until_s / on_s - e.x_m AS until_x_m, a.y_m + (a.y_m - a.later.y_m) * until_s / on_s - e.y_m AS until_y_m,
        CASE WHEN is_vehicle(m.actor_class) THEN measured_m() * (1 + 2 * since_s / back_s) + line_error_m(since_s, since_s + back_s) END AS since_error_m,
        CASE WHEN is_vehicle(m.actor_class) THEN measured_m() * (1 + 2 * until_s / on_s) + line_error_m(until_s, until_s + on_s) END AS until_error_m,
        b.x_m + b.vx_mps * since_s - e.x_m AS last_x_m, b.y_m + b.vy_mps * since_s - e.y_m AS last_y_m, a.x_m - a.vx_mps * until_s - e.x_m AS next_x_m, a.y_m - a.vy_mps * until_s - e.y_m AS next_y_m
    FROM missing_step m
    ASOF LEFT JOIN sighting b ON b.drive_id = m.drive_id AND b.ego_id = m.ego_id AND b.object_id = m.object_id AND b.t_ns <= m.t_ns
    ASOF LEFT JOIN sighting a ON a.drive_id = m.drive_id AND a.ego_id = m.ego_id AND a.object_id = m.object_id AND a.t_ns >= m.t_ns
    ASOF LEFT JOIN written_sample wb ON wb.drive_id = m.drive_id AND wb.ego_id = m.ego_id AND wb.object_id = m.object_id AND wb.t_ns <= m.t_ns
    ASOF LEFT JOIN written_sample wa ON wa.drive_id = m.drive_id AND wa.ego_id = m.ego_id AND wa.object_id = m.object_id AND wa.t_ns >= m.t_ns
    JOIN ego_state e ON e.drive_id = m.drive_id AND e.ego_id = m.ego_id AND e.t_ns = m.t_ns
    JOIN data_log g ON g.drive_id = m.drive_id
    LEFT JOIN _ego_road r ON r.drive_id = e.drive_id AND r.ego_id = e.ego_id AND r.chain_id = e.chain_id
    LEFT JOIN _track_end tb ON tb.drive_id = m.drive_id AND tb.ego_id = m.ego_id AND tb.object_id = m.object_id AND tb.lost AND tb.t_ns = wb.t_ns
    LEFT JOIN _track_end ta ON ta.drive_id = m.drive_id AND ta.ego_id = m.ego_id AND ta.object_id = m.object_id AND NOT ta.lost AND ta.t_ns = wa.t_ns
),
-- The range of stations in which the object can be.
station_range AS (
    SELECT
        *,
        -- greatest() and least() ignore NULL, as intended here.
        greatest(
            last_place.rear_m - last_error_m + CASE last_place.direction WHEN 1 THEN drives_least_m(last_place.v_mps, since_s) ELSE -drives_most_m(last_place.v_mps, since_s) END,
            next_place.rear_m - next_error_m + CASE next_place.direction WHEN 1 THEN -drives_most_m(next_place.v_mps, until_s) ELSE drives_least_m(next_place.v_mps, until_s) END
        ) AS from_m,
        least(
            last_place.front_m + last_error_m + CASE last_place.direction WHEN 1 THEN drives_most_m(last_place.v_mps, since_s) ELSE -drives_least_m(last_place.v_mps, since_s) END,
            next_place.front_m + next_error_m + CASE next_place.direction WHEN 1 THEN -drives_least_m(next_place.v_mps, until_s) ELSE drives_most_m(next_place.v_mps, until_s) END
        ) AS to_m
    FROM step_with_sightings
),
distance_bound AS (
    SELECT
        drive_id, ego_id, t_ns, object_id, actor_class, late, beside_lane, t_before_ns, t_after_ns, road, speed_mps, coalesce(last_place, next_place) IS NOT NULL AS is_on_road,
        half_diagonal_m + greatest(box_half_diagonal_m(NULL, length_m, width_m), trailer_reach_m(length_m, combination_m)) AS half_sizes_m,
        greatest(least_since_m, least_until_m, sqrt(last_x_m ** 2 + last_y_m ** 2) - strays_m(actor_class, since_s), sqrt(next_x_m ** 2 + next_y_m ** 2) - strays_m(actor_class, until_s), sqrt(between_x_m ** 2 + between_y_m ** 2) - between_error_m, sqrt(since_x_m ** 2 + since_y_m ** 2) - since_error_m, sqrt(until_x_m ** 2 + until_y_m ** 2) - until_error_m, ahead_m, behind_m, CASE WHEN off_ahead_m IS NOT NULL THEN least(off_ahead_m, off_behind_m) END) AS distance_m,
        greatest(from_m - front_m, rear_m - to_m) AS along_m, off_ahead_m - half_diagonal_m AS off_ahead_m,
        CASE WHEN ahead_m > 0 OR from_m > front_m THEN true WHEN behind_m > 0 OR to_m < rear_m THEN false END AS ahead,
        coalesce(CASE WHEN t_before_ns IS NOT NULL THEN last_place.direction = 1 ELSE true END AND CASE WHEN t_after_ns IS NOT NULL THEN next_place.direction = 1 ELSE true END AND coalesce(t_before_ns, t_after_ns) IS NOT NULL, false) AS along
    FROM station_range
),
-- While everything around the ego is in plain view, no vehicle can pass the ego unseen. An object that is ahead (or behind) at the
-- beginning of such a time is so until its end. One that is ahead (or behind) at its end was so from its beginning.
view_step AS (
    SELECT
        b.*, g.around_m, g.lane_m AS lane_in_view_m,
        b.late AND coalesce(g.around_m >= watched_m(b.speed_mps, greatest(b.t_ns - lag(b.t_ns) OVER w, lead(b.t_ns) OVER w - b.t_ns) / 1e9), false) AS is_in_view
    FROM distance_bound b
    LEFT JOIN _sight g USING (drive_id, ego_id, t_ns)
    WINDOW w AS (PARTITION BY b.drive_id, b.ego_id, b.object_id ORDER BY b.t_ns)
),
unwatched_count AS (
    SELECT
        *, sum((NOT is_in_view)::INTEGER) OVER (PARTITION BY drive_id, ego_id, object_id, road, t_before_ns ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS n_unwatched_since,
        sum((NOT is_in_view)::INTEGER) OVER (PARTITION BY drive_id, ego_id, object_id, road, t_after_ns ORDER BY t_ns DESC ROWS UNBOUNDED PRECEDING) AS n_unwatched_until
    FROM view_step
),
object_ahead_or_behind AS (
    SELECT
        * REPLACE (coalesce(ahead, CASE WHEN is_on_road AND earlier_order.n = n_unwatched_since THEN earlier_order.ahead END, CASE WHEN is_on_road AND later_order.n = n_unwatched_until THEN later_order.ahead END) AS ahead)
    FROM (
        SELECT
            *,
            last_value(CASE WHEN ahead IS NOT NULL AND is_on_road THEN {'ahead': ahead, 'n': n_unwatched_since} END IGNORE NULLS)
                OVER (PARTITION BY drive_id, ego_id, object_id, road, t_before_ns ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS earlier_order,
            last_value(CASE WHEN ahead IS NOT NULL AND is_on_road THEN {'ahead': ahead, 'n': n_unwatched_until} END IGNORE NULLS)
                OVER (PARTITION BY drive_id, ego_id, object_id, road, t_after_ns ORDER BY t_ns DESC ROWS UNBOUNDED PRECEDING) AS later_order
        FROM unwatched_count
    )
),
incomplete_pair AS (
    SELECT drive_id, ego_id, t_ns, object_id, actor_class, distance_m, x_m, y_m, box_half_diagonal_m(actor_class, length_m, width_m) AS half_diagonal_m, both_half_diagonals_m() AS least_sizes_m, false AS along
    FROM pair
    WHERE x_m IS NOT NULL AND y_m IS NOT NULL AND (yaw_rad IS NULL OR length_m IS NULL OR width_m IS NULL)
),
-- Objects off the lanes and beyond the end of the corridor: they may be on a part of the road that the map lacks.
pair_beyond_corridor AS (
    SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, p.actor_class, p.distance_m, p.x_m, p.y_m, box_half_diagonal_m(p.actor_class, p.length_m, p.width_m) AS half_diagonal_m, both_half_diagonals_m() AS least_sizes_m, false AS along
    FROM unplaced u
    JOIN pair p ON p.drive_id = u.drive_id AND p.ego_id = u.ego_id AND p.t_ns = u.t_ns AND p.object_id = u.object_id
    JOIN ego_state e ON e.drive_id = u.drive_id AND e.ego_id = u.ego_id AND e.t_ns = u.t_ns
    JOIN corridor_range r ON r.drive_id = e.drive_id AND r.ego_id = e.ego_id AND r.chain_id = e.chain_id
    ANTI JOIN (FROM data_log WHERE environment_id IS NULL) g ON g.drive_id = u.drive_id
    WHERE u.code = 'off_lanes' AND p.s_m IS NULL AND p.distance_m > least(r.end_m - e.s_m, e.s_m - r.begin_m)
    UNION ALL
    -- Without a map: objects further away than the end of the ego's own path.
    SELECT
        p.drive_id, p.ego_id, p.t_ns, p.object_id, p.actor_class, p.distance_m, p.x_m, p.y_m,
        box_half_diagonal_m(p.actor_class, p.length_m, p.width_m) AS half_diagonal_m, 0.0 AS least_sizes_m,
        -- An object that stands or moves away does not come towards the ego.
        coalesce(p.speed_mps <= standing_mps() OR (p.x_m - e.x_m) * cos(p.yaw_rad) + (p.y_m - e.y_m) * sin(p.yaw_rad) > 0, false) AS along
    FROM pair p
    SEMI JOIN (FROM data_log WHERE environment_id IS NULL) g ON g.drive_id = p.drive_id
    JOIN ego_state e ON e.drive_id = p.drive_id AND e.ego_id = p.ego_id AND e.t_ns = p.t_ns
    JOIN corridor_range r ON r.drive_id = e.drive_id AND r.ego_id = e.ego_id AND r.chain_id = e.chain_id
    WHERE p.x_m IS NOT NULL AND p.s_m IS NULL AND p.distance_m < corridor_ahead_m() AND p.distance_m > r.end_m - e.s_m
),
hole_bucket AS (SELECT *, unnest(range(floor(end_m / 500)::BIGINT - 2, floor(end_m / 500)::BIGINT + 1)) AS bucket FROM lane_hole),
pair_in_hole AS (
    SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, p.actor_class, p.distance_m, p.x_m, p.y_m, box_half_diagonal_m(p.actor_class, p.length_m, p.width_m) AS half_diagonal_m, both_half_diagonals_m() AS least_sizes_m, false AS along
    FROM ego_state e
    JOIN hole_bucket l ON l.drive_id = e.drive_id AND l.ego_id = e.ego_id AND l.chain_id = e.chain_id AND l.bucket = floor(e.s_m / 500)::BIGINT
    JOIN pair p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.t_ns = e.t_ns
    WHERE p.s_m IS NULL AND e.s_m < l.end_m AND along0(p.x_m, p.y_m, l.x_m, l.y_m, l.tx, l.ty) > 0
        AND along0(p.x_m, p.y_m, l.x_m, l.y_m, l.tx, l.ty) <= l.hole_length_m
        AND abs((p.y_m - l.y_m) * l.tx - (p.x_m - l.x_m) * l.ty) < l.half_width_m + 1
)
-- occasion: missing_step, incomplete_pair, pair_beyond_corridor, pair_in_hole
SELECT
    drive_id, ego_id, t_ns, object_id, actor_class, may_be_vehicle(actor_class) AS vehicle,
    greatest(0.0::DOUBLE, coalesce(distance_m, 0.0) - half_sizes_m, along_m, CASE WHEN late THEN coalesce(around_m, 0.0) - half_sizes_m END) AS least_m, ahead, along, late,
    greatest(least_m, off_ahead_m, CASE WHEN late THEN lane_in_view_m END) AS lane_m, beside_lane
FROM object_ahead_or_behind
UNION ALL
SELECT
    h.drive_id, h.ego_id, h.t_ns, h.object_id, h.actor_class, may_be_vehicle(h.actor_class),
    -- The trailer is behind the ego.
    greatest(0.0::DOUBLE, coalesce(h.distance_m, 0.0) - greatest(x.half_sizes_m, greatest(h.least_sizes_m / 2, h.half_diagonal_m) + trailer_reach_m(e.length_m, e.combination_m))),
    CASE WHEN h.distance_m > x.half_sizes_m THEN (h.x_m - e.x_m) * cos(e.yaw_rad) + (h.y_m - e.y_m) * sin(e.yaw_rad) > 0 END,
    h.along, false, greatest(0.0::DOUBLE, coalesce(h.distance_m, 0.0) - x.half_sizes_m), false
FROM (SELECT * FROM incomplete_pair UNION ALL SELECT * FROM pair_beyond_corridor UNION SELECT * FROM pair_in_hole) h
JOIN ego_state e USING (drive_id, ego_id, t_ns)
CROSS JOIN LATERAL (SELECT greatest(h.least_sizes_m, h.half_diagonal_m + box_half_diagonal_m(NULL, e.length_m, e.width_m)) AS half_sizes_m) x
