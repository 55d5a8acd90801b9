-- Steps with a corner over a boundary of the running lane. A stretch is one boundary of the road: changing lanes, the left boundary of the
-- one is the right boundary of the other.
WITH ego AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, st.k, st.seg, e.travel_m, e.speed_mps, e.width_m, x.d_m, x.half_width_m, x.left_out_m, x.right_out_m, x.left_in_m, x.right_in_m, x.heading_diff_rad,
        g.environment_id, v.handedness, v.handedness_source <> 'default' AS hand_known, n.lanelet_id, n.road_type,
        least(greatest(x.s_m - c.s_start_m, 0.0), c.length_m - 1e-6) AS lane_s_m,
        coalesce(n.junction_id IS NOT NULL, false) AS in_junction,
        e.x_m IS NOT NULL AND e.lanelet_id IS NULL AS off_lanes, a.t_ns IS NOT NULL AS aside, y.road_id IS NOT NULL AND y.road_id = n.road_id AS on_its_road, e.yaw_rad - x.heading_diff_rad AS way_rad,
        -- the running lane counted from the first one to the left
        coalesce(sum(l.side) OVER (w ROWS UNBOUNDED PRECEDING), 0) AS lane
    FROM ego_state e
    JOIN step st USING (drive_id, ego_id, t_ns)
    JOIN data_log g USING (drive_id)
    LEFT JOIN environment v ON v.environment_id = g.environment_id
    LEFT JOIN ego_corridor x ON x.drive_id = e.drive_id AND x.ego_id = e.ego_id AND x.chain_id = e.chain_id AND x.t_ns = e.t_ns
    LEFT JOIN chain c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.chain_id = e.chain_id
        AND c.s_start_m <= x.s_m AND x.s_m < c.s_start_m + c.length_m
    LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = c.lanelet_id
    LEFT JOIN lane_crossing l ON l.drive_id = e.drive_id AND l.ego_id = e.ego_id AND l.t_ns = e.t_ns
    LEFT JOIN ego_aside a ON a.drive_id = e.drive_id AND a.ego_id = e.ego_id AND a.t_ns = e.t_ns
    LEFT JOIN lanelet y ON y.environment_id = g.environment_id AND y.lanelet_id = a.lanelet_id
    WINDOW w AS (PARTITION BY e.drive_id, e.ego_id ORDER BY st.k)
),
around AS (
    SELECT
        *,
        lag({'seg': seg, 'seen': left_out_m IS NOT NULL AND NOT in_junction}) OVER w AS before,
        lead({'seg': seg, 'seen': left_out_m IS NOT NULL}) OVER w AS after,
        coalesce(lag(lane) OVER w, lane) AS lane_before, coalesce(lead(lane) OVER w, lane) AS lane_after,
        lag(way_rad) OVER w AS way_before_rad, lead(way_rad) OVER w AS way_after_rad, lag(k) OVER w IS NULL OR lead(k) OVER w IS NULL AS outermost,
        -- how far the way behind and ahead was looked at
        travel_m - min(travel_m) OVER s AS seen_behind_m, max(travel_m) OVER s - travel_m AS seen_ahead_m
    FROM ego
    WINDOW w AS (PARTITION BY drive_id, ego_id ORDER BY k), s AS (PARTITION BY drive_id, ego_id, seg)
),
-- the least that it is over each of its lane's boundaries before and after, as long as it keeps to that lane
least_out AS (
    SELECT
        drive_id, ego_id, t_ns, v.side, min(v.out_m) OVER (r ROWS UNBOUNDED PRECEDING) AS before_m,
        min(v.out_m) OVER (r ROWS BETWEEN CURRENT ROW AND UNBOUNDED FOLLOWING) AS after_m
    FROM (
        SELECT *, k - row_number() OVER (PARTITION BY drive_id, ego_id, seg, lane ORDER BY k) AS run
        FROM ego
        WHERE left_out_m IS NOT NULL AND NOT in_junction
    )
    CROSS JOIN LATERAL (VALUES (1, left_out_m), (-1, right_out_m)) AS v(side, out_m)
    WINDOW r AS (PARTITION BY drive_id, ego_id, seg, lane, run, v.side ORDER BY k)
),
over AS (
    SELECT
        a.*, v.side, CASE v.side WHEN 1 THEN 'left' ELSE 'right' END AS side_name, CASE v.side WHEN 1 THEN left_out_m ELSE right_out_m END AS out_m,
        CASE v.side WHEN 1 THEN left_in_m ELSE right_in_m END < -over_boundary_m() AS astride,
        CASE v.side WHEN 1 THEN lane + 1 ELSE lane END AS line, (v.side = 1) = (v.side * d_m > half_width_m) AS left_of
    FROM around a
    CROSS JOIN (VALUES (1), (-1)) AS v(side)
    WHERE NOT in_junction AND CASE v.side WHEN 1 THEN left_out_m ELSE right_out_m END > over_boundary_m()
),
numbered AS (
    SELECT
        *,
        k - row_number() OVER (PARTITION BY drive_id, ego_id, seg, line ORDER BY k) AS run,
        k - row_number() OVER (PARTITION BY drive_id, ego_id, seg, line, astride ORDER BY k) AS astride_run
    FROM over
),
stretch AS (
    SELECT
        drive_id, ego_id, seg, line, run, min(t_ns) AS t_since_ns, max(t_ns) AS t_last_ns,
        coalesce(min({'k': k, 'seen': before.seg = seg AND before.seen}).seen, false) AS begin_seen,
        bool_or(side * d_m > half_width_m) OR min(least(lane_before, lane, lane_after)) < max(greatest(lane_before, lane, lane_after)) AS manoeuvre
    FROM numbered
    GROUP BY ALL
),
-- the box lies on the line, whichever lane the centre is in, until all of it is on one side
astride AS (
    SELECT
        drive_id, ego_id, seg, line, astride, astride_run, min(t_ns) AS t_since_ns,
        coalesce(min({'k': k, 'seen': before.seg = seg AND before.seen}).seen, false) AS begin_seen,
        CASE
            WHEN min({'k': k, 'left_of': left_of}).left_of = max({'k': k, 'left_of': left_of}).left_of THEN false
            WHEN max({'k': k, 'seen': after.seg = seg AND after.seen}).seen THEN true
        END AS changes
    FROM numbered
    WHERE astride
    GROUP BY ALL
),
-- astride the line, but round somebody
overtaking AS (
    SELECT s.drive_id, s.ego_id, s.seg, s.line, s.run, bool_or(NOT passed_over_any_line(a.actor_class, a.length_m, o.v_vbp_mps)) AS moving
    FROM stretch s
    JOIN overtake o ON o.drive_id = s.drive_id AND o.ego_id = s.ego_id AND o.t0_ns <= s.t_last_ns AND o.t_end_ns >= s.t_since_ns
    JOIN road_user a ON a.drive_id = o.drive_id AND a.actor_id = o.vbp_id
    WHERE o.passed
    GROUP BY ALL
),
doubt AS (
    SELECT DISTINCT n.drive_id, n.ego_id, n.t_ns
    FROM hidden h
    JOIN numbered n USING (drive_id, ego_id, t_ns)
    WHERE h.least_m < passing_before_m(n.speed_mps) AND (h.vehicle OR is_class(h.actor_class, 'animal'))
),
-- one that is lost for a while, and stands in the ego's lane, or may, where it is seen
stood AS (
    SELECT DISTINCT p.drive_id, p.ego_id, p.object_id
    FROM pair p
    SEMI JOIN hidden h ON h.drive_id = p.drive_id AND h.ego_id = p.ego_id AND h.object_id = p.object_id AND h.late
    WHERE abs(p.d_m) - p.lat_half_m < p.half_width_m + 0.5 AND passed_over_any_line(p.actor_class, p.length_m, p.speed_mps) IS DISTINCT FROM false
),
-- somebody without a place may be the one that is passed; a vehicle that is not in plain view is not in the part of the lane ahead that is,
-- and, behind, was not passed
may_pass AS (
    SELECT DISTINCT n.drive_id, n.ego_id, n.t_ns
    FROM hidden h
    JOIN numbered n USING (drive_id, ego_id, t_ns)
    LEFT JOIN sight v USING (drive_id, ego_id, t_ns)
    LEFT JOIN stood s ON s.drive_id = h.drive_id AND s.ego_id = h.ego_id AND s.object_id = h.object_id
    WHERE h.least_m < passing_before_m(n.speed_mps) AND (h.vehicle OR is_class(h.actor_class, 'animal'))
        AND NOT (
            h.late AND is_vehicle(h.actor_class) AND NOT is_bicycle(h.actor_class, NULL) AND s.object_id IS NULL
            AND (h.ahead IS NOT DISTINCT FROM false OR coalesce(v.vehicle_lane_m >= passing_before_m(n.speed_mps), false))
        )
),
-- near the one that it overtakes, or may (where that one is lost meanwhile, whether it was passed is not known), or near somebody on foot in its lane
beside AS (
    SELECT n.drive_id, n.ego_id, n.t_ns, bool_or(CASE WHEN r.passed AND d.near THEN true END) AS overtaking
    FROM numbered n
    JOIN (
        SELECT drive_id, ego_id, t0_ns, t_end_ns, vbp_id AS object_id, passed, false AS on_foot FROM overtake
        UNION ALL
        SELECT drive_id, ego_id, min(t_ns), max(t_ns), object_id, true, true FROM pair WHERE is_class(actor_class, 'pedestrian') AND in_lane(d_m, lat_half_m, half_width_m) GROUP BY ALL
    ) r ON r.drive_id = n.drive_id AND r.ego_id = n.ego_id AND r.t0_ns <= n.t_ns AND r.t_end_ns >= n.t_ns
    JOIN ego_state e ON e.drive_id = n.drive_id AND e.ego_id = n.ego_id AND e.t_ns = n.t_ns
    LEFT JOIN pair p ON p.drive_id = n.drive_id AND p.ego_id = n.ego_id AND p.t_ns = n.t_ns AND p.object_id = r.object_id
    CROSS JOIN LATERAL (SELECT passing_mps(e.speed_mps, p.speed_mps, p.heading_diff_rad) AS mps) c
    -- off the ego's way it has a distance only
    CROSS JOIN LATERAL (
        SELECT coalesce(
            p.rear_s_m - e.front_s_m <= passing_before_m(c.mps) AND e.rear_s_m - p.front_s_m <= passing_after_m(c.mps),
            p.distance_m <= greatest(passing_before_m(e.speed_mps), passing_after_m(e.speed_mps))
        ) AS near
    ) d
    WHERE (r.passed OR EXISTS (FROM doubt d WHERE d.drive_id = r.drive_id AND d.ego_id = r.ego_id AND d.t_ns >= r.t0_ns AND d.t_ns <= r.t_end_ns))
        AND d.near IS DISTINCT FROM false AND (NOT r.on_foot OR coalesce(in_lane(p.d_m, p.lat_half_m, p.half_width_m), false))
    GROUP BY ALL
),
-- an actor that the ego may pass over any line, and that leaves too little room to be passed on this side of the line; in a go in which the
-- ego also overtakes a moving vehicle, it needs the line for that one
met AS (
    SELECT
        n.drive_id, n.ego_id, n.t_ns, n.side, min({'gap_m': p.rear_s_m - e.front_s_m, 'object_id': p.object_id}) FILTER (x.allowed).object_id AS passing_id,
        bool_or(x.allowed IS NULL) AS unsure
    FROM numbered n
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    JOIN pair p USING (drive_id, ego_id, t_ns)
    LEFT JOIN overtaking o ON o.drive_id = n.drive_id AND o.ego_id = n.ego_id AND o.seg = n.seg AND o.line = n.line AND o.run = n.run
    CROSS JOIN LATERAL (
        SELECT CASE WHEN p.actor_class IS DISTINCT FROM 'object' OR abs(p.d_m) >= p.half_width_m THEN passed_over_any_line(p.actor_class, p.length_m, p.speed_mps) END AS allowed
    ) x
    WHERE abs(p.d_m) - p.lat_half_m < p.half_width_m + 0.5 AND n.side * p.d_m < p.half_width_m
        AND p.half_width_m - n.side * p.d_m - p.lat_half_m < n.width_m + passing_room_m(p.actor_class)
        AND p.rear_s_m - e.front_s_m <= passing_before_m(e.speed_mps) AND e.rear_s_m - p.front_s_m <= passing_after_m(e.speed_mps)
        AND x.allowed IS DISTINCT FROM false AND NOT coalesce(o.moving, false)
    GROUP BY ALL
),
-- stretches off the lanes; there the ego has got to a way of another kind if it turned off, stood, or went further than 10 m. A shoulder,
-- bay or cycle lane is part of the road itself: whoever stands along it, or comes back from it to lanes that run as those before, was not
-- elsewhere. And whoever turns beside the lanes and comes back to such lanes may only have turned round.
off AS (
    SELECT
        drive_id, ego_id, seg, run, min(travel_m) AS from_m, max(travel_m) AS to_m,
        min({'k': k, 'd_m': d_m, 'half_width_m': half_width_m, 'v': speed_mps}) AS first, max({'k': k, 'd_m': d_m, 'half_width_m': half_width_m, 'v': speed_mps}) AS last,
        coalesce(bool_or(abs(heading_diff_rad) BETWEEN turned_off_rad() AND pi() - turned_off_rad()), false) AS turned,
        coalesce(bool_or(speed_mps <= standing_mps()), false) AS stood, coalesce(bool_or(abs(d_m) > 10), false) AS away, bool_and(aside) AS aside,
        coalesce(bool_and(on_its_road), false) AS on_its_road, bool_or(outermost) AS outermost,
        abs(cos(max({'k': k, 'rad': way_after_rad}).rad - min({'k': k, 'rad': way_before_rad}).rad)) <= cos(turned_off_rad()) AS elsewhere,
        min(seen_behind_m) > 0 AS begin_seen, min(seen_ahead_m) > 0 AS end_seen
    FROM (
        SELECT *, k - row_number() OVER (PARTITION BY drive_id, ego_id, seg ORDER BY k) AS run FROM around WHERE off_lanes
    )
    GROUP BY ALL
),
-- what there was within 30 m on the way there, or on the way back
reached AS (
    SELECT
        n.drive_id, n.ego_id, n.t_ns, n.side, v.back,
        CASE
            WHEN n.side * v.edge.d_m <= v.edge.half_width_m THEN false
            WHEN v.edge.v > access_mps() THEN CASE WHEN NOT o.turned THEN false END
            WHEN v.edge.d_m IS NULL OR v.edge.v IS NULL THEN NULL
            WHEN o.away AND NOT o.on_its_road THEN true
            WHEN o.aside THEN CASE WHEN o.turned AND o.elsewhere THEN true WHEN NOT o.elsewhere OR o.stood AND NOT o.turned THEN false END
            WHEN o.stood OR o.turned AND (o.outermost OR o.elsewhere) THEN true
            WHEN NOT o.turned AND o.begin_seen AND o.end_seen THEN false
        END AS access
    FROM numbered n
    JOIN off o USING (drive_id, ego_id, seg)
    CROSS JOIN LATERAL (VALUES (false, n.travel_m <= o.to_m, o.from_m - n.travel_m, o.first), (true, n.travel_m >= o.from_m, n.travel_m - o.to_m, o.last)) AS v(back, towards, way_m, edge)
    WHERE v.towards AND v.way_m <= 30
),
access AS (
    SELECT
        drive_id, ego_id, t_ns, side, coalesce(bool_or(access), false) AS reached, bool_or(access IS NULL) AS may_be, bool_or(back) AS behind, bool_or(NOT back) AS ahead
    FROM reached
    GROUP BY ALL
)
SELECT
    n.drive_id, n.ego_id, n.t_ns, n.side_name AS side, n.out_m, b.marking,
    b.marking IN ('solid', 'solid_solid', 'solid_broken') AS forbidden,
    CASE WHEN NOT y.drivable THEN y.lane_type WHEN y.against THEN 'opposing' WHEN y.drivable THEN 'same' END AS beyond,
    -- the directions of a motorway are apart
    CASE
        WHEN y.strip = 'median' AND n.road_type = 'motorway' THEN false
        WHEN y.beside_id IS NOT NULL THEN y.drivable AND y.against AND CASE WHEN y.gap_m <= reservation_m() AND y.strip IS DISTINCT FROM 'median' THEN true END
        WHEN n.road_type = 'motorway' OR n.side_name <> overtaking_side(n.handedness) THEN false
    END AS middle,
    s.t_since_ns, s.begin_seen, s.manoeuvre OR o.run IS NOT NULL AS manoeuvre,
    a.t_since_ns AS t_astride_ns, a.begin_seen AS astride_begin_seen, a.changes, CASE WHEN w.t_ns IS NOT NULL THEN w.overtaking WHEN n.hand_known THEN false END AS overtaking,
    m.passing_id, m.passing_id IS NOT NULL OR u.t_ns IS NULL AND NOT coalesce(m.unsure, false) AS passing_known,
    CASE
        WHEN r.reached THEN true
        WHEN r.may_be THEN NULL
        -- whoever goes on to a way beyond the line does not come back from it
        WHEN (n.seen_behind_m >= 30 OR r.behind OR lo.before_m <= n.out_m - back_m()) AND (n.seen_ahead_m >= 30 OR r.ahead OR lo.after_m <= n.out_m - back_m()) THEN false
    END AS access
