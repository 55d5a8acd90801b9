-- title = "Space for cyclists and people on foot"
-- breach = "Passed cyclists or people on foot too closely"
-- clause = "StVO 5(4): in a motor vehicle, overtake people on foot, on bicycles and on small electric vehicles with at least 1.5 m in built-up areas and 2 m elsewhere"
-- hypothesis = "At every step beside a slower cyclist or pedestrian on the road who goes the same way, did the ego, no bicycle itself, keep the distance?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- law = ["de"]
-- sense = ">="
-- unit = "m"
-- observes = "gap to the side"
-- near_margin = 0.2
-- reads = ["beside", "ego_condition", "road_user", "standstill"]
-- requires = ["map", "registration", "ego_size", "actor_classes"]
--
-- [params.built_up_m]
-- default = 1.5
-- unit = "m"
-- why = "distance in built-up areas"
-- source = "StVO 5(4) sentence 3"
--
-- [params.open_m]
-- default = 2.0
-- unit = "m"
-- why = "distance elsewhere"
-- source = "StVO 5(4) sentence 3"
--
-- [params.waited_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: for this long after the ego moves off, the distance to a cyclist who came up beside the standing ego does not apply (StVO 5(4) sentence 4)"
--
-- [params.junction_m]
-- default = 60.0
-- unit = "m"
-- why = "our default: a vehicle this near before a junction, or in it, counts as waiting there; the distance to a cyclist who rides past it on the right does not apply (StVO 5(4) sentence 4)"
--
-- [reasons.built_up_unknown]
-- says = "it is not known whether the area is built up"

-- @applies
-- A cyclist on a cycle lane behind a solid line is beside the carriageway: whether passing that cyclist is overtaking is disputed.
SELECT b.drive_id, b.ego_id, b.t_ns, b.object_id,
    (is_bicycle(b.actor_class, a.length_m) OR is_class(b.actor_class, 'pedestrian')) AND b.along AND b.on_carriageway AND CASE WHEN coalesce(b.cycle_lane, 'broken') = 'broken' THEN true END AND b.ego_speed_mps > b.speed_mps
        AND (x.actor_id IS NULL OR NOT is_bicycle(x.actor_class, x.length_m)) AND CASE WHEN w.object_id IS NULL THEN true WHEN w.has_waited THEN false END AS applies
FROM beside b
LEFT JOIN road_user a ON a.drive_id = b.drive_id AND a.actor_id = b.object_id
LEFT JOIN road_user x ON x.drive_id = b.drive_id AND x.actor_id = b.ego_id
LEFT JOIN (
    SELECT s.drive_id, s.ego_id, o.object_id, s.t_start_ns, s.t_end_ns,
        bool_or(o.speed_mps <= standing_mps()) OR s.junction_id IS NOT NULL OR s.junction_m <= $junction_m AS has_waited
    FROM standstill s
    JOIN beside o ON o.drive_id = s.drive_id AND o.ego_id = s.ego_id AND o.t_ns >= s.t_start_ns AND o.t_ns <= s.t_end_ns
    GROUP BY s.drive_id, s.ego_id, o.object_id, s.t_start_ns, s.t_end_ns, s.junction_id, s.junction_m
) w ON w.drive_id = b.drive_id AND w.ego_id = b.ego_id AND w.object_id = b.object_id
    AND b.t_ns >= w.t_start_ns AND b.t_ns <= w.t_end_ns + ($waited_s * 1e9)::BIGINT
    AND w.has_waited IS DISTINCT FROM false

-- @condition
SELECT drive_id, ego_id, t_ns, object_id, CASE c.area WHEN 'built_up' THEN $built_up_m WHEN 'open' THEN $open_m END AS required,
    sure_between_steps(b.gap_m, b.blur_m, required) AS observed,
    CASE WHEN c.area IS NULL THEN why('built_up_unknown')
        WHEN observed IS NULL AND b.gap_m IS NOT NULL THEN why('steps_too_far_apart') END AS reason
FROM beside b
JOIN ego_condition c USING (drive_id, ego_id, t_ns)
