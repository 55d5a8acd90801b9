-- title = "Not on the footway"
-- clause = "UKHC R145: you must not drive on or over a pavement, footpath or bridleway, except to reach property or in an emergency"
-- hypothesis = "At every step, was the ego's outline off every footway?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "<="
-- unit = "m"
-- observes = "reach onto the footway"
-- merge_gap_s = 2.0
-- reads = ["ego_footway"]
-- requires = ["map", "registration", "lane_types", "ego_size"]
--
-- [params.tolerance_m]
-- default = 0.05
-- unit = "m"
-- why = "our default: the noise of registration, as for lane boundaries"

-- @condition
SELECT drive_id, ego_id, t_ns, depth_m AS observed, $tolerance_m AS required,
    CASE WHEN depth_m IS NULL THEN 'part of the ego is on nothing that the map knows' END AS reason
FROM ego_footway
