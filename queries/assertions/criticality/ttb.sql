-- title = "Sufficient time to brake (TTB)"
-- breach = "Too little time to brake (TTB)"
-- clause = "Hillenbrand, Spieker, Kroschel 2006: the time left until only full braking avoids the collision"
-- hypothesis = "At every step behind a vehicle in its lane, could the ego have waited another second before braking fully?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "s"
-- observes = "time left to brake"
-- near_margin = 0.5
-- merge_gap_s = 1.0
-- reads = ["ego_state", "pair", "step", "vehicle_ahead"]
-- requires = ["way", "ego_size", "speeds"]
-- unaffected_by = ["velocity"]
--
-- [params.least_s]
-- default = 1.0
-- unit = "s"
-- why = "a second to see and to act"
-- source = "Hillenbrand, Spieker, Kroschel 2006 (not seen)"
--
-- [params.brake_mps2]
-- default = 8.0
-- unit = "m/s2"
-- why = "full braking on a dry road: the b_max of RSS"
-- source = "ad-rss-lib, parameter discussion"

-- @applies
-- At a step without a row in `vehicle_ahead` it is not known which vehicle is ahead.
SELECT s.drive_id, s.ego_id, s.t_ns, v.object_id,
    CASE WHEN v.object_id IS NOT NULL THEN unless_in_doubt(on_course(
        v.gap_m, ttc_s(v.gap_m, v.ego_speed_mps - along_mps(v.speed_mps, v.oncoming)),
        e.d_m, e.lat_half_m, e.speed_mps * sin(e.heading_diff_rad), p.d_m, p.lat_half_m, p.speed_mps * sin(p.heading_diff_rad)
    ) AND must_keep(v.passes_by, v.grazes, ttb_s(v.gap_m, v.ego_speed_mps - along_mps(v.speed_mps, v.oncoming), $brake_mps2) >= $least_s) AND either_moves(v.ego_speed_mps, v.speed_mps) AND NOT comes(v.speed_mps, v.oncoming), v.closing_more_mps + v.closing_less_mps)
    -- A vehicle that is not seen is at least free_m away.
    WHEN v.closing_more_mps + v.closing_less_mps <= 0 AND (v.known OR ttb_s(v.free_m, v.ego_speed_mps, $brake_mps2) >= $least_s) THEN true END AS applies,
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
    SELECT CASE WHEN object_id IS NULL THEN 'inf'::DOUBLE ELSE sure_at_least(or_never(ttb_s(gap_m, motion.closing_mps, $brake_mps2), $least_s), ttb_s(gap_m, motion.closing_mps + error_mps + closing_more_mps, $brake_mps2), ttb_s(gap_m, motion.closing_mps - error_mps - closing_less_mps, $brake_mps2), $least_s) END AS observed
) bounded
