-- title = "Not over a solid line in the middle of the road"
-- clause = "UKHC R129: where the middle line nearer to you is solid you must not cross or straddle it, except to pass something stationary, a cyclist, horse or works vehicle at 10 mph or less, or to reach or leave premises or a side road"
-- hypothesis = "At every step, was the ego's outline inside its side of a middle line that was solid for it?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- merge_gap_s = 2.0
-- reads = ["data_log", "ego_corridor", "ego_state", "environment", "line_step"]
-- requires = ["map", "registration", "handedness", "markings", "ego_size"]

-- @condition
-- the middle of the road is the boundary on the overtaking side, if the lane beyond is driven the other way; all others are edges and dividers
SELECT e.drive_id, e.ego_id, e.t_ns,
    CASE
        WHEN e.front_s_m IS NULL THEN NULL
        WHEN l.t_ns IS NULL OR NOT coalesce(c.over_against, false) THEN true
        ELSE NOT (l.forbidden AND l.passing_id IS NULL AND NOT l.access)
    END AS holds,
    CASE
        WHEN e.front_s_m IS NULL THEN 'the ego is not placed on the road'
        WHEN l.forbidden AND l.passing_id IS NULL AND NOT l.access THEN format('{:.2f} m over a line marked {}', l.out_m, l.marking)
    END AS reason
FROM ego_state e
JOIN data_log g USING (drive_id)
JOIN environment m USING (environment_id)
LEFT JOIN ego_corridor c USING (drive_id, ego_id, chain_id, t_ns)
LEFT JOIN line_step l ON l.drive_id = e.drive_id AND l.ego_id = e.ego_id AND l.t_ns = e.t_ns AND l.side = overtaking_side(m.handedness)
