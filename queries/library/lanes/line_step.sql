-- Steps with a corner of the ego over a boundary of the running lane. A stretch belongs to one line of the road: in a change of lanes, the
-- left boundary of one lane is the right boundary of the other.
-- lifetime: part
CREATE TABLE line_step (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step with a corner of the ego more than 0.05 m over a boundary of its running lane; not inside a junction, and not without a position on the corridor (ego_state.front_s_m is NULL)
    side VARCHAR NOT NULL,            -- [side] the side of that boundary; one row per side {position}
    out_m DOUBLE NOT NULL,            -- distance of the outermost corner beyond the boundary {position, heading, size}
    marking VARCHAR,                  -- [marking] see lane_boundary: at the ego's centre, as seen from the running lane; NULL: the map does not state it
    forbidden BOOLEAN,                -- the marking must not be crossed from this lane: solid, or double with the nearer line solid; NULL: marking not known
    beyond VARCHAR,                   -- [lane_type + same + opposing] the lane beyond the boundary (see lane_beside): same or opposing for a drivable lane, by its direction, else its lane_type; NULL: the map has none {position}
    middle BOOLEAN,                   -- the boundary is the middle of the road: traffic beyond it comes from ahead; NULL: it may be. On the overtaking side, the map has nothing beyond it (and the road is no motorway), a gap of more than 1 m or a median, which may be a central reservation
    t_since_ns BIGINT NOT NULL,       -- first step of this stretch over the line; both lanes beside the line count, whichever is the running lane {position}
    begin_seen BOOLEAN NOT NULL,      -- the step before t_since_ns exists, and the ego is inside the lane there {position}
    manoeuvre BOOLEAN NOT NULL,       -- the stretch is or is part of a lane change or an overtake, see lane_departure {position}
    t_astride_ns BIGINT,              -- first step since which the box has been astride of the line, with more than 0.05 m on each side; both lanes beside the line count; NULL: not astride at this step {position}
    astride_begin_seen BOOLEAN,       -- the step before t_astride_ns exists; NULL: not astride {position}
    changes BOOLEAN,                  -- in that time, the centre crosses to the other side of the line and stays there: a lane change, or part of an overtake; NULL: the end is not seen and the ego may go back, or not astride {position}
    overtaking BOOLEAN,               -- the ego overtakes a vehicle, or passes round a pedestrian in its lane. This counts from 10 m plus 5 s of the closing speed (at least 30 m) before that actor to the same distance after it; NULL: it may overtake, but the actor is lost meanwhile, or the overtaking side is not known; or the pedestrian may only reach into the lane, as its heading or size is not known {position}
    passing_id VARCHAR,               -- an actor in the running lane or on its edge that the ego passes, and that leaves too little room on this side of the line: a standing vehicle, or a cyclist or animal at up to 4.47 m/s. It counts from 10 m plus 5 s of the ego's speed (at least 30 m) ahead to 10 m plus 5 s behind; NULL: none, or in this stretch the ego overtakes a moving vehicle {position}
    passing_known BOOLEAN NOT NULL,   -- no other actor may be passed: all near actors have a position, or are out of plain view while the lane ahead is in plain view {position}
    access BOOLEAN                    -- within 30 m, the ego enters or leaves premises or a side road beyond the line. It then is off the lanes at 20 mph or less, and turns off, stands, or gets more than 10 m from the running lane's centre line. A shoulder, bay or cycle lane of the same road does not count, nor an ego that was or comes back by 0.25 m on the same lane; NULL: not known, as when it turns off and comes back the opposite way
);

