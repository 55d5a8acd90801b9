-- title = "Within the speed limit"
-- clause = "UKHC R124: you must not exceed the maximum speed limits for the road and for your vehicle"
-- hypothesis = "At every step, was the ego no faster than the limit where it was?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "<="
-- unit = "m/s"
-- merge_gap_s = 5.0
-- reads = ["ego_state"]
-- requires = ["map", "registration", "speed_limits"]
--
-- [params.tolerance_mps]
-- default = 0.45
-- unit = "m/s"
-- why = "our default: 1 mph, below which recorded speed and speedometer differ; the limit itself is the map's"

-- @condition
SELECT drive_id, ego_id, t_ns, speed_mps AS observed, limit_mps + $tolerance_mps AS required,
    CASE WHEN lanelet_id IS NULL THEN 'the ego is on no lane' WHEN limit_mps IS NULL THEN 'the map gives no limit for lanelet ' || lanelet_id END AS reason
FROM ego_state
