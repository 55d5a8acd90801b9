-- title = "Within the speed limit"
-- clause = "StVO 3(3), 18(5) (R_G3 of Maierhofer et al. 2020): do not exceed the limit of the road nor that of your kind of vehicle"
-- hypothesis = "At every step, was the ego no faster than the road and its kind of vehicle allow?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "<="
-- unit = "m/s"
-- observes = "speed"
-- merge_gap_s = 5.0
-- reads = ["ego_condition", "ego_state"]
-- requires = ["map", "registration", "speed_limits"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.tolerance_mps]
-- default = 0.83
-- unit = "m/s"
-- why = "our default: the 3 km/h that German police take off below 100 km/h"
--
-- [params.heavy_mps]
-- default = 22.22
-- unit = "m/s"
-- why = "80 km/h on motorways for vehicles over 3.5 t, buses and cars with trailers"
-- source = "StVO 18(5) no. 1"
--
-- [params.coach_mps]
-- default = 27.78
-- unit = "m/s"
-- why = "100 km/h for coaches approved for it, and by exemption for cars with trailers: neither is in a trace"
-- source = "StVO 18(5) no. 3"

-- @condition
-- vans of up to 3.5 t have no limit of their own; coaches, and cars with trailers by the 9th exemption, may be allowed 100 km/h
SELECT drive_id, ego_id, t_ns, e.speed_mps AS observed,
    CASE WHEN e.speed_mps > least(k.most_mps, c.limit_mps) + $tolerance_mps THEN least(k.most_mps, c.limit_mps)
        WHEN c.limit_mps IS NOT NULL AND e.speed_mps <= least(k.least_mps, c.limit_mps) + $tolerance_mps THEN least(k.least_mps, c.limit_mps)
    END + $tolerance_mps AS required,
    CASE WHEN c.limit_mps IS NULL THEN 'the map gives no limit here' WHEN c.vehicle_class IS NULL THEN 'kind of vehicle not known'
        WHEN e.speed_mps > k.least_mps THEN 'whether this vehicle may drive faster than 80 km/h is not known' END AS reason
FROM ego_state e
JOIN ego_condition c USING (drive_id, ego_id, t_ns)
CROSS JOIN LATERAL (
    SELECT
        CASE WHEN c.vehicle_class IN ('car', 'motorcycle') THEN 'inf'::DOUBLE ELSE $heavy_mps END AS least_mps,
        CASE WHEN c.vehicle_class = 'goods_over_7t5' THEN $heavy_mps WHEN c.vehicle_class IN ('bus', 'car_towing') THEN $coach_mps
            ELSE 'inf'::DOUBLE END AS most_mps
) k
