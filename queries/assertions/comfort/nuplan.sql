-- title = "Acceleration and jerk within nuPlan's bounds"
-- breach = "Acceleration or jerk beyond nuPlan's bounds"
-- clause = "nuPlan, metric ego_is_comfortable: stay within the accelerations and jerks of expert drivers (here four of its seven bounds: those of the yaw, and of the jerk as a vector, 8.37 m/s3, are not judged)"
-- hypothesis = "At every step, were the ego's accelerations and its longitudinal jerk within the bounds?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "<="
-- unit = "of the bound"
-- observes = "largest of acceleration, braking, lateral acceleration and jerk, each as a share of its bound,"
-- near_margin = 0.1
-- reads = ["clock", "ego_motion"]
-- requires = ["speeds"]
--
-- [params.accel_mps2]
-- default = 2.4
-- unit = "m/s2"
-- why = "greatest acceleration"
-- source = "nuPlan devkit, ego_is_comfortable"
--
-- [params.brake_mps2]
-- default = 4.05
-- unit = "m/s2"
-- why = "greatest deceleration"
-- source = "nuPlan devkit, ego_is_comfortable"
--
-- [params.lat_mps2]
-- default = 4.89
-- unit = "m/s2"
-- why = "greatest lateral acceleration"
-- source = "nuPlan devkit, ego_is_comfortable"
--
-- [params.jerk_mps3]
-- default = 4.13
-- unit = "m/s3"
-- why = "greatest longitudinal jerk"
-- source = "nuPlan devkit, ego_is_comfortable"
--
-- [params.edge_s]
-- default = 1.0
-- unit = "s"
-- why = "our default: this near to the ends of the log, the filter's windows are not complete"
--
-- [reasons.peak_over_bound_flattened]
-- says = "the filter against noise may have flattened a peak over the bound"
-- advice = "no better recording can decide this"

-- @condition
-- The motion is filtered before it is differentiated, see ego_motion.
SELECT m.drive_id, m.ego_id, m.t_ns, decided.share AS observed, 1.0::DOUBLE AS required, bound.largest_share - bound.least_share AS error,
    is_judged(coalesce(decided.share, m.accel_mps2 + m.lat_accel_mps2 + m.jerk_mps3), m.t_ns, c.t_start_ns, c.t_end_ns, $edge_s) AS applies,
    CASE WHEN bound.largest_share <= 1 AND bound.possible_share > 1 THEN why('peak_over_bound_flattened') END AS reason
FROM ego_motion m
JOIN clock c ON c.drive_id = m.drive_id AND c.ego_id = m.ego_id
-- nuPlan's filter of the jerk is as wide as ours, so a peak of the jerk that our filter flattens does not count.
-- greatest() ignores NULL: the known values can show that a bound was exceeded, but not that all bounds were kept.
CROSS JOIN LATERAL (
    SELECT greatest(m.accel_mps2 / $accel_mps2, -m.accel_mps2 / $brake_mps2, abs(m.lat_accel_mps2) / $lat_mps2, abs(m.jerk_mps3) / $jerk_mps3) AS largest_share,
        greatest((m.accel_mps2 - m.accel_error_mps2) / $accel_mps2, (-m.accel_mps2 - m.accel_error_mps2) / $brake_mps2,
            (abs(m.lat_accel_mps2) - m.lat_error_mps2) / $lat_mps2, (abs(m.jerk_mps3) - m.jerk_error_mps3) / $jerk_mps3) AS least_share,
        greatest((abs(m.accel_mps2) + m.accel_peak_mps2) / CASE WHEN m.accel_mps2 > 0 THEN $accel_mps2 ELSE $brake_mps2 END,
            (abs(m.lat_accel_mps2) + m.lat_peak_mps2) / $lat_mps2, abs(m.jerk_mps3) / $jerk_mps3) AS possible_share
) bound
CROSS JOIN LATERAL (SELECT CASE WHEN bound.largest_share > 1 OR m.accel_mps2 + m.lat_accel_mps2 + m.jerk_mps3 IS NOT NULL AND bound.possible_share <= 1 THEN bound.largest_share END AS share) decided