FROM numbered n
JOIN stretch s USING (drive_id, ego_id, seg, line, run)
LEFT JOIN astride a USING (drive_id, ego_id, seg, line, astride, astride_run)
LEFT JOIN overtaking o USING (drive_id, ego_id, seg, line, run)
LEFT JOIN beside w ON w.drive_id = n.drive_id AND w.ego_id = n.ego_id AND w.t_ns = n.t_ns
LEFT JOIN lane_boundary b ON b.environment_id = n.environment_id AND b.lanelet_id = n.lanelet_id
    AND b.side = n.side_name AND b.s_start_m <= n.lane_s_m AND n.lane_s_m < b.s_end_m
LEFT JOIN lane_beside y ON y.environment_id = n.environment_id AND y.lanelet_id = n.lanelet_id
    AND y.side = n.side_name AND y.s_start_m <= n.lane_s_m AND n.lane_s_m < y.s_end_m
LEFT JOIN met m ON m.drive_id = n.drive_id AND m.ego_id = n.ego_id AND m.t_ns = n.t_ns AND m.side = n.side
LEFT JOIN may_pass u ON u.drive_id = n.drive_id AND u.ego_id = n.ego_id AND u.t_ns = n.t_ns
LEFT JOIN least_out lo ON lo.drive_id = n.drive_id AND lo.ego_id = n.ego_id AND lo.t_ns = n.t_ns AND lo.side = n.side
LEFT JOIN access r ON r.drive_id = n.drive_id AND r.ego_id = n.ego_id AND r.t_ns = n.t_ns AND r.side = n.side
