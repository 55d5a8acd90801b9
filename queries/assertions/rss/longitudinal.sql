-- title = "RSS: safe distance to the vehicle ahead"
-- breach = "RSS: too close to the vehicle ahead"
-- clause = "RSS definition 1 (Shalev-Shwartz et al. 2017; IEEE 2846): keep the distance at which you can stop if the vehicle ahead brakes as hard as it can"
-- hypothesis = "At every step, was the gap to the vehicle ahead at least the safe longitudinal distance of RSS?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = ">="
-- unit = "m"
-- observes = "gap to the vehicle ahead"
-- near_margin = 2.0
-- reads = ["step", "vehicle_ahead"]
-- requires = ["way", "ego_size"]
--
-- [params.rho_s]
-- default = 1.0
-- unit = "s"
-- why = "response time of the ego"
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
-- [params.brake_max_mps2]
-- default = 8.0
-- unit = "m/s2"
-- why = "hardest braking of the vehicle ahead"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.rho_other_s]
-- default = 2.0
-- unit = "s"
-- why = "response time of others, driven by people"
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
--
-- # Draft: the model calls dangerous an ordinary gap of two seconds, a calm approach, and a gap into which another vehicle moved.

-- @applies
-- RSS calls a situation dangerous if the distances along and across are both unsafe: a vehicle that the ego passes inside the lane may be
-- at a safe distance across. A standing ego already does what RSS demands. At a step without a row in `vehicle_ahead` it is not known
-- which vehicle is ahead.
SELECT s.drive_id, s.ego_id, s.t_ns, v.object_id,
    CASE WHEN v.object_id IS NOT NULL THEN follows(v.in_lane, v.gap_m, v.speed_mps, v.oncoming) AND v.ego_speed_mps > standing_mps()
        AND v.across_m < rss_across_m(v.ego_across_mps, $rho_s, v.across_mps, v.speed_mps, $rho_other_s, $lat_accel_mps2, $lat_brake_mps2, $mu_m)
        WHEN v.known THEN false END AS applies
FROM step s
LEFT JOIN vehicle_ahead v ON v.drive_id = s.drive_id AND v.ego_id = s.ego_id AND v.t_ns = s.t_ns

-- @condition
SELECT drive_id, ego_id, t_ns, object_id, gap_m AS observed,
    rss_longitudinal_m(ego_speed_mps, ahead_mps(speed_mps, oncoming), $rho_s, $accel_mps2, $brake_min_mps2, $brake_max_mps2) AS required
FROM vehicle_ahead
