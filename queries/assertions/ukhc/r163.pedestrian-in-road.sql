-- title = "Slowly and wide past people walking in the road"
-- breach = "Too fast or too close past people walking in the road"
-- clause = "UKHC R163: leave at least 2 m and keep to a low speed when passing people walking in the road"
-- hypothesis = "At every step at which the ego passed somebody walking along in the road, was it slow and far enough away?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "should"
-- status = "draft"
-- law = ["gb"]
-- sense = "holds"
-- merge_gap_s = 2.0
-- reads = ["beside", "conflict"]
-- requires = ["map", "registration", "actor_classes", "ego_size"]
--
-- [params.clearance_m]
-- default = 2.0
-- unit = "m"
-- why = "at least"
-- source = "UKHC R163"
--
-- [params.speed_mps]
-- default = 6.7
-- unit = "m/s"
-- why = "our default for a low speed: 15 mph"
--
-- [params.across_mps]
-- default = 0.5
-- unit = "m/s"
-- why = "our default: a person who moves faster across the road is crossing it, which R195 and R170 cover"
--
-- # Draft: what a low speed is, and whether there was no pavement, is a judgement; a person who waits to cross counts as one who walks along.

-- @applies
-- A pedestrian who crosses and stops in the ego's way, or is struck there, is still crossing.
SELECT b.drive_id, b.ego_id, b.t_ns, b.object_id,
    is_class(b.actor_class, 'pedestrian') AND b.on_carriageway AND b.ego_speed_mps > standing_mps() AND abs(b.lat_mps) <= $across_mps AND c.object_id IS NULL AS applies
FROM beside b
LEFT JOIN (SELECT DISTINCT drive_id, ego_id, object_id, t_object_in_ns, t_object_out_ns FROM conflict WHERE abs(sin(angle_rad)) >= sin(pi() / 4)) c
    ON c.drive_id = b.drive_id AND c.ego_id = b.ego_id AND c.object_id = b.object_id AND c.t_object_in_ns <= b.t_ns AND b.t_ns <= c.t_object_out_ns

-- @condition
SELECT drive_id, ego_id, t_ns, object_id, sure_between_steps(clearance_m, blur_m, $clearance_m) >= $clearance_m AND ego_speed_mps <= $speed_mps AS holds,
    CASE WHEN clearance_m IS NOT NULL AND ego_speed_mps IS NOT NULL
        THEN why('passed_at_speed', {'clearance_m': clearance_m, 'speed_mps': ego_speed_mps}) END AS reason
FROM beside
