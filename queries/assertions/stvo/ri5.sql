-- title = "Room for vehicles that enter from the slip road"
-- breach = "Left no room for a vehicle that entered from the slip road"
-- clause = "StVO 1(2), 18(3) (R_I5 of Maierhofer et al. 2020): do not change to the lane that others are about to enter from the slip road"
-- hypothesis = "When the ego changed lane to the right, was nobody close by on the slip road?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "draft"
-- law = ["de"]
-- sense = "holds"
-- reads = ["data_log", "lane_change", "lane_occupancy", "lanelet", "pair"]
-- requires = ["map", "registration", "ego_size"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.near_m]
-- default = 100.0
-- unit = "m"
-- why = "our default: a vehicle nearer than this may be about to enter; whether it does is not checked, so the rule is a draft"

-- @reference
SELECT drive_id, ego_id, t_start_ns AS t_ns, occurrence
FROM lane_change
WHERE side = 'right' AND merge IS DISTINCT FROM true

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id,
    CASE WHEN count(*) FILTER (n.lane_type IN ('entry', 'onRamp', 'connectingRamp')) > 0 THEN false WHEN count(*) FILTER (p.x_m IS NULL AND p.object_id IS NOT NULL) = 0 THEN true END AS holds
FROM reference r
JOIN data_log g ON g.drive_id = r.drive_id
LEFT JOIN pair p ON p.drive_id = r.drive_id AND p.ego_id = r.ego_id AND p.t_ns = r.t_ns AND coalesce(p.distance_m, 0.0) <= $near_m
LEFT JOIN lane_occupancy o ON o.drive_id = r.drive_id AND o.actor_id = p.object_id AND o.t_ns = r.t_ns
LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
GROUP BY ALL
