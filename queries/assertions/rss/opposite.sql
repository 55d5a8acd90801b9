-- title = "RSS: safe distance to an oncoming vehicle"
-- breach = "RSS: too close to an oncoming vehicle"
-- clause = "RSS definition 2 (Shalev-Shwartz et al. 2017): two vehicles that come towards each other in one lane keep room for both to stop"
-- hypothesis = "At every step with the ego in the opposing lane, or an oncoming vehicle in the ego's, could both have stopped in time?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = ">="
-- unit = "m"
-- observes = "distance to the oncoming vehicle"
-- near_margin = 2.0
-- reads = ["ego_state", "excursion", "lane_departure", "oncoming", "step", "vehicle_ahead"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [params.rho_s]
-- default = 1.0
-- unit = "s"
-- why = "response time of the ego"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.rho_other_s]
-- default = 2.0
-- unit = "s"
-- why = "response time of others, driven by people"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.accel_mps2]
-- default = 3.5
-- unit = "m/s2"
-- why = "greatest acceleration during the response time"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.brake_min_mps2]
-- default = 4.0
-- unit = "m/s2"
-- why = "braking that may be counted on after the response time"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.brake_correct_mps2]
-- default = 3.0
-- unit = "m/s2"
-- why = "braking of the vehicle in its own lane, which need not expect the other"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.lat_accel_mps2]
-- default = 0.2
-- unit = "m/s2"
-- why = "greatest acceleration to the side during the response time"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.lat_brake_mps2]
-- default = 0.8
-- unit = "m/s2"
-- why = "braking of the lateral movement after the response time"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.mu_m]
-- default = 0.1
-- unit = "m"
-- why = "vehicles do not keep their line exactly"
-- source = "ad-rss-lib, parameter discussion (fluctuation margin)"

-- @applies
-- The distance across is unsafe in the opposing lane, and in the ego's own lane if the two boxes are too near to each other across it. The
-- ego is in the opposing lane during a manoeuvre over its boundary, not when it only touches the line. Nothing is judged once the oncoming
-- vehicle is alongside, nor without an oncoming vehicle if every vehicle is placed.
SELECT s.drive_id, s.ego_id, s.t_ns, o.object_id, CASE WHEN o.object_id IS NOT NULL THEN o.da_m >= 0 WHEN o.n_unplaced = 0 THEN false END AS applies
FROM lane_departure d
JOIN excursion x ON x.drive_id = d.drive_id AND x.ego_id = d.ego_id AND x.t0_ns = d.t_ns
JOIN step s ON s.drive_id = d.drive_id AND s.ego_id = d.ego_id AND s.t_ns >= x.t0_ns AND s.t_ns <= x.t_end_ns
LEFT JOIN oncoming o ON o.drive_id = s.drive_id AND o.ego_id = s.ego_id AND o.t_ns = s.t_ns
WHERE NOT d.back AND x.overtaking IS DISTINCT FROM false AND x.over_against IS DISTINCT FROM false
UNION ALL
SELECT s.drive_id, s.ego_id, s.t_ns, v.object_id,
    CASE WHEN v.object_id IS NOT NULL THEN meets(v.in_lane, v.gap_m, v.speed_mps, v.oncoming)
        AND v.across_m < rss_across_m(v.ego_across_mps, $rho_s, v.across_mps, v.speed_mps, $rho_other_s, $lat_accel_mps2, $lat_brake_mps2, $mu_m)
        WHEN v.known THEN false END
FROM step s
LEFT JOIN vehicle_ahead v ON v.drive_id = s.drive_id AND v.ego_id = s.ego_id AND v.t_ns = s.t_ns

-- @condition
WITH oncoming_ahead AS (FROM vehicle_ahead WHERE object_id IS NOT NULL AND meets(in_lane, gap_m, speed_mps, oncoming) IS DISTINCT FROM false)
SELECT drive_id, ego_id, t_ns, object_id, gap_m AS observed,
    rss_way_m(ego_speed_mps, $rho_s, $accel_mps2, $brake_correct_mps2) + rss_way_m(speed_mps, $rho_other_s, $accel_mps2, $brake_min_mps2) AS required
FROM oncoming_ahead
UNION ALL
SELECT o.drive_id, o.ego_id, o.t_ns, o.object_id,
    -- A vehicle that is not placed may be nearer, so a distance is certain only if it is too small already.
    CASE WHEN o.n_unplaced = 0 OR o.da_m < required_gap.distance_m THEN o.da_m END, required_gap.distance_m
FROM oncoming o
ANTI JOIN oncoming_ahead a ON a.drive_id = o.drive_id AND a.ego_id = o.ego_id AND a.t_ns = o.t_ns AND a.object_id = o.object_id
JOIN ego_state e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.t_ns = o.t_ns
CROSS JOIN LATERAL (SELECT rss_way_m(e.speed_mps, $rho_s, $accel_mps2, $brake_min_mps2) + rss_way_m(o.speed_mps, $rho_other_s, $accel_mps2, $brake_correct_mps2) AS distance_m) required_gap
