-- title = "Not far slower than allowed without a reason"
-- breach = "Far slower than allowed, without a reason that is seen"
-- clause = "StVO 3(2) (R_G4 of Maierhofer et al. 2020): without good reason do not drive so slowly that you hinder the traffic; the formula does not ask whether anybody is hindered, nor does this rule"
-- hypothesis = "At every step with no slow vehicle ahead or in the lane beside, and nobody else in the way, was the ego slower than the speed limit by less than the allowed difference?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "minor"
-- legal = "must"
-- status = "stable"
-- law = ["de"]
-- sense = ">"
-- unit = "m/s"
-- observes = "speed"
-- exempt_after_s = "settle_s"
-- merge_gap_s = 5.0
-- reads = ["data_log", "ego_condition", "ego_mode", "ego_state", "in_way", "lanelet", "lead", "neighbour"]
-- requires = ["map", "registration", "ego_size"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.slower_mps]
-- default = 15.0
-- unit = "m/s"
-- why = "a vehicle this far below the limit hinders the traffic"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.settle_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: time to speed up after the motorway is entered, or the slow vehicle ahead has gone or sped up"
--
-- [params.start_s]
-- default = 15.0
-- unit = "s"
-- why = "our default: time to speed up from standing: 1.2 m/s2 to 18 m/s"
--
-- [params.desired_mps]
-- default = 36.11
-- unit = "m/s"
-- why = "130 km/h, the recommended speed: no more is asked for"
-- source = "Autobahn-Richtgeschwindigkeits-Verordnung 1"
--
-- [params.heavy_mps]
-- default = 22.22
-- unit = "m/s"
-- why = "80 km/h: no more is allowed to vehicles over 3.5 t, buses and cars with trailers, nor asked of them"
-- source = "StVO 18(5) no. 1"
--
-- [reasons.class_speed_unknown]
-- says = "the speed limit for the ego's kind of vehicle is not known"

-- @condition
-- The kind of vehicle may allow less than the road. If it is not known, a speed between the values that are required of the slowest and of
-- the fastest kind is not judged. If the limit is not known, at most the recommended speed less $slower_mps is required, and an ego is not
-- slow without reason under any limit while a vehicle that would be a reason is no faster than the ego itself.
SELECT drive_id, ego_id, t_ns, e.speed_mps AS observed,
    CASE WHEN e.speed_mps > c.most_mps THEN c.most_mps WHEN e.speed_mps <= c.least_mps THEN c.least_mps END AS required,
    CASE WHEN required IS NULL AND c.least_mps IS NOT NULL THEN why('class_speed_unknown') WHEN c.limit_mps IS NULL THEN limit_doubt(e.limit_source, e.lanelet_id) END AS reason,
    -- A slow vehicle ahead is a reason to drive slowly if it is near enough to matter at the speed limit. At a step without a row in
    -- `lead`,
    -- there may be such a vehicle. A person, an animal or a thing in the way is a reason, too, and so is a slow vehicle in the lane beside
    -- (StVO 7(2a)). An ego that speeds up from a standstill, or declares a minimal risk manoeuvre, does not hinder by choice. Who
    -- leaves the motorway slows down on the exit lane, as it is meant for, and who comes in speeds up on the entry.
    CASE WHEN n.lane_type IN ('entry', 'onRamp', 'mwyEntry', 'exit', 'offRamp', 'mwyExit', 'connectingRamp') THEN false WHEN e.has_stood AND e.speed_mps > standing_mps() OR r.is_on OR b.t_ns IS NOT NULL OR NOT may_be_vehicle(w.actor_class) THEN false
        WHEN l.t_ns IS NOT NULL THEN (
            l.object_id IS NULL OR l.speed_mps > c.most_mps OR l.gap_m > lead_reach_m(c.most_mps + $slower_mps)
            OR CASE WHEN c.limit_mps IS NOT NULL OR l.speed_mps <= e.speed_mps AND l.gap_m <= lead_reach_m(e.speed_mps + $slower_mps) THEN false END
        )
            -- If it is not known who else is in the way, a slow ego may have a reason.
            AND CASE WHEN w.known IS DISTINCT FROM false OR e.speed_mps > c.most_mps THEN true END
        WHEN e.speed_mps > c.most_mps THEN true END AS applies
FROM (
    SELECT *, bool_or(speed_mps <= standing_mps()) OVER (
        PARTITION BY drive_id, ego_id ORDER BY t_ns RANGE BETWEEN ($start_s * 1e9)::BIGINT PRECEDING AND CURRENT ROW
    ) AS has_stood
    FROM ego_state
) e
JOIN (
    -- least() ignores NULL: road_mps is the most that a road without a known limit requires.
    SELECT *, least(limit_mps, $desired_mps) - $slower_mps AS road_mps, $heavy_mps - $slower_mps AS heavy_mps,
        CASE WHEN vehicle_class = 'goods_over_7t5' THEN least(road_mps, heavy_mps) ELSE road_mps END AS most_mps,
        CASE WHEN limit_mps IS NULL THEN NULL WHEN vehicle_class IN ('car', 'motorcycle') THEN road_mps ELSE least(road_mps, heavy_mps) END AS least_mps
    FROM ego_condition
) c USING (drive_id, ego_id, t_ns)
LEFT JOIN lead l USING (drive_id, ego_id, t_ns)
LEFT JOIN in_way w USING (drive_id, ego_id, t_ns)
LEFT JOIN (
    SELECT DISTINCT n.drive_id, n.ego_id, n.t_ns
    FROM neighbour n
    JOIN ego_condition c USING (drive_id, ego_id, t_ns)
    WHERE may_be_vehicle(n.actor_class) AND abs(n.heading_diff_rad) < pi() / 2 AND n.gap_m > 0
        AND n.speed_mps <= least(c.limit_mps, $desired_mps, CASE WHEN c.limit_mps IS NULL THEN coalesce(n.ego_speed_mps, 0.0) + $slower_mps END) - $slower_mps
) b USING (drive_id, ego_id, t_ns)
LEFT JOIN (SELECT * FROM ego_mode WHERE mode = 'minimal_risk_manoeuvre') r USING (drive_id, ego_id, t_ns)
LEFT JOIN data_log g ON g.drive_id = e.drive_id
LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = e.lanelet_id
