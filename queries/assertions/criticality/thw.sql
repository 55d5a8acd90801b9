-- title = "Time headway"
-- clause = "Germany, BKatV no. 12.5 (distances): the time until the ego is where the vehicle ahead is now"
-- hypothesis = "At every step behind a vehicle in its lane, did the ego follow at no less than 0.9 s?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "s"
-- observes = "time headway"
-- near_margin = 0.3
-- merge_gap_s = 1.0
-- reads = ["cut_in", "ego_state", "pair", "step", "vehicle_ahead"]
-- requires = ["map", "registration", "ego_size", "speeds"]
--
-- [params.least_s]
-- default = 0.9
-- unit = "s"
-- why = "less than half of the rule of thumb (half the speedometer reading in metres, 1.8 s) is fined above 80 km/h; here it is asked for at any speed"
-- source = "BKatV no. 12.5"
--
-- [params.slowest_mps]
-- default = 5.0
-- unit = "m/s"
-- why = "our default: below it a queue closes up, and a headway says nothing"
--
-- [params.settle_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: after another vehicle cuts in, the ego has so long to restore the gap; after the ego itself cuts in, the rule asks at once"
--
-- [params.faster_mps]
-- default = 0.5
-- unit = "m/s"
-- why = "our default: so much faster than when the other came in the ego closes in by its own doing; a held speed trembles by less"

-- @applies
-- a step without a row in `vehicle_ahead` is one at which nobody knows who leads; a speed held at the limit trembles in its last digits
-- one that stands is not followed where the ego steers round it, and one that goes across the lane is not followed at all
SELECT s.drive_id, s.ego_id, s.t_ns, l.object_id,
    CASE WHEN l.object_id IS NOT NULL THEN behind(l.gap_m, e.d_m, e.lat_half_m, p.d_m, p.lat_half_m) AND NOT comes(l.speed_mps, l.oncoming) AND round(l.ego_speed_mps, 2) >= $slowest_mps
        AND (l.speed_mps > standing_mps() OR p.speed_mps <= standing_mps()
            AND on_course(l.gap_m, ttc_s(l.gap_m, l.ego_speed_mps), e.d_m, e.lat_half_m, e.speed_mps * sin(e.heading_diff_rad), p.d_m, p.lat_half_m, 0.0))
        AND NOT coalesce(s.t_ns - c.t_ns < $settle_s * 1e9 AND l.ego_speed_mps <= c.ego_speed_mps + $faster_mps, false)
    -- one that is not seen is further away than the way that is free
    WHEN l.known OR thw_s(l.free_m, l.ego_speed_mps) >= $least_s THEN true END AS applies
FROM step s
LEFT JOIN vehicle_ahead l ON l.drive_id = s.drive_id AND l.ego_id = s.ego_id AND l.t_ns = s.t_ns
LEFT JOIN pair p ON p.drive_id = l.drive_id AND p.ego_id = l.ego_id AND p.t_ns = l.t_ns AND p.object_id = l.object_id
LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
ASOF LEFT JOIN cut_in c ON c.drive_id = l.drive_id AND c.ego_id = l.ego_id AND c.object_id = l.object_id AND c.t_ns <= s.t_ns

-- @condition
SELECT drive_id, ego_id, t_ns, object_id, $least_s AS required,
    CASE WHEN object_id IS NULL THEN 'inf'::DOUBLE ELSE thw_s(gap_m, ego_speed_mps) END AS observed
FROM vehicle_ahead
