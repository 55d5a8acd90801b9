-- title = "Sufficient time headway (THW)"
-- breach = "Too little time headway (THW)"
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
-- reads = ["actor", "cut_in", "ego_state", "pair", "step", "vehicle_ahead"]
-- requires = ["way", "ego_size", "speeds"]
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
-- why = "our default: below it a queue closes up, and a headway means nothing"
--
-- [params.settle_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: after another vehicle cuts in, the ego has this long to restore the gap; after the ego itself cuts in, the rule applies at once"
--
-- [params.faster_mps]
-- default = 0.5
-- unit = "m/s"
-- why = "our default: if the ego's speed is higher by more than this than when the other vehicle came in, the ego itself closes the gap; a constant speed varies by less"
--
-- [reasons.on_the_line]
-- says = "the ego rides on the line, beside the width of {object_id}, so that it may ride between the lanes and not behind it"
-- advice = "record positions and widths more exactly"

-- @applies
-- At a step without a row in `vehicle_ahead` it is not known which vehicle is ahead. The ego's speed is rounded because a speed that is
-- held at slowest_mps varies in its last digits. The ego does not follow a standing vehicle that it steers round, nor a vehicle that moves
-- across the lane.
SELECT s.drive_id, s.ego_id, s.t_ns, v.object_id,
    CASE WHEN v.object_id IS NOT NULL THEN lead_is_ahead(v.gap_m, e.d_m, e.lat_half_m, p.d_m, p.lat_half_m) AND NOT comes(v.speed_mps, v.oncoming) AND round(v.ego_speed_mps, 2) >= $slowest_mps
        AND (v.speed_mps > standing_mps() OR p.speed_mps <= standing_mps()
            AND on_course(v.gap_m, ttc_s(v.gap_m, v.ego_speed_mps), e.d_m, e.lat_half_m, e.speed_mps * sin(e.heading_diff_rad), p.d_m, p.lat_half_m, 0.0))
        AND CASE WHEN NOT beside.on_line THEN true END
        AND NOT coalesce(s.t_ns - c.t_ns < $settle_s * 1e9 AND v.ego_speed_mps <= c.ego_speed_mps + $faster_mps, false)
    -- A vehicle that is not seen is at least free_m away.
    WHEN v.known OR thw_s(v.free_m, v.ego_speed_mps) >= $least_s THEN true END AS applies,
    CASE WHEN beside.on_line THEN why('on_the_line', {'object_id': v.object_id}) END AS reason
FROM step s
LEFT JOIN vehicle_ahead v ON v.drive_id = s.drive_id AND v.ego_id = s.ego_id AND v.t_ns = s.t_ns
LEFT JOIN pair p ON p.drive_id = v.drive_id AND p.ego_id = v.ego_id AND p.t_ns = v.t_ns AND p.object_id = v.object_id
LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
LEFT JOIN actor a ON a.drive_id = s.drive_id AND a.actor_id = s.ego_id
ASOF LEFT JOIN cut_in c ON c.drive_id = v.drive_id AND c.ego_id = v.ego_id AND c.object_id = v.object_id AND c.t_ns <= s.t_ns
CROSS JOIN LATERAL (SELECT may_ride_on_line(a.actor_class, e.d_m, e.lat_half_m, p.d_m, p.lat_half_m, p.half_width_m) AS on_line) beside

-- @condition
SELECT drive_id, ego_id, t_ns, object_id, $least_s AS required,
    CASE WHEN object_id IS NULL THEN 'inf'::DOUBLE ELSE thw_s(gap_m, ego_speed_mps) END AS observed
FROM vehicle_ahead
