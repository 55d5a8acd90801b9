-- title = "Sufficient modified time to collision (MTTC)"
-- breach = "Too little modified time to collision (MTTC)"
-- clause = "Ozbay, Yang, Bartin, Mudigonda 2008: the time until ego and leading vehicle would collide at their present accelerations"
-- hypothesis = "At every step behind a vehicle in its lane, or in the way of an oncoming vehicle, was the ego at least 1.5 s from hitting it if both kept their accelerations?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "s"
-- observes = "modified time to collision"
-- near_margin = 0.5
-- merge_gap_s = 1.0
-- reads = ["clock", "ego_motion", "ego_state", "pair", "step", "vehicle_ahead"]
-- requires = ["way", "ego_size", "speeds"]
--
-- [params.least_s]
-- default = 1.5
-- unit = "s"
-- why = "our default: the same as for the time to collision"
--
-- [params.edge_s]
-- default = 0.5
-- unit = "s"
-- why = "our default: this near to the ends of the log, the windows of the accelerations are not complete"
--
-- [reasons.points_into_way]
-- says = "{object_id} is beside the ego's path and does not come nearer, but its heading at this step points into the path"
-- advice = "record headings more exactly"
--
-- [reasons.mean_accelerations]
-- says = "the accelerations are means over half a second, so it is not known whether the time is above or below the limit"
-- advice = "no better recording can decide this"

-- @applies
-- A vehicle beside the ego's way that does not close in yet would get into the way only by its heading at this step, and one heading is no
-- proof. At a step without a row in `vehicle_ahead` it is not known which vehicle is ahead.
SELECT s.drive_id, s.ego_id, s.t_ns, v.object_id,
    CASE WHEN v.object_id IS NOT NULL THEN on_course(
        -- The boxes are moved across the lane at their present speeds, to the time at which the gap is gone at the present accelerations.
        v.gap_m, coalesce(mttc_s(v.gap_m, v.ego_speed_mps, m.accel_mps2, motion.away_mps, motion.other_mps2), motion.ttc_s),
        e.d_m, e.lat_half_m, e.speed_mps * sin(e.heading_diff_rad), p.d_m, p.lat_half_m, p.speed_mps * sin(p.heading_diff_rad)
    ) AND must_keep(v.passes_by, v.grazes, mttc_s(v.gap_m, v.ego_speed_mps, m.accel_mps2, motion.away_mps, motion.other_mps2) >= $least_s) AND CASE WHEN v.across_m < 0 OR motion.ttc_s < 'inf' THEN true END AND either_moves(v.ego_speed_mps, v.speed_mps)
    -- A vehicle that is not seen is at least free_m away, and the two close in with no more acceleration than tyres allow.
    WHEN v.known OR gap_closed_s(v.free_m, v.free_mps, 10.0) >= $least_s THEN true END AS applies,
    CASE WHEN v.grazes THEN graze_doubt(v.object_id)
        WHEN v.across_m >= 0 AND motion.ttc_s = 'inf' THEN why('points_into_way', {'object_id': v.object_id}) END AS reason
FROM step s
LEFT JOIN vehicle_ahead v ON v.drive_id = s.drive_id AND v.ego_id = s.ego_id AND v.t_ns = s.t_ns
LEFT JOIN pair p ON p.drive_id = v.drive_id AND p.ego_id = v.ego_id AND p.t_ns = v.t_ns AND p.object_id = v.object_id
LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
LEFT JOIN ego_motion m ON m.drive_id = s.drive_id AND m.ego_id = s.ego_id AND m.t_ns = s.t_ns
CROSS JOIN LATERAL (SELECT along_mps(v.speed_mps, v.oncoming) AS away_mps, along_mps(v.accel_mps2, v.oncoming) AS other_mps2, or_never(ttc_s(v.gap_m, v.ego_speed_mps - along_mps(v.speed_mps, v.oncoming)), $least_s) AS ttc_s) motion

-- @condition
-- At the ends of the log the windows of the accelerations are not whole, which says nothing about the drive. The accelerations are
-- smoothed: the ego's acceleration shows before it begins, the other vehicle's shows after it begins and still shows when it is over. If
-- this decides on which side of the limit the value is, the value is not known.
SELECT v.drive_id, v.ego_id, v.t_ns, v.object_id, $least_s AS required, v.object_id IS NULL OR is_judged(m.accel_mps2 + v.other_mps2, v.t_ns, c.t_start_ns, c.t_end_ns, $edge_s) AS applies,
    bounded.observed,
    CASE WHEN bounded.observed IS NULL AND v.gap_m + m.accel_mps2 + v.other_mps2 IS NOT NULL
        THEN why('mean_accelerations') END AS reason
FROM (
    SELECT *, along_mps(speed_mps, oncoming) AS away_mps, along_mps(accel_mps2, oncoming) AS other_mps2,
        min(along_mps(accel_mps2, oncoming)) OVER following_steps AS least_mps2, max(along_mps(accel_mps2, oncoming)) OVER following_steps AS most_mps2
    FROM vehicle_ahead
    WINDOW following_steps AS (PARTITION BY drive_id, ego_id, object_id ORDER BY t_ns RANGE BETWEEN CURRENT ROW AND ($edge_s * 1e9)::BIGINT FOLLOWING)
) v
JOIN clock c ON c.drive_id = v.drive_id AND c.ego_id = v.ego_id
JOIN (
    SELECT *, max(accel_mps2) OVER preceding_steps AS most_mps2, min(accel_mps2) OVER preceding_steps AS least_mps2
    FROM ego_motion
    WINDOW preceding_steps AS (PARTITION BY drive_id, ego_id ORDER BY t_ns RANGE BETWEEN ($edge_s * 1e9)::BIGINT PRECEDING AND CURRENT ROW)
) m ON m.drive_id = v.drive_id AND m.ego_id = v.ego_id AND m.t_ns = v.t_ns
CROSS JOIN LATERAL (
    SELECT CASE WHEN v.object_id IS NULL THEN 'inf'::DOUBLE
        ELSE sure_at_least(
            or_never(mttc_s(v.gap_m, v.ego_speed_mps, m.accel_mps2, v.away_mps, v.other_mps2), $least_s),
            mttc_s(v.gap_m, v.ego_speed_mps, m.most_mps2, v.away_mps, v.least_mps2),
            mttc_s(v.gap_m, v.ego_speed_mps, m.least_mps2, v.away_mps, v.most_mps2), $least_s
        ) END AS observed
) bounded
