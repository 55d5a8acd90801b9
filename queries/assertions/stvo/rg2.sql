-- title = "No unnecessary hard braking"
-- breach = "Braked hard without need"
-- clause = "StVO 4(1) (R_G2 of Maierhofer et al. 2020): who drives ahead must not brake hard without a compelling reason; the formula does not ask whether anybody is behind, nor does this rule"
-- hypothesis = "At every step, did the ego brake no harder than allowed, unless a vehicle ahead was too near or had itself braked, or somebody was in the way?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- law = ["de"]
-- sense = ">="
-- unit = "m/s2"
-- observes = "acceleration"
-- near_margin = 0.2
-- tags = ["excuses"]
-- reads = ["clock", "data_log", "ego_mode", "ego_motion", "ego_state", "in_way", "lanelet", "lead"]
-- requires = ["map", "registration", "ego_size"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.abrupt_mps2]
-- default = 2.0
-- unit = "m/s2"
-- why = "deceleration beyond which braking is abrupt: taken by itself, and as the difference from that of the vehicle ahead"
-- source = "Maierhofer et al. 2020, Table II (a_abrupt)"
--
-- [params.lately_s]
-- default = 1.0
-- unit = "s"
-- why = "our default: the ego may begin to brake this much later than the vehicle ahead, and may go on braking this long after that vehicle stopped braking or is no longer too near"
--
-- [params.reaction_s]
-- default = 0.3
-- unit = "s"
-- why = "time before the follower brakes"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.brake_mps2]
-- default = 10.0
-- unit = "m/s2"
-- why = "hardest deceleration of the follower"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.brake_lead_mps2]
-- default = 10.5
-- unit = "m/s2"
-- why = "hardest deceleration of the vehicle ahead"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.edge_s]
-- default = 1.0
-- unit = "s"
-- why = "our default: this near to the ends of the log, the filter's windows are not complete"
--
-- [reasons.peak_beyond_limit_flattened]
-- says = "the filter against noise may have flattened a peak beyond the limit"
-- advice = "no better recording can decide this"
--
-- [reasons.braked_to_leave]
-- says = "the ego braked on a lane of type {lane_type}, which is there to slow down on"
-- advice = "see in a video whether it braked harder than the ramp demands"

-- @condition
-- The filter of the acceleration flattens peaks: the true deceleration may be harder than the filtered one by accel_peak_mps2.
SELECT m.drive_id, m.ego_id, m.t_ns, -peak_sure_at_most(-m.accel_mps2, m.accel_peak_mps2, $abrupt_mps2) AS observed, -$abrupt_mps2 AS required, m.accel_error_mps2 AS error,
    -- Braking has a reason if the vehicle ahead is too near, was too near a moment ago, or brakes itself, and also if anybody else is in
    -- the way (a person, an animal, a thing). At a step without a row in `lead`, there may be such a vehicle. Why hazard lights were on, or
    -- an emergency was declared, or how hard the bend of a ramp makes who leaves brake, a person must judge.
    is_judged(m.accel_mps2, m.t_ns, c.t_start_ns, c.t_end_ns, $edge_s) AND NOT (m.accel_mps2 - m.accel_peak_mps2 < -$abrupt_mps2 AND (
        CASE WHEN l.t_ns IS NOT NULL THEN l.object_id IS NOT NULL AND (
            l.is_too_near OR m.accel_mps2 - l.hardest_mps2 >= -$abrupt_mps2 OR CASE WHEN l.known THEN false END) END
        OR CASE WHEN coalesce(n.lane_type IN ('exit', 'offRamp', 'mwyExit', 'connectingRamp'), false) THEN NULL ELSE false END
        OR asks_to_brake(w.need_mps2, w.known, $abrupt_mps2)
        OR CASE WHEN coalesce(e.indicator = 'hazard', false) OR emergency.t_ns IS NOT NULL THEN NULL ELSE false END)) AS applies,
    CASE WHEN m.accel_mps2 >= -$abrupt_mps2 AND m.accel_mps2 - m.accel_peak_mps2 < -$abrupt_mps2 THEN why('peak_beyond_limit_flattened')
        WHEN m.accel_mps2 < -$abrupt_mps2 AND n.lane_type IN ('exit', 'offRamp', 'mwyExit', 'connectingRamp') THEN why('braked_to_leave', {'lane_type': n.lane_type}) END AS reason
FROM ego_motion m
JOIN clock c ON c.drive_id = m.drive_id AND c.ego_id = m.ego_id
LEFT JOIN (
    SELECT *, bool_or(gap_m < stvo_safe_gap_m(ego_speed_mps, speed_mps, $reaction_s, $brake_mps2, $brake_lead_mps2)) OVER recent AS is_too_near,
        min(accel_mps2) OVER recent AS hardest_mps2, bool_and(accel_mps2 + gap_m + speed_mps + ego_speed_mps IS NOT NULL) OVER recent AS known
    FROM lead
    WINDOW recent AS (PARTITION BY drive_id, ego_id, object_id ORDER BY t_ns RANGE BETWEEN ($lately_s * 1e9)::BIGINT PRECEDING AND CURRENT ROW)
) l ON l.drive_id = m.drive_id AND l.ego_id = m.ego_id AND l.t_ns = m.t_ns
LEFT JOIN in_way w ON w.drive_id = m.drive_id AND w.ego_id = m.ego_id AND w.t_ns = m.t_ns
LEFT JOIN ego_state e ON e.drive_id = m.drive_id AND e.ego_id = m.ego_id AND e.t_ns = m.t_ns
LEFT JOIN (
    SELECT DISTINCT drive_id, ego_id, t_ns FROM ego_mode WHERE mode IN ('minimal_risk_manoeuvre', 'emergency_manoeuvre') AND is_on
) emergency ON emergency.drive_id = m.drive_id AND emergency.ego_id = m.ego_id AND emergency.t_ns = m.t_ns
LEFT JOIN data_log g ON g.drive_id = m.drive_id
LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = e.lanelet_id
