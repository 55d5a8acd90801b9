-- title = "No passing on the right, except past a slow queue"
-- breach = "Passed on the right"
-- clause = "StVO 5(1), 7(2), 7(2a), 7a (R_I2 of Maierhofer et al. 2020): overtake on the left; on the right only past a queue, at little more than its speed, or on an entry lane"
-- hypothesis = "When the ego got ahead of a vehicle in a lane to its left (right in left-hand traffic), was that a slow queue, passed with little more speed?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- law = ["de"]
-- sense = "holds"
-- reads = ["clock", "data_log", "ego_corridor", "ego_state", "lanelet", "neighbour", "pair", "passing"]
-- requires = ["map", "registration", "ego_size", "handedness"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.queue_mps]
-- default = 16.67
-- unit = "m/s"
-- why = "60 km/h: a queue is no faster"
-- source = "StVO 7(2a) and case law; Maierhofer et al. 2020, Table II"
--
-- [params.faster_mps]
-- default = 5.55
-- unit = "m/s"
-- why = "20 km/h: so much faster the ego may be at most"
-- source = "case law on StVO 7(2a); Maierhofer et al. 2020, Table II"
--
-- [params.queue_n]
-- default = 3.0
-- unit = "vehicles"
-- why = "so many slow vehicles in the other lanes are a queue"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.queue_m]
-- default = 137.5
-- unit = "m"
-- why = "our default: vehicles no further than this from the passed vehicle belong to its queue; that is as far as from the first to the last of three lorries of 18.75 m that keep 50 m"
-- source = "StVO 4(3), StVZO 32(4)"
--
-- [reasons.broad_line_unknown]
-- says = "the ego was on a lane of type {lane_type}: it is not known whether a broad line separated it from the through lanes"
--
-- [reasons.passed_standing]
-- says = "{object_id} stood, and it is not known whether it waited in a queue, which would make it traffic, or had broken down"
-- advice = "a person must judge this"
--
-- [reasons.log_ends_beside]
-- says = "at the end of the log the ego was beside the other vehicle and no slower: it is not known whether the ego got ahead"
--
-- [reasons.passed_unseen]
-- says = "the ego passed object {object_id} after {from_ns}, unseen: it is not known how fast the two were then"

-- @reference
SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, p.speed_mps, p.ego_speed_mps, CASE WHEN p.ego_passes THEN c.side END AS side, n.lane_type, p.is_cut_off, p.t_unseen_ns
FROM (
    SELECT drive_id, ego_id, t_ns, object_id, actor_class, ego_passes, side, same_lane, speed_mps, ego_speed_mps, false AS is_cut_off, t_unseen_ns
    FROM passing
    UNION ALL BY NAME
    -- A pass that the end of the log cuts off.
    SELECT b.drive_id, b.ego_id, b.t_ns, b.object_id, b.actor_class, b.side, abs(b.d_m) < b.half_width_m AS same_lane, b.speed_mps, b.ego_speed_mps, true AS is_cut_off
    FROM neighbour b
    JOIN clock k ON k.drive_id = b.drive_id AND k.ego_id = b.ego_id AND k.t_end_ns = b.t_ns
    WHERE b.gap_ahead_m <= 0 AND b.ahead_m > -order_change_m() AND abs(b.heading_diff_rad) < pi() / 2 AND coalesce(b.ego_speed_mps >= b.speed_mps, true)
) p
JOIN data_log g ON g.drive_id = p.drive_id
JOIN ego_state e ON e.drive_id = p.drive_id AND e.ego_id = p.ego_id AND e.t_ns = p.t_ns
LEFT JOIN ego_corridor c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.chain_id = e.chain_id AND c.t_ns = e.t_ns
LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = e.lanelet_id
-- An actor without a place may have been passed, and its side is not known. A thing is not traffic and may be passed on either side.
WHERE may_be_vehicle(p.actor_class) AND coalesce(p.ego_passes AND NOT p.same_lane AND c.side = CASE p.side WHEN 'left' THEN 1 WHEN 'right' THEN -1 END, true)

-- @condition
-- On an entry the ego may be faster than the through lanes. On an exit it may be faster, too, if a broad line lies between, which the map
-- may not show. To go past a vehicle that stands, but not because of the traffic, is not to overtake it: a standing vehicle without a queue
-- may have broken down or work on the road.
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.object_id, coalesce(r.lane_type NOT IN ('entry', 'onRamp', 'connectingRamp'), true) AS applies,
    -- Of a pass that was not seen it is not known how fast the two were then.
    (CASE WHEN r.side IS NOT NULL THEN r.speed_mps <= $queue_mps AND r.ego_speed_mps - r.speed_mps <= $faster_mps
        AND CASE WHEN q.n >= $queue_n THEN true WHEN q.n_unknown = 0 THEN false END
        OR CASE WHEN coalesce(r.lane_type NOT IN ('exit', 'offRamp'), true) AND (r.speed_mps > standing_mps() OR q.n >= $queue_n) THEN false END END)
        AND CASE WHEN r.t_unseen_ns IS NULL THEN true END AS holds,
    CASE WHEN r.is_cut_off THEN why('log_ends_beside')
        WHEN r.t_unseen_ns IS NOT NULL AND r.side IS NOT NULL AND holds IS NULL THEN why('passed_unseen', {'object_id': r.object_id, 'from_ns': r.t_unseen_ns})
        WHEN r.lane_type IN ('exit', 'offRamp') THEN why('broad_line_unknown', {'lane_type': r.lane_type})
        WHEN r.speed_mps <= standing_mps() AND q.n < $queue_n THEN why('passed_standing', {'object_id': r.object_id}) END AS reason
FROM reference r
JOIN (
    SELECT b.ref_id, count(*) FILTER (other.is_in_queue) AS n,
        -- An actor off the lanes has no station along them: it is in no queue.
        count(*) FILTER (may_be_vehicle(o.actor_class) AND (o.x_m IS NULL OR o.speed_mps IS NULL OR o.s_m IS NOT NULL AND other.is_in_queue IS NULL)) AS n_unknown
    FROM reference b
    JOIN pair o USING (drive_id, ego_id, t_ns)
    LEFT JOIN pair v ON v.drive_id = b.drive_id AND v.ego_id = b.ego_id AND v.t_ns = b.t_ns AND v.object_id = b.object_id
    CROSS JOIN LATERAL (
        SELECT is_vehicle(o.actor_class) AND o.d_m * b.side > o.half_width_m AND o.speed_mps <= $queue_mps AND abs(o.heading_diff_rad) < pi() / 2
            AND abs(o.s_m - v.s_m) <= $queue_m AS is_in_queue
    ) other
    GROUP BY b.ref_id
) q USING (ref_id)
