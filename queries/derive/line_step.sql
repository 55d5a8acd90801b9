-- Steps with a corner over a boundary of the running lane. A stretch is one boundary of the road: changing lanes, the left boundary of the
-- one is the right boundary of the other.
WITH ego AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, st.k, st.seg, e.travel_m, x.d_m, x.half_width_m, x.left_out_m, x.right_out_m,
        g.environment_id, n.lanelet_id, n.left_id, n.left_against, n.right_id, n.right_against,
        least(greatest(x.s_m - c.s_start_m, 0.0), c.length_m - 1e-6) AS lane_s_m,
        coalesce(n.junction_id IS NOT NULL, false) AS in_junction,
        e.x_m IS NOT NULL AND e.lanelet_id IS NULL AS off_lanes,
        -- the running lane counted from the first one to the left
        coalesce(sum(l.side) OVER (w ROWS UNBOUNDED PRECEDING), 0) AS lane
    FROM ego_state e
    JOIN step st USING (drive_id, ego_id, t_ns)
    JOIN data_log g USING (drive_id)
    LEFT JOIN ego_corridor x ON x.drive_id = e.drive_id AND x.ego_id = e.ego_id AND x.chain_id = e.chain_id AND x.t_ns = e.t_ns
    LEFT JOIN chain c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.chain_id = e.chain_id
        AND c.s_start_m <= x.s_m AND x.s_m < c.s_start_m + c.length_m
    LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = c.lanelet_id
    LEFT JOIN lane_crossing l ON l.drive_id = e.drive_id AND l.ego_id = e.ego_id AND l.t_ns = e.t_ns
    WINDOW w AS (PARTITION BY e.drive_id, e.ego_id ORDER BY st.k)
),
around AS (
    SELECT
        *,
        lag({'seg': seg, 'seen': left_out_m IS NOT NULL AND NOT in_junction}) OVER w AS before,
        coalesce(lag(lane) OVER w, lane) AS lane_before, coalesce(lead(lane) OVER w, lane) AS lane_after,
        -- how far it is to the last and to the next place off the lanes, and how far that was looked at
        travel_m - max(CASE WHEN off_lanes THEN travel_m END) OVER (s ROWS UNBOUNDED PRECEDING) AS since_off_m,
        min(CASE WHEN off_lanes THEN travel_m END) OVER (s ROWS BETWEEN CURRENT ROW AND UNBOUNDED FOLLOWING) - travel_m AS until_off_m,
        travel_m - min(travel_m) OVER (PARTITION BY drive_id, ego_id, seg) AS seen_behind_m,
        max(travel_m) OVER (PARTITION BY drive_id, ego_id, seg) - travel_m AS seen_ahead_m
    FROM ego
    WINDOW w AS (PARTITION BY drive_id, ego_id ORDER BY k), s AS (PARTITION BY drive_id, ego_id, seg ORDER BY k)
),
over AS (
    SELECT
        a.*, v.side, CASE v.side WHEN 1 THEN left_out_m ELSE right_out_m END AS out_m,
        CASE v.side WHEN 1 THEN left_id ELSE right_id END AS beyond_id, CASE v.side WHEN 1 THEN left_against ELSE right_against END AS beyond_against,
        CASE v.side WHEN 1 THEN lane + 1 ELSE lane END AS line
    FROM around a
    CROSS JOIN (VALUES (1), (-1)) AS v(side)
    WHERE NOT in_junction AND CASE v.side WHEN 1 THEN left_out_m ELSE right_out_m END > over_boundary_m()
),
numbered AS (
    SELECT *, k - row_number() OVER (PARTITION BY drive_id, ego_id, seg, line ORDER BY k) AS run FROM over
),
stretch AS (
    SELECT
        drive_id, ego_id, seg, line, run, min(t_ns) AS t_since_ns, max(t_ns) AS t_last_ns,
        coalesce(min({'k': k, 'seen': before.seg = seg AND before.seen}).seen, false) AS begin_seen,
        bool_or(side * d_m > half_width_m) OR min(least(lane_before, lane, lane_after)) < max(greatest(lane_before, lane, lane_after)) AS manoeuvre
    FROM numbered
    GROUP BY ALL
),
-- astride the line, but round somebody
overtaking AS (
    SELECT DISTINCT s.drive_id, s.ego_id, s.seg, s.line, s.run
    FROM stretch s
    JOIN overtake o ON o.drive_id = s.drive_id AND o.ego_id = s.ego_id AND o.t0_ns <= s.t_last_ns AND o.t_end_ns >= s.t_since_ns
    WHERE o.passed
),
-- who stands, or is slow and may be passed over any line, in the lane or within half a metre of it
met AS (
    SELECT n.drive_id, n.ego_id, n.t_ns, min({'gap_m': p.rear_s_m - e.front_s_m, 'object_id': p.object_id}).object_id AS passing_id
    FROM (SELECT DISTINCT drive_id, ego_id, t_ns FROM numbered) n
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    JOIN pair p USING (drive_id, ego_id, t_ns)
    WHERE abs(p.d_m) - p.lat_half_m < p.half_width_m + 0.5 AND p.rear_s_m - e.front_s_m <= 30 AND e.rear_s_m - p.front_s_m <= 10
        AND (may_be_vehicle(p.actor_class) AND p.speed_mps <= standing_mps() OR p.actor_class IN ('bicycle', 'animal') AND p.speed_mps <= 4.4704)
    GROUP BY ALL
),
doubt AS (
    SELECT DISTINCT drive_id, ego_id, t_ns FROM hidden WHERE least_m < 30 AND (vehicle OR actor_class = 'animal')
)
SELECT
    n.drive_id, n.ego_id, n.t_ns, CASE n.side WHEN 1 THEN 'left' ELSE 'right' END AS side, n.out_m, b.marking,
    b.marking IN ('solid', 'solid_solid', 'solid_broken') AS forbidden,
    CASE WHEN NOT y.drivable THEN y.lane_type WHEN n.beyond_against THEN 'opposing' WHEN y.drivable THEN 'same' END AS beyond,
    s.t_since_ns, s.begin_seen, s.manoeuvre OR o.run IS NOT NULL AS manoeuvre,
    m.passing_id, m.passing_id IS NOT NULL OR d.t_ns IS NULL AS passing_known,
    CASE
        WHEN n.since_off_m <= 30 OR n.until_off_m <= 30 THEN true
        WHEN n.seen_behind_m >= 30 AND n.seen_ahead_m >= 30 THEN false
    END AS access
FROM numbered n
JOIN stretch s USING (drive_id, ego_id, seg, line, run)
LEFT JOIN overtaking o USING (drive_id, ego_id, seg, line, run)
LEFT JOIN lane_boundary b ON b.environment_id = n.environment_id AND b.lanelet_id = n.lanelet_id
    AND b.side = CASE n.side WHEN 1 THEN 'left' ELSE 'right' END AND b.s_start_m <= n.lane_s_m AND n.lane_s_m < b.s_end_m
LEFT JOIN lanelet y ON y.environment_id = n.environment_id AND y.lanelet_id = n.beyond_id
LEFT JOIN met m ON m.drive_id = n.drive_id AND m.ego_id = n.ego_id AND m.t_ns = n.t_ns
LEFT JOIN doubt d ON d.drive_id = n.drive_id AND d.ego_id = n.ego_id AND d.t_ns = n.t_ns
