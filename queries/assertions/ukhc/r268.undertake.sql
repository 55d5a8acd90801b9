-- title = "No overtaking on the left on motorways"
-- breach = "Overtook on the left on a motorway"
-- clause = "UKHC R268: do not overtake on the left or move to a lane on your left to overtake; in congestion you may pass slower traffic on your right"
-- hypothesis = "When the ego's front got past another vehicle's on a motorway, was that vehicle not on the overtaking side, or was traffic slow?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "draft"
-- law = ["gb"]
-- sense = "holds"
-- reads = ["data_log", "ego_state", "environment", "lanelet", "passing"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.congestion_mps]
-- default = 16.7
-- unit = "m/s"
-- why = "our default: 60 km/h; where both are slower, lanes move at their own speeds"
--
-- # Draft: whether it was done to overtake, or the other merely slowed down in its lane to leave, is a judgement.
--
-- [reasons.other_unplaced]
-- says = "another vehicle cannot be placed, and may have been passed"
--
-- [reasons.passed_standing]
-- says = "{object_id} stood, and it is not known whether it waited in the traffic or had broken down"
-- advice = "see in a video whether it had broken down"
--
-- [reasons.passed_on_side]
-- says = "ego at {ego_speed_mps:.1f} m/s, the other {speed_mps:.1f} m/s on its {side}"

-- @reference
SELECT drive_id, ego_id, t_ns, object_id, occurrence FROM passing WHERE coalesce(ego_passes AND NOT same_lane, true)

-- @condition
-- An ego that leaves by an exit lane may pass the vehicles that stay. To go past a vehicle that has broken down is not to undertake it.
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, p.side <> overtaking_side(m.handedness) OR CASE WHEN p.speed_mps > standing_mps() THEN false END AS holds,
    NOT (p.ego_speed_mps < $congestion_mps AND p.speed_mps < $congestion_mps) AND n.lane_type NOT IN ('exit', 'offRamp') AS applies,
    CASE WHEN p.ego_passes IS NULL THEN why('other_unplaced')
        WHEN p.side = overtaking_side(m.handedness) AND p.speed_mps <= standing_mps() THEN why('passed_standing', {'object_id': r.object_id})
        WHEN p.ego_speed_mps IS NOT NULL AND p.speed_mps IS NOT NULL AND p.side IS NOT NULL
            THEN why('passed_on_side', {'ego_speed_mps': p.ego_speed_mps, 'speed_mps': p.speed_mps, 'side': p.side}) END AS reason
FROM reference r
JOIN passing p USING (drive_id, ego_id, occurrence)
JOIN data_log g USING (drive_id)
JOIN environment m USING (environment_id)
LEFT JOIN ego_state e ON e.drive_id = r.drive_id AND e.ego_id = r.ego_id AND e.t_ns = r.t_ns
LEFT JOIN lanelet n ON n.environment_id = m.environment_id AND n.lanelet_id = e.lanelet_id
