-- title = "No overtaking just before turning left"
-- breach = "Overtook just before turning left"
-- clause = "UKHC R182: do not overtake cyclists, motorcyclists or others immediately before turning left"
-- hypothesis = "In the seconds before the ego turned to the near side, did it get ahead of nobody who was moving on that side?"
-- kind = "precondition"
-- subtype = "temporal"
-- window_s = "window_s"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["beside", "conflict", "junction_passage", "lane_occupancy", "passing"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way into the junction: begin recording before it"
--
-- [params.window_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: a road user that the ego passed earlier than this has had time to see it signal and slow down"
--
-- [reasons.got_ahead_of]
-- says = "the ego got ahead of {object_id}"
--
-- [reasons.passed_in_its_lane]
-- says = "the ego got ahead of {object_id}, which may have turned beside it in a lane of its own"
-- advice = "a person must judge this"
--
-- [reasons.unplaced_beside]
-- says = "an actor that may be beside the ego cannot be placed"

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, turn, across, at_fork(turn, turn_rad, straightest_rad) AS fork,
    CASE WHEN turn = 'straight' THEN CASE WHEN turn_rad > 0 THEN 'left' ELSE 'right' END ELSE turn END AS side
FROM junction_passage
WHERE across IS DISTINCT FROM true AND (turn IS DISTINCT FROM 'straight' OR at_fork(turn, turn_rad, straightest_rad))

-- @condition
SELECT rs.drive_id, rs.ego_id, rs.t_ns, rs.ref_id,
    CASE WHEN r.across IS NULL OR (p.t_ns IS NULL AND b.t_ns IS NOT NULL) THEN NULL WHEN p.t_ns IS NOT NULL THEN CASE WHEN NOT r.fork AND p.sure_id IS NOT NULL THEN false END ELSE true END AS holds,
    CASE WHEN r.across IS NULL THEN across_doubt(r.turn)
        WHEN p.t_ns IS NOT NULL AND r.fork THEN fork_doubt()
        WHEN p.sure_id IS NOT NULL THEN why('got_ahead_of', {'object_id': p.sure_id})
        WHEN p.t_ns IS NOT NULL THEN why('passed_in_its_lane', {'object_id': p.object_id})
        WHEN b.t_ns IS NOT NULL THEN why('unplaced_beside') END AS reason
FROM reference_step rs
JOIN reference r USING (ref_id)
LEFT JOIN (
    -- Where two lanes turn, one may move faster than the other (R163): a motor vehicle in a lane of its own is cut off only if the ego then
    -- goes over its way.
    SELECT p.drive_id, p.ego_id, p.t_ns, side, min(p.object_id) AS object_id,
        min(p.object_id) FILTER (c.object_id IS NOT NULL OR same_lane OR o.t_ns IS NULL OR p.actor_class IN ('bicycle', 'animal')) AS sure_id
    FROM passing p
    LEFT JOIN (SELECT DISTINCT drive_id, actor_id, t_ns FROM lane_occupancy WHERE drivable) o ON o.drive_id = p.drive_id AND o.actor_id = p.object_id AND o.t_ns = p.t_ns
    LEFT JOIN (SELECT drive_id, ego_id, object_id, max(t_ego_in_ns) AS t_last_ns FROM conflict WHERE ego_first GROUP BY ALL) c
        ON c.drive_id = p.drive_id AND c.ego_id = p.ego_id AND c.object_id = p.object_id AND c.t_last_ns >= p.t_ns
    -- The ego does not overtake people who walk beside the road: rule h2.turn-pedestrian is about people on foot.
    WHERE ego_passes AND coalesce(speed_mps > standing_mps(), true) AND p.actor_class IS DISTINCT FROM 'pedestrian'
    GROUP BY p.drive_id, p.ego_id, p.t_ns, side
) p
    ON p.drive_id = rs.drive_id AND p.ego_id = rs.ego_id AND p.t_ns = rs.t_ns AND p.side = r.side
-- An actor without a class and a speed may go backwards, and then along the ego's way.
LEFT JOIN (
    SELECT DISTINCT drive_id, ego_id, t_ns FROM beside
    WHERE gap_m IS NULL AND coalesce(actor_class, '') <> 'pedestrian' OR actor_class IS NULL AND speed_mps IS NULL AND NOT along
) b
    ON b.drive_id = rs.drive_id AND b.ego_id = rs.ego_id AND b.t_ns = rs.t_ns
