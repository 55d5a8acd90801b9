-- title = "Room for cyclists"
-- breach = "Passed a cyclist too closely"
-- clause = "UKHC R163: leave at least 1.5 m when passing cyclists at up to 30 mph, and more at higher speeds"
-- hypothesis = "At every step at which the ego passed a cyclist on the road, was it far enough away?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "should"
-- status = "stable"
-- law = ["gb"]
-- sense = ">="
-- unit = "m"
-- observes = "distance to the cyclist"
-- near_margin = 0.2
-- merge_gap_s = 2.0
-- reads = ["beside", "road_user"]
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
-- why = "our default for 'more' at higher speeds: the distance of R163 for people on foot and of R215 for horses"
--
-- [params.fast_mps]
-- default = 13.4112
-- unit = "m/s"
-- why = "30 mph"
-- source = "UKHC R163"

-- @applies
-- A cyclist who overtakes the ego, or comes towards it, is not passed. A bicycle that stands beside the lanes may be a parked one.
SELECT b.drive_id, b.ego_id, b.t_ns, b.object_id,
    is_bicycle(b.actor_class, a.length_m) AND b.along AND b.ego_speed_mps > b.speed_mps AND (b.on_carriageway OR CASE
        WHEN b.on_strip AND b.speed_mps > standing_mps() THEN true
        WHEN b.on_strip IS DISTINCT FROM false AND coalesce(b.clearance_m - coalesce(b.blur_m, 0.0) < $fast_clearance_m, true) THEN NULL
        ELSE false
    END) AS applies
FROM beside b
LEFT JOIN road_user a ON a.drive_id = b.drive_id AND a.actor_id = b.object_id

-- @condition
SELECT drive_id, ego_id, t_ns, object_id, CASE WHEN ego_speed_mps <= $fast_mps THEN $clearance_m ELSE $fast_clearance_m END AS required,
    sure_between_steps(clearance_m, blur_m, required) AS observed,
    CASE WHEN observed IS NULL AND clearance_m IS NOT NULL THEN why('steps_too_far_apart') END AS reason
FROM beside
