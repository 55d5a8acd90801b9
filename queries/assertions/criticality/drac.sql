-- title = "Deceleration rate to avoid the crash"
-- clause = "Cooper and Ferguson 1976: the braking that it takes not to hit the vehicle ahead"
-- hypothesis = "At every step behind a vehicle in its lane, did avoiding it ask for no more than ordinary braking?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = "<="
-- unit = "m/s2"
-- observes = "braking that avoids a collision"
-- near_margin = 0.5
-- merge_gap_s = 1.0
-- reads = ["ego_state", "pair", "step", "vehicle_ahead"]
-- requires = ["map", "registration", "ego_size", "speeds"]
--
-- [params.most_mps2]
-- default = 3.4
-- unit = "m/s2"
-- why = "comfortable for most drivers, and what stopping sight distances are designed for"
-- source = "AASHTO Green Book, stopping sight distance, 11.2 ft/s2 (not seen)"

-- @applies
-- a step without a row in `vehicle_ahead` is one at which nobody knows who leads
SELECT s.drive_id, s.ego_id, s.t_ns, l.object_id,
    CASE WHEN l.object_id IS NOT NULL THEN on_course(
        l.gap_m, ttc_s(l.gap_m, l.ego_speed_mps - along_mps(l.speed_mps, l.oncoming)),
        e.d_m, e.lat_half_m, e.speed_mps * sin(e.heading_diff_rad), p.d_m, p.lat_half_m, p.speed_mps * sin(p.heading_diff_rad)
    ) AND may_touch(l.passes_by, l.grazes) AND either_moves(l.ego_speed_mps, l.speed_mps) AND NOT comes(l.speed_mps, l.oncoming)
    -- one that is not seen is further away than the way that is free
    WHEN l.known OR drac_mps2(l.free_m, l.ego_speed_mps) <= $most_mps2 THEN true END AS applies,
    CASE WHEN l.grazes THEN graze_words(l.object_id) END AS reason
FROM step s
LEFT JOIN vehicle_ahead l ON l.drive_id = s.drive_id AND l.ego_id = s.ego_id AND l.t_ns = s.t_ns
LEFT JOIN pair p ON p.drive_id = l.drive_id AND p.ego_id = l.ego_id AND p.t_ns = l.t_ns AND p.object_id = l.object_id
LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns

-- @condition
-- where a speed is not known exactly, neither is what hangs on it
SELECT drive_id, ego_id, t_ns, object_id, $most_mps2 AS required,
    CASE WHEN object_id IS NULL THEN 0.0::DOUBLE ELSE sure_most(drac_mps2(gap_m, k.closing_mps), drac_mps2(gap_m, k.closing_mps + error_mps), drac_mps2(gap_m, k.closing_mps - error_mps), $most_mps2) END AS observed
FROM vehicle_ahead
CROSS JOIN LATERAL (SELECT ego_speed_mps - along_mps(speed_mps, oncoming) AS closing_mps) k
