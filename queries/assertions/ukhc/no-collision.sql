-- title = "No collision"
-- breach = "Collision"
-- clause = "UKHC R144: do not drive dangerously or without care for others; a collision is the plainest breach"
-- hypothesis = "At every step, and between two steps, was the ego's box clear of every other actor's box?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = ">"
-- unit = "m"
-- observes = "distance between the two"
-- near_margin = 0.5
-- merge_gap_s = 2.0
-- tags = ["contact", "standing"]
-- unaffected_by = ["velocity"]
-- reads = ["before_track", "between_steps", "clearance_least", "ego_state", "impact", "pair", "quality"]
-- requires = ["ego_size"]
--
-- [params.walking_mps]
-- default = 2.0
-- unit = "m/s"
-- why = "a person slower than this beside a standing vehicle gets in, out or past; a faster person may run into it, which may be a contact"
-- source = "our default: a brisk walk"
--
-- [reasons.contact_between_steps]
-- says = "contact between this step and the next, {depth_m:.2f} m deep"
--
-- [reasons.contact_not_ruled_out]
-- says = "contact between this step and the next, {step_s:.2f} s later, cannot be ruled out"
--
-- [reasons.contact_before_track]
-- says = "object {object_id} is first seen here, {apart_m:.2f} m from the ego and going away from it: back at these speeds, the boxes touched less than half a second before"
--
-- [reasons.impact_beside_boxes]
-- says = "the speeds show an impact here, although the boxes are {apart_m:.2f} m apart: the log's sizes or positions are not exact enough"
-- advice = "see the rule contact-signature"
--
-- [reasons.boxes_of_nobody_moving]
-- says = "the boxes overlap by {depth_m:.2f} m while neither moves: their sizes or positions are not exact enough to show a contact"
-- advice = "see the earlier steps, when one of them moved"
--
-- [reasons.contact_standing]
-- says = "contact, {depth_m:.2f} m deep, while the ego stood still: the ego was hit"
--
-- [reasons.contact_moving]
-- says = "contact, {depth_m:.2f} m deep; the ego moved at up to {fastest_3s_mps:.1f} m/s in the 3 s before"
--
-- [reasons.contact_speed_unknown]
-- says = "contact, {depth_m:.2f} m deep; it is not known which of the two hit the other: the ego's speed is missing for a part of the 3 s before"

-- @condition
SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id,
    -- An overlap between two steps is a contact only if it is deeper than the uncertainty of the ways between them (blur_m).
    -- Boxes that stay apart do not show that there was no contact at a step at which the speeds show an impact. An actor that is first seen
    -- behind the ego may have been struck before. An ego that touches the outline of a thing that is no actor cannot pass.
    CASE WHEN b.least_m < -b.blur_m THEN b.least_m WHEN b.least_m IS NULL AND i.t_ns IS NULL AND f.t_ns IS NULL AND o.message IS NULL THEN coalesce(p.clearance_m, l.least_m) END AS observed, 0.0 AS required,
    (p.clearance_is_bound OR p.clearance_m IS NULL) AND b.least_m IS NULL AND i.t_ns IS NULL AS at_least,
    CASE WHEN b.least_m < -b.blur_m THEN why('contact_between_steps', {'depth_m': -b.least_m})
        WHEN i.t_ns IS NOT NULL THEN why('impact_beside_boxes', {'apart_m': p.clearance_m})
        WHEN b.least_m IS NOT NULL THEN why('contact_not_ruled_out', {'step_s': (b.t_next_ns - b.t_ns) / 1e9})
        WHEN f.t_ns IS NOT NULL THEN why('contact_before_track', {'object_id': p.object_id, 'apart_m': p.clearance_m})
        ELSE o.message END AS reason
FROM pair p
LEFT JOIN between_steps b USING (drive_id, ego_id, t_ns, object_id)
LEFT JOIN clearance_least l USING (drive_id, ego_id, t_ns, object_id)
LEFT JOIN impact i USING (drive_id, ego_id, t_ns, object_id)
LEFT JOIN (FROM before_track WHERE least_m <= 0) f USING (drive_id, ego_id, t_ns, object_id)
LEFT JOIN (SELECT drive_id, actor_id AS ego_id, min(message) AS message FROM quality WHERE check_id = 'outline_contact' GROUP BY ALL) o USING (drive_id, ego_id)
WHERE coalesce(p.clearance_m > 0 OR p.clearance_is_bound, true)
UNION ALL
-- A contact at a step: the reason says whether the ego moved.
-- Boxes that overlap while neither moves show errors of the boxes, not a contact; the same holds for a person at the door of a standing car.
SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, CASE WHEN NOT nobody_moves OR i.t_ns IS NOT NULL THEN p.clearance_m END, 0.0, false,
    why(CASE WHEN nobody_moves AND i.t_ns IS NULL THEN 'boxes_of_nobody_moving' WHEN p.fastest_3s_mps < standing_mps() THEN 'contact_standing' WHEN p.fastest_3s_mps IS NOT NULL THEN 'contact_moving' ELSE 'contact_speed_unknown' END,
        {'depth_m': abs(p.clearance_m), 'fastest_3s_mps': p.fastest_3s_mps})
FROM (
    SELECT p.*, e.fastest_3s_mps,
        coalesce(e.fastest_3s_mps < standing_mps() AND (p.speed_mps < standing_mps() OR NOT may_be_vehicle(p.actor_class) AND p.speed_mps < $walking_mps), false) AS nobody_moves
    FROM pair p
    LEFT JOIN ego_state e USING (drive_id, ego_id, t_ns)
) p
LEFT JOIN impact i USING (drive_id, ego_id, t_ns, object_id)
WHERE p.clearance_m <= 0 AND NOT p.clearance_is_bound
