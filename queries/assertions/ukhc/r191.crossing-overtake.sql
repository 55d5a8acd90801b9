-- title = "No passing in the zig-zags before a crossing"
-- breach = "Passed in the zig-zags before a crossing"
-- clause = "UKHC R191 and R165: you must not overtake the moving motor vehicle nearest the crossing, or the one that has stopped there to give way to people on foot, in the area marked by zig-zag lines; a parked one may be passed"
-- hypothesis = "When the ego went over a pedestrian crossing, had it passed no moving vehicle that was the nearest to the crossing, and none that had stopped to give way, from the beginning of the zig-zags to the crossing?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- law = ["gb"]
-- sense = "holds"
-- reads = ["crossing_passage", "ego_state", "lane_occupancy", "pair", "passing", "road_user", "state_dynamics", "step"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way onto the crossing: begin recording before it"
--
-- [params.zigzag_m]
-- default = 18.0
-- unit = "m"
-- why = "our default, since maps do not show them: eight marks of two metres and the space between"
--
-- [reasons.crossing_kind_unknown]
-- says = "the map does not state whether crossing {crossing_id} is a zebra, has lights, or neither"
-- advice = "use a map that does"
--
-- [reasons.zigzags_at_junction]
-- says = "crossing {crossing_id} has lights and lies at a junction, where a crossing of the junction's own lights has no zig-zags"
--
-- [reasons.passed_before_crossing]
-- says = "passed {object_ids} before crossing {crossing_id}"
--
-- [reasons.may_not_be_nearest]
-- says = "it is not known whether {object_id}, which the ego passed, was the vehicle nearest to crossing {crossing_id}: another one ahead of it lacks a class or speed"
--
-- [reasons.may_have_given_way]
-- says = "it is not known whether {object_id} stood before crossing {crossing_id} to give way"
--
-- [reasons.may_have_been_passed]
-- says = "actor {object_id} may have been passed before crossing {crossing_id}"
--
-- [reasons.zigzags_unseen]
-- says = "the log does not show the {zigzag_m:g} m before the crossing"
-- advice = "begin recording earlier"

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, coalesce(t_out_ns, t_in_ns) AS t_out_ns, crossing_id, kind, occurrence,
    -- Whether there is an actor for whom a vehicle may have stopped; NULL: not known.
    on_id IS NOT NULL OR coming_id IS NOT NULL OR waiting_id IS NOT NULL OR CASE WHEN known AND coming_known THEN false END AS for_whom
FROM crossing_passage

-- @condition
-- A crossing that is neither a zebra nor signalled has no zig-zags. Whom the ego passed before the log began is not known.
WITH junction_crossing AS (
    SELECT DISTINCT r.ref_id
    FROM reference r
    JOIN step a ON a.drive_id = r.drive_id AND a.ego_id = r.ego_id AND a.t_ns = r.t_ns
    JOIN step b ON b.drive_id = r.drive_id AND b.ego_id = r.ego_id AND b.t_ns = r.t_out_ns
    JOIN step n ON n.drive_id = r.drive_id AND n.ego_id = r.ego_id AND n.travel_m BETWEEN a.travel_m - $zigzag_m AND b.travel_m + $zigzag_m
    JOIN ego_state e ON e.drive_id = n.drive_id AND e.ego_id = n.ego_id AND e.t_ns = n.t_ns
    WHERE r.kind = 'signalled' AND e.in_junction
),
passed_object AS (
    SELECT
        p.drive_id, p.ego_id, p.object_id, p.t_ns, coalesce(p.t_unseen_ns, p.t_ns) AS t_first_ns, s.travel_m,
        p.ego_passes AND p.t_unseen_ns IS NULL AND coalesce(is_vehicle(p.actor_class) AND NOT is_bicycle(p.actor_class, a.length_m), false) AS is_seen,
        p.speed_mps <= standing_mps() AS is_standing, m.has_moved, o.t_ns IS NOT NULL AS is_on_road
    FROM passing p
    JOIN step s USING (drive_id, ego_id, t_ns)
    LEFT JOIN road_user a ON a.drive_id = p.drive_id AND a.actor_id = p.object_id
    -- A vehicle that stands in one place from its first sample to its last is parked, or waits all that time.
    LEFT JOIN (
        SELECT drive_id, actor_id, max(x_m) - min(x_m) > standing_spread_m() OR max(y_m) - min(y_m) > standing_spread_m() AS has_moved FROM state_dynamics GROUP BY ALL
    ) m ON m.drive_id = p.drive_id AND m.actor_id = p.object_id
    LEFT JOIN (SELECT DISTINCT drive_id, actor_id, t_ns FROM lane_occupancy WHERE drivable) o
        ON o.drive_id = p.drive_id AND o.actor_id = p.object_id AND o.t_ns = p.t_ns
    WHERE p.ego_passes IS DISTINCT FROM false AND may_be_vehicle(p.actor_class) AND is_bicycle(p.actor_class, a.length_m) IS DISTINCT FROM true
),
-- A vehicle that moved and was nearer to the crossing than the one that the ego passed, in the ego's lane or another: only the nearest one
-- must not be passed.
nearer_vehicle AS (
    SELECT r.ref_id, p.object_id, p.t_ns, bool_or(n.is_nearer) AS is_known
    FROM reference r
    JOIN step st USING (drive_id, ego_id, t_ns)
    JOIN passed_object p ON p.drive_id = r.drive_id AND p.ego_id = r.ego_id
    JOIN ego_state e ON e.drive_id = p.drive_id AND e.ego_id = p.ego_id AND e.t_ns = p.t_ns
    JOIN pair v ON v.drive_id = p.drive_id AND v.ego_id = p.ego_id AND v.t_ns = p.t_ns AND v.object_id = p.object_id
    JOIN pair o ON o.drive_id = p.drive_id AND o.ego_id = p.ego_id AND o.t_ns = p.t_ns
    LEFT JOIN (SELECT DISTINCT drive_id, actor_id, t_ns FROM lane_occupancy WHERE drivable) d ON d.drive_id = o.drive_id AND d.actor_id = o.object_id AND d.t_ns = o.t_ns
    CROSS JOIN LATERAL (
        SELECT is_vehicle(o.actor_class) AND NOT is_bicycle(o.actor_class, o.length_m) AND o.speed_mps > standing_mps() AND abs(o.heading_diff_rad) < pi() / 4 AND d.t_ns IS NOT NULL
            AND o.front_s_m > v.front_s_m AND o.front_s_m - e.front_s_m <= st.travel_m - p.travel_m AS is_nearer
    ) n
    WHERE NOT p.is_standing AND n.is_nearer IS DISTINCT FROM false
    GROUP BY r.ref_id, p.object_id, p.t_ns
),
pass_before_crossing AS (
    SELECT
        r.ref_id, p.object_id, p.is_seen,
        -- A nearer actor of unknown class or speed may be such a vehicle.
        CASE WHEN n.is_known THEN false WHEN n.ref_id IS NULL THEN w.counts END AS counts, n.ref_id IS NOT NULL AND n.is_known IS NULL AS may_not_be_nearest
    FROM reference r
    JOIN step st USING (drive_id, ego_id, t_ns)
    JOIN passed_object p ON p.drive_id = r.drive_id AND p.ego_id = r.ego_id AND p.t_first_ns <= r.t_out_ns AND p.travel_m >= st.travel_m - $zigzag_m
    LEFT JOIN nearer_vehicle n ON n.ref_id = r.ref_id AND n.object_id = p.object_id AND n.t_ns = p.t_ns
    CROSS JOIN LATERAL (
        SELECT CASE WHEN NOT p.is_standing THEN true WHEN p.is_standing AND NOT p.is_on_road THEN false
            WHEN p.is_standing AND r.for_whom THEN CASE WHEN p.has_moved THEN true END
            WHEN p.is_standing AND NOT r.for_whom THEN CASE WHEN NOT p.has_moved THEN false END END AS counts
    ) w
)
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.kind <> 'other' AS applies,
    CASE WHEN bool_or(b.is_seen AND b.counts) THEN CASE WHEN bool_or(j.ref_id IS NULL) THEN false END WHEN st.travel_m >= $zigzag_m AND count(b.object_id) FILTER (b.counts IS DISTINCT FROM false) = 0 THEN true END AS holds,
    CASE WHEN r.kind IS NULL THEN why('crossing_kind_unknown', {'crossing_id': r.crossing_id})
        WHEN bool_or(b.is_seen AND b.counts AND j.ref_id IS NOT NULL) THEN why('zigzags_at_junction', {'crossing_id': r.crossing_id})
        WHEN bool_or(b.is_seen AND b.counts) THEN why('passed_before_crossing', {
            'object_ids': string_agg(DISTINCT b.object_id, ', ' ORDER BY b.object_id) FILTER (b.is_seen AND b.counts), 'crossing_id': r.crossing_id
        })
        WHEN bool_or(b.is_seen AND b.may_not_be_nearest)
            THEN why('may_not_be_nearest', {'object_id': min(b.object_id) FILTER (b.is_seen AND b.may_not_be_nearest), 'crossing_id': r.crossing_id})
        WHEN bool_or(b.is_seen AND b.counts IS NULL)
            THEN why('may_have_given_way', {'object_id': min(b.object_id) FILTER (b.is_seen AND b.counts IS NULL), 'crossing_id': r.crossing_id})
        WHEN count(b.object_id) FILTER (b.counts IS DISTINCT FROM false) > 0
            THEN why('may_have_been_passed', {'object_id': min(b.object_id) FILTER (b.counts IS DISTINCT FROM false), 'crossing_id': r.crossing_id})
        WHEN st.travel_m < $zigzag_m THEN why('zigzags_unseen', {'zigzag_m': $zigzag_m}) END AS reason
FROM reference r
JOIN step st USING (drive_id, ego_id, t_ns)
LEFT JOIN pass_before_crossing b USING (ref_id)
LEFT JOIN junction_crossing j USING (ref_id)
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.kind, r.crossing_id, st.travel_m