INSERT INTO line_step BY NAME
WITH ego_step AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, st.k, st.seg, e.travel_m, e.speed_mps, e.width_m, x.d_m, x.half_width_m, x.left_out_m, x.right_out_m, x.left_in_m, x.right_in_m, x.heading_diff_rad,
        g.environment_id, v.handedness, v.handedness_source <> 'default' AS is_handedness_known, n.lanelet_id, n.road_type,
        least(greatest(x.s_m - c.s_start_m, 0.0), c.length_m - 1e-6) AS lane_s_m,
        coalesce(n.junction_id IS NOT NULL, false) AS in_junction,
        e.x_m IS NOT NULL AND e.lanelet_id IS NULL AS is_off_lanes, a.aside_id IS NOT NULL AS is_aside, y.road_id IS NOT NULL AND y.road_id = n.road_id AS is_on_own_road, e.yaw_rad - x.heading_diff_rad AS corridor_rad,
        -- Index of the running lane, counted to the left from the first one.
        coalesce(sum(l.side) OVER (w ROWS UNBOUNDED PRECEDING), 0) AS lane_index
    FROM ego_state e
    JOIN step st USING (drive_id, ego_id, t_ns)
    JOIN data_log g USING (drive_id)
    LEFT JOIN environment v ON v.environment_id = g.environment_id
    LEFT JOIN ego_corridor x ON x.drive_id = e.drive_id AND x.ego_id = e.ego_id AND x.chain_id = e.chain_id AND x.t_ns = e.t_ns
    LEFT JOIN chain c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.chain_id = e.chain_id
        AND c.s_start_m <= x.s_m AND x.s_m < c.s_start_m + c.length_m
    LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = c.lanelet_id
    LEFT JOIN lane_crossing l ON l.drive_id = e.drive_id AND l.ego_id = e.ego_id AND l.t_ns = e.t_ns
    LEFT JOIN ego_lane a ON a.drive_id = e.drive_id AND a.ego_id = e.ego_id AND a.t_ns = e.t_ns
    LEFT JOIN lanelet y ON y.environment_id = g.environment_id AND y.lanelet_id = a.aside_id
    WINDOW w AS (PARTITION BY e.drive_id, e.ego_id ORDER BY st.k)
),
step_context AS (
    SELECT
        *,
        lag({'seg': seg, 'seen': left_out_m IS NOT NULL AND NOT in_junction}) OVER w AS step_before,
        lead({'seg': seg, 'seen': left_out_m IS NOT NULL}) OVER w AS step_after,
        coalesce(lag(lane_index) OVER w, lane_index) AS lane_index_before, coalesce(lead(lane_index) OVER w, lane_index) AS lane_index_after,
        lag(corridor_rad) OVER w AS corridor_before_rad, lead(corridor_rad) OVER w AS corridor_after_rad, lag(k) OVER w IS NULL OR lead(k) OVER w IS NULL AS is_outermost,
        -- The length of the ego's recorded path behind and ahead of the step, up to a hole.
        travel_m - min(travel_m) OVER s AS seen_behind_m, max(travel_m) OVER s - travel_m AS seen_ahead_m
    FROM ego_step
    WINDOW w AS (PARTITION BY drive_id, ego_id ORDER BY k), s AS (PARTITION BY drive_id, ego_id, seg)
),
-- The least distance by which the ego is over each boundary of its lane before the step, and after it, while it stays in that lane.
least_over_line AS (
    SELECT
        drive_id, ego_id, t_ns, v.side, min(v.out_m) OVER (r ROWS UNBOUNDED PRECEDING) AS least_before_m,
        min(v.out_m) OVER (r ROWS BETWEEN CURRENT ROW AND UNBOUNDED FOLLOWING) AS least_after_m
    FROM (
        SELECT *, k - row_number() OVER (PARTITION BY drive_id, ego_id, seg, lane_index ORDER BY k) AS run_no
        FROM ego_step
        WHERE left_out_m IS NOT NULL AND NOT in_junction
    )
    CROSS JOIN LATERAL (VALUES (1, left_out_m), (-1, right_out_m)) AS v(side, out_m)
    WINDOW r AS (PARTITION BY drive_id, ego_id, seg, lane_index, run_no, v.side ORDER BY k)
),
step_over_line AS (
    SELECT
        *, CASE side WHEN 1 THEN 'left' ELSE 'right' END AS side_name, CASE side WHEN 1 THEN left_out_m ELSE right_out_m END AS out_m,
        CASE side WHEN 1 THEN left_in_m ELSE right_in_m END < -over_boundary_m() AS line_contact,
        CASE side WHEN 1 THEN lane_index + 1 ELSE lane_index END AS line_no, (side = 1) = (side * d_m > half_width_m) AS left_of
    FROM (SELECT *, unnest([1, -1]) AS side FROM step_context WHERE NOT in_junction)
    WHERE CASE side WHEN 1 THEN left_out_m ELSE right_out_m END > over_boundary_m()
),
numbered_step AS (
    SELECT
        *,
        k - row_number() OVER (PARTITION BY drive_id, ego_id, seg, line_no ORDER BY k) AS run_no,
        k - row_number() OVER (PARTITION BY drive_id, ego_id, seg, line_no, line_contact ORDER BY k) AS contact_run_no
    FROM step_over_line
),
line_stretch AS (
    SELECT
        drive_id, ego_id, seg, line_no, run_no, min(t_ns) AS t_since_ns, max(t_ns) AS t_last_ns,
        coalesce(min({'k': k, 'seen': step_before.seg = seg AND step_before.seen}).seen, false) AS begin_seen,
        bool_or(side * d_m > half_width_m) OR min(least(lane_index_before, lane_index, lane_index_after)) < max(greatest(lane_index_before, lane_index, lane_index_after)) AS manoeuvre
    FROM numbered_step
    GROUP BY ALL
),
-- Stretches in which the box is on the line, in whichever lane its centre is, until the whole box is on one side.
line_contact AS (
    SELECT
        drive_id, ego_id, seg, line_no, line_contact, contact_run_no, min(t_ns) AS t_since_ns,
        coalesce(min({'k': k, 'seen': step_before.seg = seg AND step_before.seen}).seen, false) AS begin_seen,
        CASE
            WHEN min({'k': k, 'left_of': left_of}).left_of = max({'k': k, 'left_of': left_of}).left_of THEN false
            WHEN max({'k': k, 'seen': step_after.seg = seg AND step_after.seen}).seen THEN true
        END AS changes
    FROM numbered_step
    WHERE line_contact
    GROUP BY ALL
),
-- Stretches in which the ego overtakes a vehicle that is astride of the line.
overtaking AS (
    SELECT s.drive_id, s.ego_id, s.seg, s.line_no, s.run_no, bool_or(NOT may_be_passed_over_solid_line(a.actor_class, a.length_m, o.v_vbp_mps)) AS is_moving
    FROM line_stretch s
    JOIN overtake o ON o.drive_id = s.drive_id AND o.ego_id = s.ego_id AND o.t0_ns <= s.t_last_ns AND o.t_end_ns >= s.t_since_ns
    JOIN road_user a ON a.drive_id = o.drive_id AND a.actor_id = o.vbp_id
    WHERE o.passed
    GROUP BY ALL
),
hidden_step AS (
    SELECT DISTINCT n.drive_id, n.ego_id, n.t_ns
    FROM hidden h
    JOIN numbered_step n USING (drive_id, ego_id, t_ns)
    WHERE h.least_m < passing_before_m(n.speed_mps) AND (h.vehicle OR is_class(h.actor_class, 'animal'))
),
-- The length decides whether a lost vehicle of unknown kind may be a bicycle.
late_object_length AS (
    SELECT p.drive_id, p.ego_id, p.object_id, min(p.length_m) AS length_m
    FROM pair p
    SEMI JOIN hidden h ON h.drive_id = p.drive_id AND h.ego_id = p.ego_id AND h.object_id = p.object_id AND h.late
    GROUP BY ALL
),
-- Objects that are not recorded for a while and that, at another step, are seen in the ego's lane, where the ego may pass them over a solid
-- line.
lost_passable_object AS (
    SELECT DISTINCT p.drive_id, p.ego_id, p.object_id
    FROM pair p
    SEMI JOIN hidden h ON h.drive_id = p.drive_id AND h.ego_id = p.ego_id AND h.object_id = p.object_id AND h.late
    WHERE abs(p.d_m) - coalesce(p.lat_half_m, box_half_diagonal_m(p.actor_class, p.length_m, p.width_m)) < p.half_width_m + 0.5
        AND may_be_passed_over_solid_line(p.actor_class, p.length_m, p.speed_mps) IS DISTINCT FROM false
),
-- Steps at which the ego may be passing an object without a position on the corridor. An unseen vehicle cannot be in the part of the lane
-- ahead that is in plain view. A vehicle that is certainly behind the ego is excluded: an ego passes an actor ahead or beside it.
possible_pass AS (
    SELECT DISTINCT n.drive_id, n.ego_id, n.t_ns
    FROM hidden h
    JOIN numbered_step n USING (drive_id, ego_id, t_ns)
    LEFT JOIN _sight v USING (drive_id, ego_id, t_ns)
    LEFT JOIN lost_passable_object s ON s.drive_id = h.drive_id AND s.ego_id = h.ego_id AND s.object_id = h.object_id
    LEFT JOIN late_object_length z ON z.drive_id = h.drive_id AND z.ego_id = h.ego_id AND z.object_id = h.object_id
    WHERE h.least_m < passing_before_m(n.speed_mps) AND (h.vehicle OR is_class(h.actor_class, 'animal'))
        AND NOT coalesce(
            h.late AND is_vehicle(h.actor_class) AND NOT is_bicycle(h.actor_class, z.length_m) AND s.object_id IS NULL
            AND (h.ahead IS NOT DISTINCT FROM false OR coalesce(v.vehicle_lane_m >= passing_before_m(n.speed_mps), false)), false
        )
),
-- Steps near the vehicle that the ego overtakes, or may overtake, or near a pedestrian in its lane. If that vehicle is lost meanwhile, it
-- is not known whether the ego passed it.
step_near_passed AS (
    SELECT n.drive_id, n.ego_id, n.t_ns, bool_or(CASE WHEN r.passed AND d.is_near AND (NOT r.is_on_foot OR in_lane(p.d_m, coalesce(p.lat_half_m, 0.0), p.half_width_m)) THEN true END) AS overtaking
    FROM numbered_step n
    JOIN (
        SELECT drive_id, ego_id, t0_ns, t_end_ns, vbp_id AS object_id, passed, false AS is_on_foot FROM overtake
        UNION ALL
        SELECT drive_id, ego_id, min(t_ns), max(t_ns), object_id, true, true FROM pair WHERE is_class(actor_class, 'pedestrian') AND in_lane(d_m, walker_half_m(lat_half_m, length_m, width_m), half_width_m) GROUP BY ALL
    ) r ON r.drive_id = n.drive_id AND r.ego_id = n.ego_id AND r.t0_ns <= n.t_ns AND r.t_end_ns >= n.t_ns
    JOIN ego_state e ON e.drive_id = n.drive_id AND e.ego_id = n.ego_id AND e.t_ns = n.t_ns
    LEFT JOIN pair p ON p.drive_id = n.drive_id AND p.ego_id = n.ego_id AND p.t_ns = n.t_ns AND p.object_id = r.object_id
    CROSS JOIN LATERAL (SELECT passing_mps(e.speed_mps, p.speed_mps, p.heading_diff_rad) AS closing_mps) c
    CROSS JOIN LATERAL (SELECT greatest(passing_before_m(e.speed_mps), passing_after_m(e.speed_mps)) AS m) far
    -- Of an object of unknown size, the centre counts. Off the corridor, an object has only a distance.
    CROSS JOIN LATERAL (
        SELECT coalesce(
            coalesce(p.rear_s_m, p.s_m) - e.front_s_m <= passing_before_m(c.closing_mps) AND e.rear_s_m - coalesce(p.front_s_m, p.s_m) <= passing_after_m(c.closing_mps),
            p.distance_m <= far.m
        ) AS may_be_near
    ) window_check
    -- Of a vehicle on the corridor whose speed or heading is not known, it is only known when it is not near.
    CROSS JOIN LATERAL (
        SELECT CASE WHEN NOT window_check.may_be_near OR r.is_on_foot OR p.s_m IS NULL OR p.speed_mps + p.heading_diff_rad IS NOT NULL THEN window_check.may_be_near END AS is_near
    ) d
    WHERE (r.passed OR EXISTS (FROM hidden_step d WHERE d.drive_id = r.drive_id AND d.ego_id = r.ego_id AND d.t_ns >= r.t0_ns AND d.t_ns <= r.t_end_ns))
        AND d.is_near IS DISTINCT FROM false AND (NOT r.is_on_foot OR coalesce(in_lane(p.d_m, walker_half_m(p.lat_half_m, p.length_m, p.width_m), p.half_width_m), false))
    GROUP BY ALL
),
-- Actors that allow the ego to cross even a solid line, because they leave too little room on this side of it. They do not count in a
-- stretch in which the ego also overtakes a moving vehicle: the ego then crosses the line for that vehicle.
passable_object AS (
    SELECT
        n.drive_id, n.ego_id, n.t_ns, n.side, min({'gap_m': p.rear_s_m - e.front_s_m, 'object_id': p.object_id}) FILTER (x.is_allowed).object_id AS passing_id,
        bool_or(x.is_allowed IS NULL) AS is_unsure
    FROM numbered_step n
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    JOIN pair p USING (drive_id, ego_id, t_ns)
    LEFT JOIN overtaking o ON o.drive_id = n.drive_id AND o.ego_id = n.ego_id AND o.seg = n.seg AND o.line_no = n.line_no AND o.run_no = n.run_no
    CROSS JOIN LATERAL (
        -- An object whose centre is beside the lane, such as a post, is part of the verge.
        SELECT may_be_passed_over_solid_line(p.actor_class, p.length_m, p.speed_mps) AND (p.actor_class IS DISTINCT FROM 'object' OR abs(p.d_m) < p.half_width_m) AS is_allowed
    ) x
    WHERE abs(p.d_m) - p.lat_half_m < p.half_width_m + 0.5 AND n.side * p.d_m < p.half_width_m
        AND p.half_width_m - n.side * p.d_m - p.lat_half_m < n.width_m + passing_room_m(p.actor_class)
        AND p.rear_s_m - e.front_s_m <= passing_before_m(e.speed_mps) AND e.rear_s_m - p.front_s_m <= passing_after_m(e.speed_mps)
        AND x.is_allowed IS DISTINCT FROM false AND NOT coalesce(o.is_moving, false)
    GROUP BY ALL
),
-- Stretches off the lanes. The ego reaches premises or a side road there if it turns off, stands, or goes further than 10 m from the lane.
-- A shoulder, bay or cycle lane is part of the road itself: an ego that stands along it, or returns from it to lanes of the same direction,
-- has not left the road. An ego that turns beside the lanes and returns to such lanes may only have turned round.
off_lane_stretch AS (
    SELECT
        drive_id, ego_id, seg, run_no, min(travel_m) AS from_m, max(travel_m) AS to_m,
        min({'k': k, 'd_m': d_m, 'half_width_m': half_width_m, 'v': speed_mps}) AS first_step, max({'k': k, 'd_m': d_m, 'half_width_m': half_width_m, 'v': speed_mps}) AS last_step,
        coalesce(bool_or(abs(heading_diff_rad) BETWEEN turned_off_rad() AND pi() - turned_off_rad()), false) AS has_turned,
        coalesce(bool_or(speed_mps <= standing_mps()), false) AS standing_phase, coalesce(bool_or(abs(d_m) > 10), false) AS is_away, bool_and(is_aside) AS is_aside,
        coalesce(bool_and(is_on_own_road), false) AS is_on_own_road, bool_or(is_outermost) AS is_outermost,
        abs(cos(max({'k': k, 'rad': corridor_after_rad}).rad - min({'k': k, 'rad': corridor_before_rad}).rad)) <= cos(turned_off_rad()) AS leads_elsewhere,
        min(seen_behind_m) > 0 AS begin_seen, min(seen_ahead_m) > 0 AS end_seen
    FROM (
        SELECT *, k - row_number() OVER (PARTITION BY drive_id, ego_id, seg ORDER BY k) AS run_no FROM step_context WHERE is_off_lanes
    )
    GROUP BY ALL
),
-- Whether the ego reaches premises or a side road within 30 m, or comes back from there within 30 m.
access_check AS (
    SELECT
        n.drive_id, n.ego_id, n.t_ns, n.side, v.is_way_back,
        CASE
            WHEN n.side * v.edge_step.d_m <= v.edge_step.half_width_m THEN false
            WHEN v.edge_step.v > access_mps() THEN CASE WHEN NOT o.has_turned THEN false END
            WHEN v.edge_step.d_m IS NULL OR v.edge_step.v IS NULL THEN NULL
            WHEN o.is_away AND NOT o.is_on_own_road THEN true
            WHEN o.is_aside THEN CASE WHEN o.has_turned AND o.leads_elsewhere THEN true WHEN NOT o.leads_elsewhere OR o.standing_phase AND NOT o.has_turned THEN false END
            WHEN o.standing_phase OR o.has_turned AND (o.is_outermost OR o.leads_elsewhere) THEN true
            WHEN NOT o.has_turned AND o.begin_seen AND o.end_seen THEN false
        END AS access
    FROM numbered_step n
    JOIN off_lane_stretch o USING (drive_id, ego_id, seg)
    CROSS JOIN LATERAL (VALUES (false, n.travel_m <= o.to_m, o.from_m - n.travel_m, o.first_step), (true, n.travel_m >= o.from_m, n.travel_m - o.to_m, o.last_step)) AS v(is_way_back, is_towards, to_edge_m, edge_step)
    WHERE v.is_towards AND v.to_edge_m <= 30
),
access AS (
    SELECT
        drive_id, ego_id, t_ns, side, coalesce(bool_or(access), false) AS has_access, bool_or(access IS NULL) AS may_be_reached, bool_or(is_way_back) AS behind, bool_or(NOT is_way_back) AS ahead
    FROM access_check
    GROUP BY ALL
)
SELECT
    n.drive_id, n.ego_id, n.t_ns, n.side_name AS side, n.out_m, b.marking,
    b.marking IN ('solid', 'solid_solid', 'solid_broken') AS forbidden,
    CASE WHEN NOT y.drivable THEN y.lane_type WHEN y.against THEN 'opposing' WHEN y.drivable THEN 'same' END AS beyond,
    -- The two directions of a motorway are separated.
    CASE
        WHEN y.strip = 'median' AND n.road_type = 'motorway' THEN false
        WHEN y.beside_id IS NOT NULL THEN y.drivable AND y.against AND CASE WHEN y.gap_m <= reservation_m() AND y.strip IS DISTINCT FROM 'median' THEN true END
        WHEN n.road_type = 'motorway' OR n.side_name <> overtaking_side(n.handedness) THEN false
    END AS middle,
    s.t_since_ns, s.begin_seen, s.manoeuvre OR o.run_no IS NOT NULL AS manoeuvre,
    a.t_since_ns AS t_astride_ns, a.begin_seen AS astride_begin_seen, a.changes, CASE WHEN w.t_ns IS NOT NULL THEN w.overtaking WHEN n.is_handedness_known THEN false END AS overtaking,
    m.passing_id, m.passing_id IS NOT NULL OR u.t_ns IS NULL AND NOT coalesce(m.is_unsure, false) AS passing_known,
    CASE
        WHEN r.has_access THEN true
        WHEN r.may_be_reached THEN NULL
        -- To exclude access, the ego must be recorded for 30 m behind and ahead. A shorter distance is enough behind if it just came from
        -- off the lanes (r.behind), and ahead if it soon leaves them (r.ahead): it cannot have crossed the line in between.
        WHEN (n.seen_behind_m >= 30 OR r.behind OR lo.least_before_m <= n.out_m - back_in_lane_m()) AND (n.seen_ahead_m >= 30 OR r.ahead OR lo.least_after_m <= n.out_m - back_in_lane_m()) THEN false
    END AS access
