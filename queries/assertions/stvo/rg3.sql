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
-- why = "80 km/h on motorways for lorries, buses and cars with trailers"
-- source = "StVO 18(5)"

-- @condition
SELECT drive_id, ego_id, t_ns, e.speed_mps AS observed,
    CASE WHEN c.limit_mps <= $heavy_mps OR c.vehicle_class IN ('car', 'motorcycle') THEN c.limit_mps
        WHEN c.limit_mps IS NOT NULL AND c.vehicle_class IS NOT NULL THEN $heavy_mps END + $tolerance_mps AS required,
    CASE WHEN c.limit_mps IS NULL THEN 'the map gives no limit here' WHEN c.vehicle_class IS NULL THEN 'kind of vehicle not known' END AS reason
FROM ego_state e
JOIN ego_condition c USING (drive_id, ego_id, t_ns)
