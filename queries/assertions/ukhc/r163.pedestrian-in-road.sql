-- title = "Slowly and wide past people walking in the road"
-- clause = "UKHC R163: leave at least 2 m and keep to a low speed when passing people walking in the road"
-- hypothesis = "At every step at which the ego passed somebody walking along in the road, was it slow and far enough away?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "should"
-- status = "draft"
-- sense = "holds"
-- merge_gap_s = 2.0
-- reads = ["beside"]
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
-- why = "our default: who moves faster across the road is crossing it, which is the business of R195 and R170"
--
-- # Draft: what a low speed is, and whether there was no pavement, is a judgement; somebody who waits to cross is taken for one who walks along.

-- @applies
SELECT drive_id, ego_id, t_ns, object_id,
    actor_class = 'pedestrian' AND on_carriageway AND ego_speed_mps > standing_mps() AND abs(lat_mps) <= $across_mps AS applies
FROM beside

-- @condition
SELECT drive_id, ego_id, t_ns, object_id, clearance_m >= $clearance_m AND ego_speed_mps <= $speed_mps AS holds,
    format('{:.2f} m away at {:.1f} m/s', clearance_m, ego_speed_mps) AS reason
FROM beside