FROM numbered_step n
JOIN line_stretch s USING (drive_id, ego_id, seg, line_no, run_no)
LEFT JOIN line_contact a USING (drive_id, ego_id, seg, line_no, line_contact, contact_run_no)
LEFT JOIN overtaking o USING (drive_id, ego_id, seg, line_no, run_no)
LEFT JOIN step_near_passed w ON w.drive_id = n.drive_id AND w.ego_id = n.ego_id AND w.t_ns = n.t_ns
LEFT JOIN lane_boundary b ON b.environment_id = n.environment_id AND b.lanelet_id = n.lanelet_id
    AND b.side = n.side_name AND b.s_start_m <= n.lane_s_m AND n.lane_s_m < b.s_end_m
LEFT JOIN lane_beside y ON y.environment_id = n.environment_id AND y.lanelet_id = n.lanelet_id
    AND y.side = n.side_name AND y.s_start_m <= n.lane_s_m AND n.lane_s_m < y.s_end_m
LEFT JOIN passable_object m ON m.drive_id = n.drive_id AND m.ego_id = n.ego_id AND m.t_ns = n.t_ns AND m.side = n.side
LEFT JOIN possible_pass u ON u.drive_id = n.drive_id AND u.ego_id = n.ego_id AND u.t_ns = n.t_ns
LEFT JOIN least_over_line lo ON lo.drive_id = n.drive_id AND lo.ego_id = n.ego_id AND lo.t_ns = n.t_ns AND lo.side = n.side
LEFT JOIN access r ON r.drive_id = n.drive_id AND r.ego_id = n.ego_id AND r.t_ns = n.t_ns AND r.side = n.side
