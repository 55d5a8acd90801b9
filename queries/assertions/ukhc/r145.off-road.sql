-- title = "Not on the footway"
-- clause = "UKHC R145: you must not drive on or over a pavement, footpath or bridleway, except to reach property or in an emergency"
-- hypothesis = "At every step, was the ego's outline off every footway, or may it have been on its way to property?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "<="
-- unit = "m"
-- observes = "reach onto the footway"
-- merge_gap_s = 2.0
-- reads = ["ego_footway", "ego_state"]
-- requires = ["map", "registration", "lane_types", "ego_size"]
--
-- [params.tolerance_m]
-- default = 0.05
-- unit = "m"
-- why = "our default: the noise of registration, as for lane boundaries"
--
-- [params.access_mps]
-- default = 4.47
-- unit = "m/s"
-- why = "our default: at 10 mph and less a vehicle crosses the footway to reach property; faster it has left the road"

-- @condition
-- property is beyond what the map knows: whoever comes from there, or goes there, slowly, may cross the footway
WITH own AS (
    SELECT f.drive_id, f.ego_id, f.t_ns, f.depth_m, coalesce(f.depth_m > $tolerance_m, false) AS on_it,
        f.depth_m IS NULL AND e.x_m IS NOT NULL AS beyond, coalesce(e.speed_mps <= $access_mps, true) AS slow
    FROM ego_footway f
    LEFT JOIN ego_state e USING (drive_id, ego_id, t_ns)
),
-- a stretch on the footway has the number of the step before it
numbered AS (
    SELECT *, count(*) FILTER (NOT on_it) OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS n FROM own
),
stretch AS (
    SELECT o.drive_id, o.ego_id, o.n, bool_and(o.slow) AND count(b.n) > 0 AS access
    FROM numbered o
    LEFT JOIN (
        SELECT drive_id, ego_id, n FROM numbered WHERE beyond
        UNION ALL
        SELECT drive_id, ego_id, n - 1 FROM numbered WHERE beyond
    ) b ON b.drive_id = o.drive_id AND b.ego_id = o.ego_id AND b.n = o.n
    WHERE o.on_it
    GROUP BY o.drive_id, o.ego_id, o.n
)
SELECT o.drive_id, o.ego_id, o.t_ns, o.depth_m AS observed, CASE WHEN NOT coalesce(s.access, false) THEN $tolerance_m END AS required,
    CASE WHEN o.depth_m IS NULL THEN 'part of the ego is on nothing that the map knows'
        WHEN s.access THEN 'slowly over the footway, from or to ground that the map does not know: it may be property' END AS reason
FROM numbered o
LEFT JOIN stretch s ON s.drive_id = o.drive_id AND s.ego_id = o.ego_id AND s.n = CASE WHEN o.on_it THEN o.n END
