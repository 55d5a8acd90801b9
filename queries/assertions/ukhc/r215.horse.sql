-- title = "Slowly and wide past horses"
-- breach = "Too fast or too close past a horse"
-- clause = "UKHC R215 and R163: pass horses at under 10 mph and at least 2 m away"
-- hypothesis = "At every step at which the ego passed a horse on the road, was it slow and far enough away?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "should"
-- status = "stable"
-- law = ["gb"]
-- sense = "holds"
-- merge_gap_s = 2.0
-- reads = ["actor", "beside"]
-- requires = ["map", "registration", "actor_classes", "ego_size"]
--
-- [params.clearance_m]
-- default = 2.0
-- unit = "m"
-- why = "at least"
-- source = "UKHC R163 and R215"
--
-- [params.speed_mps]
-- default = 4.4704
-- unit = "m/s"
-- why = "10 mph"
-- source = "UKHC R215"
--
-- [params.length_m]
-- default = 1.5
-- unit = "m"
-- why = "our default: logs know animals only; a shorter one is no horse"

-- @applies
SELECT b.drive_id, b.ego_id, b.t_ns, b.object_id,
    is_class(b.actor_class, 'animal') AND a.length_m >= $length_m AND (b.on_carriageway OR b.on_strip) AND b.ego_speed_mps > standing_mps() AS applies
FROM beside b
LEFT JOIN actor a ON a.drive_id = b.drive_id AND a.actor_id = b.object_id

-- @condition
SELECT drive_id, ego_id, t_ns, object_id, sure_between_steps(clearance_m, blur_m, $clearance_m) >= $clearance_m AND ego_speed_mps <= $speed_mps AS holds,
    CASE WHEN clearance_m IS NOT NULL AND ego_speed_mps IS NOT NULL
        THEN why('passed_at_speed', {'clearance_m': clearance_m, 'speed_mps': ego_speed_mps}) END AS reason
FROM beside
