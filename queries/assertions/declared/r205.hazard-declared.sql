-- title = "Road users declared as hazards before they are passed"
-- breach = "Passed road users that were not declared as hazards"
-- clause = "UKHC R146, R154, R205: anticipate what people on foot, cyclists and animals close by may do"
-- hypothesis = "When the ego came to pass a pedestrian, cyclist or animal close by, had it declared that object as a hazard?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = "holds"
-- reads = ["beside", "clock", "declared_event"]
-- requires = ["declared_events", "map", "registration", "ego_size", "actor_classes"]
--
-- [params.window_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: a hazard declared longer ago was about another place"
--
-- [params.near_m]
-- default = 3.0
-- unit = "m"
-- why = "our default: an actor that is further away is no hazard; which hazards the ego must expect is a judgement, so the rule is a draft"
--
-- [params.moving_mps]
-- default = 2.0
-- unit = "m/s"
-- why = "our default: at walking pace the ego is no danger"

-- @reference
SELECT drive_id, ego_id, min(t_ns) AS t_ns, object_id
FROM beside
WHERE actor_class IN ('pedestrian', 'bicycle', 'animal') AND gap_m <= $near_m AND ego_speed_mps > $moving_mps
GROUP BY drive_id, ego_id, object_id

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.object_id, CASE
    WHEN bool_or(d.t_ns <= r.t_ns AND d.t_ns >= r.t_ns - $window_s * 1e9 AND d.value = r.object_id) THEN true
    WHEN r.t_ns - $window_s * 1e9 >= c.t_start_ns AND count(d.t_ns) > 0 THEN false END AS holds
FROM reference r
JOIN clock c ON c.drive_id = r.drive_id AND c.ego_id = r.ego_id
LEFT JOIN declared_event d ON d.drive_id = r.drive_id AND d.actor_id = r.ego_id AND d.event = 'hazard'
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.object_id, c.t_start_ns
