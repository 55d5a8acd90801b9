-- title = "Back to the left after overtaking"
-- breach = "Stayed out after overtaking"
-- clause = "UKHC R264: keep in the left lane unless overtaking; move back to the left when you have passed and it is safe"
-- hypothesis = "After passing a vehicle in the lane on its near side on a motorway, did the ego move back, or was that lane not free?"
-- kind = "postcondition"
-- subtype = "temporal"
-- window_s = "back_s"
-- quantifier = "eventually"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- law = ["gb"]
-- sense = "holds"
-- reads = ["data_log", "ego_state", "environment", "lane_change", "lanelet", "pair", "passing"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.back_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: time to move back once the vehicle is passed"
--
-- [params.ahead_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: a vehicle less than this ahead in the near lane is about to be overtaken too"
--
-- [params.behind_m]
-- default = 20.0
-- unit = "m"
-- why = "our default: the ego would cut in on a vehicle that is closer behind in the near lane"
--
-- [params.clear_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: time to draw clear of the vehicles just passed; after it, only a vehicle that is still close behind keeps the ego from moving back"
--
-- # Draft: whether the lane was free for long enough to make moving back worth it is a judgement.

-- @reference
SELECT p.drive_id, p.ego_id, p.t_to_ns AS t_ns, p.object_id, p.side, m.environment_id
FROM passing p
JOIN data_log g USING (drive_id)
JOIN environment m USING (environment_id)
WHERE coalesce(p.ego_passes AND NOT p.same_lane AND p.side <> overtaking_side(m.handedness), true)

-- @condition
-- The rule is kept if the ego moves back, if there is no lane of the same direction on that side, or if a vehicle is there or may be there.
-- The vehicle just passed is there, too, but does not stay close behind: a vehicle that the ego has passed counts from clear_s on.
WITH occupied_step AS (
    SELECT DISTINCT s.ref_id, s.t_ns
    FROM reference_step s
    JOIN reference r USING (ref_id)
    JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
    JOIN pair p ON p.drive_id = s.drive_id AND p.ego_id = s.ego_id AND p.t_ns = s.t_ns
    WHERE CASE WHEN p.d_m > e.d_m THEN 'left' ELSE 'right' END = r.side AND abs(p.d_m) > p.half_width_m AND abs(p.d_m) < 3 * p.half_width_m
        AND p.front_s_m > e.rear_s_m - $behind_m AND p.rear_s_m < e.front_s_m + $ahead_s * e.speed_mps
        AND (p.front_s_m >= e.front_s_m OR s.t_ns >= r.t_ns + ($clear_s * 1e9)::BIGINT)
)
SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id, s.object_id,
    CASE WHEN r.side IS NULL THEN NULL WHEN c.drive_id IS NOT NULL OR o.t_ns IS NOT NULL THEN true WHEN n.lanelet_id IS NOT NULL AND e.front_s_m IS NOT NULL THEN coalesce(b.lane_type, '') <> 'driving' OR b.along_road <> n.along_road END AS holds
FROM reference_step s
JOIN reference r USING (ref_id)
JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
LEFT JOIN occupied_step o ON o.ref_id = s.ref_id AND o.t_ns = s.t_ns
LEFT JOIN lane_change c ON c.drive_id = s.drive_id AND c.ego_id = s.ego_id AND c.side = r.side AND c.t_start_ns = s.t_ns
LEFT JOIN lanelet n ON n.environment_id = r.environment_id AND n.lanelet_id = e.lanelet_id
LEFT JOIN lanelet b ON b.environment_id = r.environment_id AND b.lanelet_id = CASE r.side WHEN 'left' THEN n.left_id ELSE n.right_id END
