-- title = "Within the speed limit"
-- breach = "Over the speed limit"
-- clause = "StVO 3(3), 18(5) (R_G3 of Maierhofer et al. 2020): do not exceed the limit of the road nor that of your kind of vehicle"
-- hypothesis = "At every step, was the ego no faster than the road and its kind of vehicle allow?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- law = ["de"]
-- sense = "<="
-- unit = "m/s"
-- observes = "speed"
-- merge_gap_s = 5.0
-- reads = ["ego_condition", "ego_state", "step"]
-- requires = ["map", "registration", "speeds"]
-- pass_requires = ["speed_limits"]
--
-- [params.tolerance_mps]
-- default = 0.83
-- unit = "m/s"
-- why = "our default: the 3 km/h that German police take off below 100 km/h"
--
-- [params.town_mps]
-- default = 13.89
-- unit = "m/s"
-- why = "50 km/h in built-up areas"
-- source = "StVO 3(3) no. 1"
--
-- [params.open_mps]
-- default = 27.78
-- unit = "m/s"
-- why = "100 km/h elsewhere; no such limit on roads whose directions are apart, nor on those with two lanes each way"
-- source = "StVO 3(3) no. 2 c"
--
-- [params.heavy_mps]
-- default = 22.22
-- unit = "m/s"
-- why = "80 km/h on motorways for vehicles over 3.5 t, buses and cars with trailers; on other roads for buses and cars with trailers"
-- source = "StVO 18(5) no. 1, 3(3) no. 2 a"
--
-- [params.heaviest_mps]
-- default = 16.67
-- unit = "m/s"
-- why = "60 km/h on roads other than motorways for vehicles over 7.5 t, lorries with trailers, and buses in which people stand"
-- source = "StVO 3(3) no. 2 b"
--
-- [params.coach_mps]
-- default = 27.78
-- unit = "m/s"
-- why = "100 km/h on motorways for coaches approved for it, and by exemption for cars with trailers: neither is in a trace"
-- source = "StVO 18(5) no. 3"
--
-- [reasons.no_lane_no_limit]
-- says = "the ego is on no lane, so no limit is known"
--
-- [reasons.speed_unknown_or_contradicted]
-- says = "the ego's speed is not known, or contradicts its positions"
-- advice = "record it, or correct it"
--
-- [reasons.ego_class_unknown]
-- says = "the ego's class of vehicle is not known"
-- advice = "set --env vehicle_class=..."
--
-- [reasons.limit_by_class_and_road]
-- says = "the limit depends on the class of vehicle and the kind of road, and one of these is not known"
-- advice = "set them, such as --env vehicle_class=car and --env road_type=rural"

-- @condition
-- A sign replaces the limit that holds for every car. The limits of heavier vehicles outside built-up areas hold under a sign, too. If the
-- kind of vehicle, road or area is not known, a speed between the lowest and the highest limit that may hold is not judged. Where the map
-- may lack a sign, no speed is known to be allowed. A speed within the limit is a pass only if the ego cannot have been over the limit
-- before the next step.
SELECT drive_id, ego_id, t_ns, e.speed_mps AS observed,
    CASE WHEN e.speed_mps > bounds.most_mps + $tolerance_mps THEN bounds.most_mps WHEN e.peak_mps <= bounds.least_mps + $tolerance_mps THEN bounds.least_mps END + $tolerance_mps AS required,
    CASE WHEN e.speed_mps IS NULL THEN why('speed_unknown_or_contradicted') WHEN required IS NOT NULL THEN NULL WHEN c.limit_mps IS NULL THEN coalesce(limit_doubt(e.limit_source, e.lanelet_id), why('no_lane_no_limit'))
        WHEN e.speed_mps <= bounds.least_mps + $tolerance_mps THEN why('peak_between_samples')
        WHEN c.vehicle_class IS NULL THEN why('ego_class_unknown')
        ELSE why('limit_by_class_and_road') END AS reason
FROM (
    SELECT e.*, peak_between_mps(e.speed_mps, lead(e.speed_mps) OVER stretch, (lead(e.t_ns) OVER stretch - e.t_ns) / 1e9) AS peak_mps
    FROM ego_state e
    JOIN step s USING (drive_id, ego_id, t_ns)
    WINDOW stretch AS (PARTITION BY e.drive_id, e.ego_id, s.seg ORDER BY e.t_ns)
) e
JOIN ego_condition c USING (drive_id, ego_id, t_ns)
CROSS JOIN LATERAL (
    SELECT CASE WHEN c.road_type = 'motorway' THEN 'motorway' WHEN c.area = 'built_up' THEN 'town' WHEN c.road_type IS NOT NULL AND c.area = 'open' THEN 'open' END AS place
) p
CROSS JOIN LATERAL (
    SELECT
        coalesce(c.limit_mps, CASE WHEN p.place = 'town' THEN $town_mps
            WHEN p.place = 'open' AND c.carriageway = 'single' AND c.lanes_each_way = 1 THEN $open_mps ELSE 'inf'::DOUBLE END) AS road_mps,
        CASE WHEN p.place = 'town' OR c.vehicle_class IN ('car', 'motorcycle') THEN 'inf'::DOUBLE
            WHEN p.place = 'motorway' OR c.vehicle_class = 'car_towing' THEN $heavy_mps ELSE $heaviest_mps END AS class_least_mps,
        CASE
            WHEN p.place = 'motorway' THEN CASE WHEN c.vehicle_class = 'goods_over_7t5' THEN $heavy_mps WHEN c.vehicle_class IN ('bus', 'car_towing') THEN $coach_mps END
            WHEN p.place = 'open' THEN CASE WHEN c.vehicle_class = 'goods_over_7t5' THEN $heaviest_mps WHEN c.vehicle_class IN ('bus', 'car_towing') THEN $heavy_mps END
        END AS class_most_mps
) limits
CROSS JOIN LATERAL (
    -- least() ignores NULL, as is right here.
    SELECT least(limits.road_mps, limits.class_most_mps) AS most_mps, CASE WHEN c.limit_mps IS NOT NULL THEN least(c.limit_mps, limits.class_least_mps) END AS least_mps
) bounds
