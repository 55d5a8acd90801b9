-- title = "Time to collision"
-- clause = "Hayward 1972: the time until ego and leading vehicle would collide at their present speeds"
-- hypothesis = "At every step behind a vehicle in its lane, or in the way of one that comes towards it, was the ego at least 1.5 s from hitting it at the present speeds?"
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
-- requires = ["map", "registration", "ego_size", "speeds"]
--
-- [params.least_s]
-- default = 1.5
-- unit = "s"
-- why = "below it a conflict counts as serious"
-- source = "van der Horst 1990 (not seen)"

-- @applies
-- a step without a row in `vehicle_ahead` is one at which nobody knows who leads
-- crossing traffic is not looked at here: criticality.pet does
SELECT s.drive_id, s.ego_id, s.t_ns, l.object_id,
    CASE WHEN l.object_id IS NOT NULL THEN on_course(
        l.gap_m, ttc_s(l.gap_m, l.ego_speed_mps - along_mps(l.speed_mps, l.oncoming)),
        e.d_m, e.lat_half_m, e.speed_mps * sin(e.heading_diff_rad), p.d_m, p.lat_half_m, p.speed_mps * sin(p.heading_diff_rad)
    ) AND may_touch(l.passes_by, l.grazes) AND either_moves(l.ego_speed_mps, l.speed_mps)
    -- one that is not seen is further away than the way that is free
    WHEN l.known OR ttc_s(l.free_m, l.free_mps) >= $least_s THEN true END AS applies,
    CASE WHEN l.grazes THEN graze_words(l.object_id) END AS reason
FROM step s
LEFT JOIN vehicle_ahead l ON l.drive_id = s.drive_id AND l.ego_id = s.ego_id AND l.t_ns = s.t_ns
LEFT JOIN pair p ON p.drive_id = l.drive_id AND p.ego_id = l.ego_id AND p.t_ns = l.t_ns AND p.object_id = l.object_id
LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns

-- @condition
-- where a speed is not known exactly, neither is what hangs on it
SELECT drive_id, ego_id, t_ns, object_id, $least_s AS required,
    CASE WHEN object_id IS NULL THEN 'inf'::DOUBLE ELSE sure(or_never(ttc_s(gap_m, k.closing_mps), $least_s), ttc_s(gap_m, k.closing_mps + error_mps), ttc_s(gap_m, k.closing_mps - error_mps), $least_s) END AS observed
FROM vehicle_ahead
CROSS JOIN LATERAL (SELECT ego_speed_mps - along_mps(speed_mps, oncoming) AS closing_mps) k
