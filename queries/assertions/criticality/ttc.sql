-- title = "Sufficient time to collision (TTC)"
-- breach = "Too little time to collision (TTC)"
-- clause = "Hayward 1972: the time until ego and leading vehicle would collide at their present speeds"
-- hypothesis = "At every step behind a vehicle in its lane, or in the way of an oncoming vehicle, was the ego at least 1.5 s from hitting it at the present speeds?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "s"
-- observes = "time to collision"
-- near_margin = 0.5
-- merge_gap_s = 1.0
-- reads = ["ego_state", "pair", "step", "vehicle_ahead"]
-- requires = ["way", "ego_size", "speeds"]
-- unaffected_by = ["velocity"]
--
-- [params.least_s]
-- default = 1.5
-- unit = "s"
-- why = "below it a conflict counts as serious"
-- source = "van der Horst 1990 (not seen)"

-- @applies
-- At a step without a row in `vehicle_ahead` it is not known which vehicle is ahead. Crossing traffic is not judged here, but by
-- criticality.pet.
SELECT s.drive_id, s.ego_id, s.t_ns, v.object_id,
    CASE WHEN v.object_id IS NOT NULL THEN unless_in_doubt(on_course(
        v.gap_m, ttc_s(v.gap_m, v.ego_speed_mps - along_mps(v.speed_mps, v.oncoming)),
        e.d_m, e.lat_half_m, e.speed_mps * sin(e.heading_diff_rad), p.d_m, p.lat_half_m, p.speed_mps * sin(p.heading_diff_rad)
    ) AND must_keep(v.passes_by, v.grazes, ttc_s(v.gap_m, v.ego_speed_mps - along_mps(v.speed_mps, v.oncoming)) >= $least_s) AND either_moves(v.ego_speed_mps, v.speed_mps), v.closing_more_mps + v.closing_less_mps)
    -- A vehicle that is not seen is at least free_m away.
    WHEN v.closing_more_mps + v.closing_less_mps <= 0 AND (v.known OR ttc_s(v.free_m, v.free_mps) >= $least_s) THEN true END AS applies,
    CASE WHEN v.grazes THEN graze_doubt(v.object_id) END AS reason
FROM step s
LEFT JOIN vehicle_ahead v ON v.drive_id = s.drive_id AND v.ego_id = s.ego_id AND v.t_ns = s.t_ns
LEFT JOIN pair p ON p.drive_id = v.drive_id AND p.ego_id = v.ego_id AND p.t_ns = v.t_ns AND p.object_id = v.object_id
LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns

-- @condition
-- The value is known only if the error of the speeds does not change on which side of the limit it is. The velocity of a jolt has bounds.
SELECT drive_id, ego_id, t_ns, object_id, $least_s AS required, bounded.observed,
    CASE WHEN bounded.observed IS NULL AND closing_more_mps + closing_less_mps > 0 THEN why('velocity_in_doubt', {'object_id': object_id}) END AS reason
FROM vehicle_ahead
CROSS JOIN LATERAL (SELECT ego_speed_mps - along_mps(speed_mps, oncoming) AS closing_mps) motion
CROSS JOIN LATERAL (
    SELECT CASE WHEN object_id IS NULL THEN 'inf'::DOUBLE ELSE sure_at_least(or_never(ttc_s(gap_m, motion.closing_mps), $least_s), ttc_s(gap_m, motion.closing_mps + error_mps + closing_more_mps), ttc_s(gap_m, motion.closing_mps - error_mps - closing_less_mps), $least_s) END AS observed
) bounded
