-- title = "Time to brake"
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
-- requires = ["map", "registration", "ego_size", "speeds"]
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
-- a step without a row in `vehicle_ahead` is one at which nobody knows who leads
SELECT s.drive_id, s.ego_id, s.t_ns, l.object_id,
    CASE WHEN l.object_id IS NOT NULL THEN on_course(
        l.gap_m, ttc_s(l.gap_m, l.ego_speed_mps - along_mps(l.speed_mps, l.oncoming)),
        e.d_m, e.lat_half_m, e.speed_mps * sin(e.heading_diff_rad), p.d_m, p.lat_half_m, p.speed_mps * sin(p.heading_diff_rad)
    ) AND may_touch(l.passes_by, l.grazes) AND either_moves(l.ego_speed_mps, l.speed_mps) AND NOT comes(l.speed_mps, l.oncoming)
    -- one that is not seen is further away than the way that is free
    WHEN l.known OR ttb_s(l.free_m, l.ego_speed_mps, $brake_mps2) >= $least_s THEN true END AS applies,
    CASE WHEN l.grazes THEN graze_words(l.object_id) END AS reason
FROM step s
LEFT JOIN vehicle_ahead l ON l.drive_id = s.drive_id AND l.ego_id = s.ego_id AND l.t_ns = s.t_ns
LEFT JOIN pair p ON p.drive_id = l.drive_id AND p.ego_id = l.ego_id AND p.t_ns = l.t_ns AND p.object_id = l.object_id
LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns

-- @condition
-- where a speed is not known exactly, neither is what hangs on it
SELECT drive_id, ego_id, t_ns, object_id, $least_s AS required,
    CASE WHEN object_id IS NULL THEN 'inf'::DOUBLE ELSE sure(or_never(ttb_s(gap_m, k.closing_mps, $brake_mps2), $least_s), ttb_s(gap_m, k.closing_mps + error_mps, $brake_mps2), ttb_s(gap_m, k.closing_mps - error_mps, $brake_mps2), $least_s) END AS observed
FROM vehicle_ahead
CROSS JOIN LATERAL (SELECT ego_speed_mps - along_mps(speed_mps, oncoming) AS closing_mps) k
