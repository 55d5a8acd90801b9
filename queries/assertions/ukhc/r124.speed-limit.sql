-- title = "Within the speed limit"
-- breach = "Over the speed limit"
-- clause = "UKHC R124: you must not exceed the maximum speed limits for the road and for your vehicle"
-- hypothesis = "At every step, did the ego keep to the limit of the road and to that of its class of vehicle?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- law = ["gb"]
-- sense = "<="
-- unit = "m/s"
-- observes = "speed"
-- merge_gap_s = 5.0
-- reads = ["ego_condition", "ego_state", "step"]
-- requires = ["map", "registration", "speeds"]
-- pass_requires = ["speed_limits"]
--
-- [params.tolerance_mps]
-- default = 0.45
-- unit = "m/s"
-- why = "our default: 1 mph, below which recorded speed and speedometer differ; the limits are the map's and those of R124's table"
--
-- [reasons.speed_unknown_or_contradicted]
-- says = "the ego's speed is not known, or contradicts its positions"
-- advice = "record it, or correct it"
--
-- [reasons.ego_on_no_lane]
-- says = "the ego is on no lane"
--
-- [reasons.limit_by_vehicle_and_road]
-- says = "the limit depends on the class of the vehicle and the kind of road, and one of these is not known"

-- @condition
-- If the class, nation or kind of road is not known, the limit lies between two values: a speed between them is neither a pass nor a fail.
-- A limit that cannot be read may be higher than that of built-up areas. A speed within the limit is a pass only if the ego cannot have been over the limit before the next step.
WITH limit_range AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, e.speed_mps, e.lanelet_id, e.limit_mps, e.limit_source,
        peak_between_mps(e.speed_mps, lead(e.speed_mps) OVER stretch, (lead(e.t_ns) OVER stretch - e.t_ns) / 1e9) AS peak_mps,
        least(e.limit_mps, most_limit_mps(c.vehicle_class, e.length_m, c.nation, c.road_type, c.carriageway, c.area, e.limit_mps IS NOT NULL OR coalesce(e.limit_source = 'unread', false))) + $tolerance_mps AS most_mps,
        -- A sign that the map does not have may set any limit: without a limit in the map, no speed is a pass.
        CASE WHEN e.limit_mps IS NOT NULL
            THEN least(e.limit_mps, least_limit_mps(c.vehicle_class, e.length_m, c.nation, c.road_type, c.carriageway)) + $tolerance_mps END AS least_mps
    FROM ego_state e
    JOIN step s USING (drive_id, ego_id, t_ns)
    LEFT JOIN ego_condition c USING (drive_id, ego_id, t_ns)
    WINDOW stretch AS (PARTITION BY e.drive_id, e.ego_id, s.seg ORDER BY e.t_ns)
)
SELECT drive_id, ego_id, t_ns, speed_mps AS observed,
    CASE WHEN speed_mps > most_mps THEN most_mps WHEN peak_mps <= least_mps THEN least_mps END AS required,
    CASE WHEN observed > required AND $tolerance_mps > 0 THEN why('with_tolerance', {'tolerance_mps': $tolerance_mps})
        WHEN required IS NOT NULL THEN NULL
        WHEN speed_mps IS NULL THEN why('speed_unknown_or_contradicted')
        WHEN lanelet_id IS NULL THEN why('ego_on_no_lane')
        WHEN limit_mps IS NULL THEN limit_doubt(limit_source, lanelet_id)
        WHEN speed_mps <= least_mps THEN why('peak_between_samples')
        ELSE why('limit_by_vehicle_and_road') END AS reason
FROM limit_range
