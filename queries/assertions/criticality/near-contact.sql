-- title = "Room beside other road users"
-- breach = "Nearly touched another road user"
-- clause = "Our default: boxes of data sets leave out mirrors, which stand out by some 0.2 m; who passes nearer than 0.3 m has touched but for luck"
-- hypothesis = "At every step at which the ego moved past another road user, or that one past it, were there at least 0.3 m between their boxes?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "m"
-- observes = "distance between the two"
-- near_margin = 0.2
-- merge_gap_s = 2.0
-- reads = ["before_track", "between_steps", "clearance_least", "clock", "ego_state", "hidden", "hole_passing", "lost_object", "pair", "road_user", "state_dynamics"]
-- requires = ["ego_size", "speeds"]
--
-- [params.least_m]
-- default = 0.3
-- unit = "m"
-- why = "our default: a mirror of 0.2 m, and a hand's breadth"
--
-- [params.passing_mps]
-- default = 2.0
-- unit = "m/s"
-- why = "our default: a brisk walk; an actor whose velocity differs by less drives beside the ego and does not pass"
--
-- [params.near_m]
-- default = 3.0
-- unit = "m"
-- why = "our default: the width of a lane; an actor that is further away is not passed closely"
--
-- [params.contact_s]
-- default = 2.0
-- unit = "s"
-- why = "our default: this long before and after a contact, the distance belongs to the contact, which ukhc.no-collision judges"
--
-- [reasons.near_before_track]
-- says = "object {object_id} is first seen here, going away from the ego: back at these speeds, it was nearer less than half a second before"
--
-- [reasons.passed_in_hole]
-- says = "the ego and object {object_id} pass each other in a hole in the log of {hole_s:.1f} s, which begins here"
--
-- [reasons.thing_or_vehicle]
-- says = "object {object_id} is recorded as a thing, and is as large as a car: it may be one that is parked"
-- advice = "record the class of what stands at the road"
--
-- [reasons.nearness_between_steps]
-- says = "contact between this step and the next, {step_s:.2f} s later, cannot be ruled out"

-- @applies
SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id,
    -- The ego does not pass a vehicle on another level. If the level is not known, the rule may not apply. A cone is nobody.
    CASE WHEN NOT p.off_level THEN CASE WHEN p.actor_class IS DISTINCT FROM 'object' THEN true END AND e.speed_mps > standing_mps() AND sqrt((e.speed_mps * cos(e.yaw_rad) - o.vx_mps) ** 2 + (e.speed_mps * sin(e.yaw_rad) - o.vy_mps) ** 2) > $passing_mps END AS applies,
    CASE WHEN p.actor_class = 'object' THEN why('thing_or_vehicle', {'object_id': p.object_id}) END AS reason
FROM pair p
LEFT JOIN clearance_least l USING (drive_id, ego_id, t_ns, object_id)
LEFT JOIN ego_state e USING (drive_id, ego_id, t_ns)
LEFT JOIN state_dynamics o ON o.drive_id = p.drive_id AND o.actor_id = p.object_id AND o.t_ns = p.t_ns
LEFT JOIN (
    SELECT drive_id, ego_id, object_id, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns
    FROM pair
    WHERE clearance_m <= 0
    GROUP BY drive_id, ego_id, object_id
) c ON c.drive_id = p.drive_id AND c.ego_id = p.ego_id AND c.object_id = p.object_id
WHERE coalesce(p.clearance_m, l.least_m, 0.0) <= $near_m
    AND (p.actor_class IS DISTINCT FROM 'object' OR may_be_parked_car(p.length_m, p.width_m) AND NOT p.clearance_is_bound AND p.clearance_m < $least_m)
    AND coalesce(p.t_ns < c.t_first_ns - ($contact_s * 1e9)::BIGINT OR p.t_ns > c.t_last_ns + ($contact_s * 1e9)::BIGINT, true)
UNION ALL
-- The ego may have passed an actor whose track ends nearby, as long as it may be near.
SELECT l.drive_id, l.ego_id, h.t_ns, l.object_id, CASE WHEN e.speed_mps <= standing_mps() THEN false END,
    why('recorded_too_short', {'object_id': l.object_id, 'to_ns': last.t_ns, 'far_m': CASE WHEN p.clearance_is_bound THEN p.distance_m ELSE coalesce(p.clearance_m, p.distance_m) END, 'ego_to_ns': c.t_end_ns})
FROM lost_object l
JOIN clock c USING (drive_id, ego_id)
JOIN road_user a ON a.drive_id = l.drive_id AND a.actor_id = l.object_id
JOIN hidden h ON h.drive_id = l.drive_id AND h.ego_id = l.ego_id AND h.object_id = l.object_id AND h.t_ns BETWEEN l.t_from_ns AND l.t_to_ns
CROSS JOIN LATERAL (SELECT l.t_from_ns - 1 AS t_ns) last
LEFT JOIN pair p ON p.drive_id = l.drive_id AND p.ego_id = l.ego_id AND p.object_id = l.object_id AND p.t_ns = last.t_ns
LEFT JOIN ego_state e ON e.drive_id = l.drive_id AND e.ego_id = l.ego_id AND e.t_ns = h.t_ns
WHERE h.least_m <= $near_m AND a.actor_class IS DISTINCT FROM 'object'
UNION ALL
-- An actor that is first seen while it goes away from the ego may have been nearer just before.
SELECT b.drive_id, b.ego_id, b.t_ns, b.object_id, CASE WHEN e.speed_mps <= standing_mps() THEN false END, why('near_before_track', {'object_id': b.object_id})
FROM before_track b
JOIN road_user a ON a.drive_id = b.drive_id AND a.actor_id = b.object_id
LEFT JOIN ego_state e ON e.drive_id = b.drive_id AND e.ego_id = b.ego_id AND e.t_ns = b.t_ns
WHERE b.least_m < $least_m AND a.actor_class IS DISTINCT FROM 'object'
UNION ALL
SELECT drive_id, ego_id, t_ns, object_id, NULL, why('passed_in_hole', {'object_id': object_id, 'hole_s': (t_next_ns - t_ns) / 1e9})
FROM hole_passing
WHERE actor_class IS DISTINCT FROM 'object'

-- @condition
SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, $least_m AS required,
    CASE WHEN b.t_ns IS NULL OR p.clearance_m < $least_m AND NOT p.clearance_is_bound THEN coalesce(p.clearance_m, l.least_m) END AS observed,
    p.clearance_is_bound OR p.clearance_m IS NULL AS at_least,
    CASE WHEN observed IS NULL AND b.t_ns IS NOT NULL THEN why('nearness_between_steps', {'step_s': (b.t_next_ns - b.t_ns) / 1e9}) END AS reason
FROM pair p
LEFT JOIN between_steps b USING (drive_id, ego_id, t_ns, object_id)
LEFT JOIN clearance_least l USING (drive_id, ego_id, t_ns, object_id)
