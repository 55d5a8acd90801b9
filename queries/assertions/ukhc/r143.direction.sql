-- title = "With the direction of the lane"
-- breach = "Against the direction of the lane"
-- clause = "UKHC R143, R160 and R263: you must travel in the direction of a one-way road; on a motorway you must not reverse or drive against the traffic; on other roads you should keep to your side"
-- hypothesis = "At every step outside an overtake, and with its lane not closed by a standing object or a pedestrian, did the ego drive forwards in the direction of its lane?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- merge_gap_s = 5.0
-- tags = ["excuses"]
-- reads = ["chain", "clock", "data_log", "ego_condition", "ego_lane", "ego_motion", "ego_state", "excursion", "hidden", "lane_beside", "lane_occupancy", "lanelet", "line_step", "map_quality", "overtake_step", "pair", "step"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [params.reverse_mps]
-- default = 0.5
-- unit = "m/s"
-- why = "our default, as in r263: slower than this is standing: recorded speeds of standing vehicles jitter"
--
-- [params.manoeuvring_mps]
-- default = 4.47
-- unit = "m/s"
-- why = "our default: at 10 mph and less vehicles turn round, park and reverse, which R200 to R203 allow with care; on a motorway nothing excuses it"
--
-- [params.manoeuvring_m]
-- default = 30.0
-- unit = "m"
-- why = "our default: an ego that turns round, parks or reverses goes no further against its lane than this; further is driving, however slow (R203: no further than necessary)"
--
-- [params.manoeuvring_s]
-- default = 30.0
-- unit = "s"
-- why = "our default: the distance against the lane is summed over this time before and after a step, so that many short stretches count as driving, too"
--
-- [params.passing_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: time in the opposing lane to get past something that the log does not show, such as road works"
--
-- [params.closed_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: the ego may be in the opposing lane for the distance that it drives in this time at its present speed, before and after an object that stands in its own lane, and after an overtaken vehicle"
--
-- [params.closed_m]
-- default = 10.0
-- unit = "m"
-- why = "our default: this is added to the distance of closed_s, so that a slow ego has some room, too"
--
-- [params.junction_s]
-- default = 2.0
-- unit = "s"
-- why = "our default: in a junction lanes of all directions overlap; an ego that is against every one of them for this long, as the wrong way round a roundabout, drives against the traffic"
--
-- [params.against_rad]
-- default = 2.618
-- unit = "rad"
-- why = "our default: a heading within 30 degrees of the opposite direction is against a lane of a junction; a turn that cuts the corner is not"
--
-- [reasons.passing_unknown]
-- says = "it is not known whether the ego is passing another vehicle"
-- advice = "record that vehicle from before the ego passes it until after"
--
-- [reasons.may_pass_unseen]
-- says = "in the opposing lane for less than {within_s:g} s, the ego may be passing something that the log does not show"
-- advice = "record obstacles in the lane, such as road works"
--
-- [reasons.lane_closed_unknown]
-- says = "it is not known whether something blocks the ego's lane"
-- advice = "record all actors and obstacles there"
--
-- [reasons.on_restricted_lane]
-- says = "the ego drives on restricted ground, whose direction is not known"
-- advice = "use another lane type than restricted in the map, if vehicles may drive there"
--
-- [reasons.direction_varies]
-- says = "the map states that the direction of lane {lanelet_id} may change: it is not known which one held"
-- advice = "provide a map with the direction that held in this drive"
--
-- [reasons.with_lane]
-- says = "{along_mps:.1f} m/s along the ego's heading, which is the direction of lane {lanelet_id}"
--
-- [reasons.against_lane]
-- says = "{along_mps:.1f} m/s along the ego's heading, which is against the direction of lane {lanelet_id}"

-- @applies
-- The rule does not apply where the ego is off every lane, as in a car park.
WITH ego_step AS (
    SELECT drive_id, ego_id, t_ns, front_s_m, rear_s_m, width_m, speed_mps, with_direction, $closed_m + $closed_s * speed_mps AS reach_m FROM ego_state
),
-- Steps at which the ego is beyond the end of the lane that it came along, in a lane of a two-way road: the map joins the two roads by no
-- link. Whether the ego is still passing another actor is not known then, for as long as an overtake takes.
chain_end AS (
    SELECT drive_id, ego_id, chain_id, max(s_start_m + length_m) AS end_m FROM chain GROUP BY ALL
),
beyond_lane_step AS (
    SELECT e.drive_id, e.ego_id, e.t_ns
    FROM (
        SELECT drive_id, ego_id, t_ns, lanelet_id, front_s_m,
            last_value(CASE WHEN front_s_m IS NOT NULL THEN {'t_ns': t_ns, 'chain_id': chain_id, 'front_s_m': front_s_m, 'speed_mps': speed_mps} END IGNORE NULLS)
                OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS last_place
        FROM ego_state
    ) e
    JOIN data_log g USING (drive_id)
    JOIN clock k USING (drive_id, ego_id)
    JOIN chain_end c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.chain_id = e.last_place.chain_id
    SEMI JOIN (SELECT environment_id, lanelet_id FROM lane_beside WHERE drivable AND against) b ON b.environment_id = g.environment_id AND b.lanelet_id = e.lanelet_id
    WHERE e.front_s_m IS NULL AND e.t_ns - e.last_place.t_ns <= longest_overtake_ns()
        AND c.end_m - e.last_place.front_s_m <= e.last_place.speed_mps * k.max_gap_ns / 1e9
),
-- An overtake excuses the ego while it is beside the overtaken vehicle, on its way up to it, and until that vehicle is left behind. A
-- vehicle on which the ego does not gain is not being overtaken: it excuses the ego for no longer than an overtake takes. If the vehicle is
-- not placed, it is not known whether it excuses the ego, unless the vehicle is known to be left behind.
passing_step AS (
    SELECT drive_id, ego_id, t_ns, CASE WHEN bool_or(is_excused) THEN true WHEN count(is_excused) = count(*) THEN false END AS is_excused
    FROM (
        SELECT
            o.drive_id, o.ego_id, o.t_ns,
            CASE
                -- A vehicle parked at the edge, with room to pass it within the lane, is not overtaken.
                WHEN p.speed_mps <= standing_mps() AND is_vehicle(p.actor_class) AND p.half_width_m + abs(p.d_m) - p.lat_half_m >= e.width_m + passing_room_m(p.actor_class) THEN false
                ELSE coalesce(
                    p.front_s_m >= e.rear_s_m - e.reach_m AND (
                        p.rear_s_m <= e.front_s_m AND p.front_s_m >= e.rear_s_m
                        OR o.is_early AND p.rear_s_m - e.front_s_m <= e.reach_m
                        OR e.speed_mps - p.speed_mps > standing_mps() AND 1e9 * (p.rear_s_m - e.front_s_m) <= longest_overtake_ns() * (e.speed_mps - p.speed_mps)
                    ),
                    CASE WHEN NOT h.ahead AND h.least_m > e.reach_m THEN false END
                )
            END AS is_excused
        FROM (SELECT *, t_ns - min(t_ns) OVER (PARTITION BY drive_id, ego_id, occurrence) <= longest_overtake_ns() AS is_early FROM overtake_step) o
        JOIN ego_step e USING (drive_id, ego_id, t_ns)
        LEFT JOIN pair p ON p.drive_id = o.drive_id AND p.ego_id = o.ego_id AND p.t_ns = o.t_ns AND p.object_id = o.vbp_id
        LEFT JOIN hidden h ON h.drive_id = o.drive_id AND h.ego_id = o.ego_id AND h.t_ns = o.t_ns AND h.object_id = o.vbp_id
        UNION ALL
        SELECT drive_id, ego_id, t_ns, true FROM line_step WHERE passing_id IS NOT NULL
        UNION ALL
        SELECT drive_id, ego_id, t_ns, NULL FROM beyond_lane_step
    )
    GROUP BY ALL
),
short_excursion_step AS (
    SELECT DISTINCT s.drive_id, s.ego_id, s.t_ns
    FROM excursion x
    JOIN step s ON s.drive_id = x.drive_id AND s.ego_id = x.ego_id AND s.t_ns >= x.t0_ns AND s.t_ns <= x.t_end_ns
        AND s.t_ns < x.t0_ns + ($passing_s * 1e9)::BIGINT
),
wrong_way_step AS (
    SELECT * FROM ego_step WHERE NOT with_direction
),
-- A standing object in the ego's lane, such as a row of cones, closes the lane, and so does a person who walks in it. A vehicle parked at
-- the edge of the lane does not close it if there is room to pass within the lane.
closed_lane AS (
    SELECT w.drive_id, w.ego_id, w.t_ns,
        CASE WHEN bool_or(c.closes_lane) THEN true WHEN count(h.object_id) = 0 AND count(p.object_id) = count(c.closes_lane) THEN false END AS closed_lane
    FROM wrong_way_step w
    LEFT JOIN pair p ON p.drive_id = w.drive_id AND p.ego_id = w.ego_id AND p.t_ns = w.t_ns
        AND in_lane(p.d_m, coalesce(p.lat_half_m, 0.0), p.half_width_m) AND p.s_m >= w.rear_s_m - w.reach_m AND p.s_m <= w.front_s_m + w.reach_m
    LEFT JOIN hidden h ON h.drive_id = w.drive_id AND h.ego_id = w.ego_id AND h.t_ns = w.t_ns AND h.least_m < w.reach_m
    CROSS JOIN LATERAL (
        SELECT p.speed_mps <= standing_mps() AND (NOT is_vehicle(p.actor_class)
                OR p.half_width_m + abs(p.d_m) - coalesce(p.lat_half_m, 0.0) < w.width_m + passing_room_m(p.actor_class) OR CASE WHEN p.lat_half_m IS NOT NULL THEN false END)
            OR is_class(p.actor_class, 'pedestrian') AND p.speed_mps <= $manoeuvring_mps AS closes_lane
    ) c
    GROUP BY ALL
),
-- The distance that the ego goes the wrong way within manoeuvring_s before and after the step. least_m is certain; most_m includes the
-- steps at which it is not known whether something excuses the ego.
wrong_way_distance AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, w.is_against,
        sum(w.way_m) FILTER (w.is_against AND (p.t_ns IS NULL OR NOT p.is_excused) AND (c.t_ns IS NULL OR NOT c.closed_lane)) OVER manoeuvring_time AS least_m,
        sum(w.way_m) FILTER (w.is_against AND NOT coalesce(p.is_excused OR c.closed_lane, false)) OVER manoeuvring_time AS most_m
    FROM ego_state e
    JOIN step st USING (drive_id, ego_id, t_ns)
    JOIN data_log g USING (drive_id)
    LEFT JOIN ego_motion m USING (drive_id, ego_id, t_ns)
    LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = e.lanelet_id
    LEFT JOIN passing_step p USING (drive_id, ego_id, t_ns)
    LEFT JOIN closed_lane c USING (drive_id, ego_id, t_ns)
    CROSS JOIN LATERAL (
        SELECT
            abs(m.v_long_mps) * st.dt_ns / 1e9 AS way_m,
            coalesce(NOT e.in_junction AND NOT n.bidirectional AND CASE WHEN e.with_direction THEN m.v_long_mps < -$reverse_mps ELSE m.v_long_mps > $reverse_mps END, false) AS is_against
    ) w
    WINDOW manoeuvring_time AS (
        PARTITION BY e.drive_id, e.ego_id ORDER BY e.t_ns
        RANGE BETWEEN ($manoeuvring_s * 1e9)::BIGINT PRECEDING AND ($manoeuvring_s * 1e9)::BIGINT FOLLOWING
    )
),
-- Whether the ego has been against every lane of the junction for at least junction_s, at each step.
junction_direction_check AS (
    SELECT drive_id, ego_id, t_ns, t_ns - max(t_ns) FILTER (NOT is_against) OVER so_far >= ($junction_s * 1e9)::BIGINT AS is_against
    FROM (
        SELECT e.drive_id, e.ego_id, e.t_ns, coalesce(bool_and(abs(o.heading_diff_rad) > $against_rad), false) AS is_against
        FROM ego_state e
        -- The condition is in the key: beside the keys, it would make the join a nested loop.
        LEFT JOIN lane_occupancy o ON o.drive_id = e.drive_id AND o.actor_id = e.ego_id AND o.t_ns = CASE WHEN e.in_junction THEN e.t_ns END AND o.drivable
        GROUP BY ALL
    )
    WINDOW so_far AS (PARTITION BY drive_id, ego_id ORDER BY t_ns)
)
SELECT e.drive_id, e.ego_id, e.t_ns,
    -- During a short excursion the ego may pass something that the log does not show: then it is not known whether the rule applies.
    (c.t_ns IS NULL OR CASE WHEN p.is_excused OR c.closed_lane THEN false WHEN p.t_ns IS NOT NULL AND p.is_excused IS NULL OR x.t_ns IS NOT NULL AND NOT e.in_junction THEN NULL ELSE NOT c.closed_lane END)
        -- Restricted ground is on a level with the lanes: who drives on it against its direction may be on the side of the others.
        AND (e.x_m IS NULL OR e.lanelet_id IS NOT NULL OR a.aside_id IS NOT NULL AND w.road_type = 'motorway' OR CASE WHEN a.aside_type = 'restricted' THEN CASE WHEN a.aside_with_direction THEN true END ELSE false END) AND (NOT e.in_junction OR a.aside_id IS NOT NULL OR coalesce(j.is_against, false))
        AND CASE WHEN abs(m.v_long_mps) > $manoeuvring_mps OR w.road_type = 'motorway' OR d.is_against AND d.least_m > $manoeuvring_m THEN true
            -- If the ego drives in the direction of its lane, the kind of road does not matter.
            WHEN abs(m.v_long_mps) <= $manoeuvring_mps AND (w.road_type IS NOT NULL OR e.with_direction AND m.v_long_mps >= -$reverse_mps) AND NOT coalesce(d.is_against AND d.most_m > $manoeuvring_m, false) THEN false END AS applies,
    CASE WHEN e.lanelet_id IS NULL AND a.aside_type = 'restricted' THEN why('on_restricted_lane')
        WHEN c.t_ns IS NULL OR p.is_excused OR c.closed_lane THEN NULL
        WHEN p.t_ns IS NOT NULL AND p.is_excused IS NULL THEN why('passing_unknown')
        WHEN x.t_ns IS NOT NULL THEN why('may_pass_unseen', {'within_s': $passing_s})
        WHEN c.closed_lane IS NULL THEN why('lane_closed_unknown') END AS reason
FROM ego_state e
LEFT JOIN ego_motion m USING (drive_id, ego_id, t_ns)
LEFT JOIN ego_condition w USING (drive_id, ego_id, t_ns)
LEFT JOIN ego_lane a USING (drive_id, ego_id, t_ns)
LEFT JOIN passing_step p USING (drive_id, ego_id, t_ns)
LEFT JOIN short_excursion_step x USING (drive_id, ego_id, t_ns)
LEFT JOIN junction_direction_check j USING (drive_id, ego_id, t_ns)
LEFT JOIN closed_lane c USING (drive_id, ego_id, t_ns)
LEFT JOIN wrong_way_distance d USING (drive_id, ego_id, t_ns)

-- @condition
SELECT e.drive_id, e.ego_id, e.t_ns, CASE WHEN q.check_id IS NULL THEN n.bidirectional OR coalesce(e.with_direction, a.aside_with_direction) END AND m.v_long_mps >= -$reverse_mps AS holds,
    CASE WHEN q.check_id IS NOT NULL THEN why('direction_varies', {'lanelet_id': q.lanelet_id})
        WHEN m.v_long_mps IS NOT NULL AND coalesce(e.lanelet_id, a.aside_id) IS NOT NULL THEN why(
        CASE WHEN n.bidirectional OR coalesce(e.with_direction, a.aside_with_direction) THEN 'with_lane' ELSE 'against_lane' END,
        {'along_mps': m.v_long_mps, 'lanelet_id': coalesce(e.lanelet_id, a.aside_id)}
    ) END AS reason
FROM ego_state e
JOIN data_log g USING (drive_id)
LEFT JOIN ego_motion m USING (drive_id, ego_id, t_ns)
LEFT JOIN ego_lane a USING (drive_id, ego_id, t_ns)
LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = coalesce(e.lanelet_id, a.aside_id)
LEFT JOIN map_quality q ON q.environment_id = g.environment_id AND q.lanelet_id = coalesce(e.lanelet_id, a.aside_id) AND q.check_id = 'lane_direction_varies'
