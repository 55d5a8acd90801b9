-- title = "Room for cyclists"
-- clause = "UKHC R163: leave at least 1.5 m when passing cyclists at up to 30 mph, and more at higher speeds"
-- hypothesis = "At every step at which the ego passed a cyclist on the road, was it far enough away?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "m"
-- observes = "distance to the cyclist"
-- near_margin = 0.2
-- merge_gap_s = 2.0
-- reads = ["actor", "beside"]
-- requires = ["map", "registration", "actor_classes", "ego_size"]
--
-- [params.clearance_m]
-- default = 1.5
-- unit = "m"
-- why = "at up to 30 mph"
-- source = "UKHC R163"
--
-- [params.fast_clearance_m]
-- default = 2.0
-- unit = "m"
-- why = "our default for 'more' at higher speeds: what R163 gives people on foot and R215 horses"
--
-- [params.fast_mps]
-- default = 13.4112
-- unit = "m/s"
-- why = "30 mph"
-- source = "UKHC R163"
--
-- [params.longest_m]
-- default = 2.5
-- unit = "m"
-- why = "our default: what is of no known class and longer than this is no cycle"

-- @applies
-- a cyclist that overtakes the ego, or comes towards it, is not passed
SELECT b.drive_id, b.ego_id, b.t_ns, b.object_id,
    coalesce(is_class(b.actor_class, 'bicycle'), CASE WHEN a.length_m > $longest_m THEN false END)
        AND b.along AND b.on_carriageway AND b.ego_speed_mps > b.speed_mps AS applies
FROM beside b
LEFT JOIN actor a ON a.drive_id = b.drive_id AND a.actor_id = b.object_id

-- @condition
SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed,
    CASE WHEN ego_speed_mps <= $fast_mps THEN $clearance_m ELSE $fast_clearance_m END AS required
FROM beside
