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
-- reads = ["beside", "junction_passage", "passing"]
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
-- [reasons.unplaced_beside]
-- says = "an actor that may be beside the ego cannot be placed"

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, turn, across, at_fork(turn, turn_rad, straightest_rad) AS fork,
    CASE WHEN turn = 'straight' THEN CASE WHEN turn_rad > 0 THEN 'left' ELSE 'right' END ELSE turn END AS side
FROM junction_passage
WHERE across IS DISTINCT FROM true AND (turn IS DISTINCT FROM 'straight' OR at_fork(turn, turn_rad, straightest_rad))

-- @condition
SELECT rs.drive_id, rs.ego_id, rs.t_ns, rs.ref_id,
    CASE WHEN r.across IS NULL OR (p.t_ns IS NULL AND b.t_ns IS NOT NULL) THEN NULL WHEN p.t_ns IS NOT NULL THEN CASE WHEN NOT r.fork THEN false END ELSE true END AS holds,
    CASE WHEN r.across IS NULL THEN across_doubt(r.turn)
        WHEN p.t_ns IS NOT NULL AND r.fork THEN fork_doubt()
        WHEN p.t_ns IS NOT NULL THEN why('got_ahead_of', {'object_id': p.object_id})
        WHEN b.t_ns IS NOT NULL THEN why('unplaced_beside') END AS reason
FROM reference_step rs
JOIN reference r USING (ref_id)
LEFT JOIN (
    SELECT drive_id, ego_id, t_ns, side, min(object_id) AS object_id
    FROM passing
    -- The ego does not overtake people who walk beside the road: rule h2.turn-pedestrian is about people on foot.
    WHERE ego_passes AND coalesce(speed_mps > standing_mps(), true) AND actor_class IS DISTINCT FROM 'pedestrian'
    GROUP BY drive_id, ego_id, t_ns, side
) p
    ON p.drive_id = rs.drive_id AND p.ego_id = rs.ego_id AND p.t_ns = rs.t_ns AND p.side = r.side
LEFT JOIN (SELECT DISTINCT drive_id, ego_id, t_ns FROM beside WHERE gap_m IS NULL AND coalesce(actor_class, '') <> 'pedestrian') b
    ON b.drive_id = rs.drive_id AND b.ego_id = rs.ego_id AND b.t_ns = rs.t_ns
