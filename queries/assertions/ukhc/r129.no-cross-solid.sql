-- title = "Not over a solid line in the middle of the road"
-- breach = "Over a solid line in the middle of the road"
-- clause = "UKHC R129: where the middle line nearer to you is solid you must not cross or straddle it, except to pass something stationary, a cyclist, horse or works vehicle at 10 mph or less, or to reach or leave premises or a side road"
-- hypothesis = "At every step, was the ego's outline inside its side of a middle line that was solid for it?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- merge_gap_s = 2.0
-- reads = ["data_log", "ego_state", "environment", "line_step"]
-- requires = ["map", "registration", "handedness", "markings", "ego_size"]
--
-- [reasons.over_line]
-- says = "{out_m:.2f} m over a line marked {marking}"
--
-- [reasons.middle_unknown]
-- says = "it is not known whether the line is the middle of the road, because beyond it the map has nothing, or a gap or strip that may be a central reservation"
-- advice = "use a map with the lanes of both directions"
--
-- [reasons.may_pass_over_line]
-- says = "it is not known whether the ego was passing what may be passed over a solid line: something that stands, or a cyclist, horse or works vehicle at 10 mph or less"
-- advice = "a person must judge this"

-- @condition
-- Edge lines, and the lines between lanes of one direction, are judged by other rules.
WITH step_over_line AS (
    SELECT l.drive_id, l.ego_id, l.t_ns, l.out_m, l.marking, l.middle, l.forbidden AND NOT l.access AND l.passing_id IS NULL AND NOT l.passing_known AS may_pass,
        l.middle AND l.forbidden AND NOT l.access AND CASE WHEN l.passing_id IS NOT NULL THEN false WHEN l.passing_known THEN true END AS crosses_solid_line
    FROM line_step l
    JOIN data_log g USING (drive_id)
    JOIN environment m USING (environment_id)
    WHERE l.side = overtaking_side(m.handedness)
)
SELECT e.drive_id, e.ego_id, e.t_ns,
    CASE WHEN e.front_s_m IS NULL THEN NULL WHEN l.t_ns IS NULL THEN true ELSE NOT l.crosses_solid_line END AS holds,
    CASE
        WHEN e.front_s_m IS NULL THEN ego_lacks(e.x_m, e.yaw_rad, e.lanelet_id, e.front_s_m)
        WHEN l.crosses_solid_line THEN why('over_line', {'out_m': l.out_m, 'marking': l.marking})
        WHEN l.t_ns IS NOT NULL AND l.crosses_solid_line IS NULL AND l.middle IS NULL THEN why('middle_unknown')
        WHEN l.crosses_solid_line IS NULL AND l.may_pass THEN why('may_pass_over_line')
    END AS reason
FROM ego_state e
LEFT JOIN step_over_line l USING (drive_id, ego_id, t_ns)
