-- title = "RSS: safe distance to the vehicle beside"
-- breach = "RSS: too close to the vehicle beside"
-- clause = "RSS definition 6 (Shalev-Shwartz et al. 2017; IEEE 2846): beside another vehicle keep room for both to stop drifting towards each other"
-- hypothesis = "At every step beside another vehicle, was the gap to it at least the safe lateral distance of RSS?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "major"
-- legal = "should"
-- status = "draft"
-- sense = ">="
-- unit = "m"
-- observes = "gap to the vehicle beside"
-- near_margin = 0.2
-- reads = ["beside"]
-- requires = ["map", "registration", "ego_size"]
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
-- This rule is a draft. RSS takes the lateral speed without its fluctuations (definition 5, over the time in which a vehicle leaves its
-- line by mu), but `beside` has the momentary lateral speed, across the ego's corridor. Recorded headings (NGSIM) make it jitter by half a
-- metre per second, and a vehicle that comes down a slip road at an angle has a speed across the corridor, although it only follows the
-- bend of its own lane. While two vehicles are beside each other, the distance along the road is unsafe. Before and after that it may be
-- safe, and is not judged here. A standing ego does not drift, nor does a parked car.
SELECT drive_id, ego_id, t_ns, object_id, CASE WHEN ego_speed_mps <= standing_mps() THEN false ELSE on_carriageway END AS applies
FROM beside
WHERE may_be_vehicle(actor_class)

-- @condition
-- The gap is measured from box to box. If the boxes are at an angle, it is larger than the gap between their extents across the road.
SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed,
    rss_across_m(ego_lat_mps, $rho_s, lat_mps, speed_mps, $rho_other_s, $lat_accel_mps2, $lat_brake_mps2, $mu_m) AS required
FROM beside
