-- title = "No collision"
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
-- tags = ["contact"]
-- reads = ["between_steps", "clearance_least", "ego_state", "pair"]
-- requires = ["ego_size"]

-- @condition
SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id,
    -- An overlap between two steps is a contact only if it is deeper than the uncertainty of the ways between them (blur_m).
    CASE WHEN b.least_m < -b.blur_m THEN b.least_m WHEN b.least_m IS NULL THEN coalesce(p.clearance_m, l.least_m) END AS observed, 0.0 AS required,
    (p.clearance_is_bound OR p.clearance_m IS NULL) AND b.least_m IS NULL AS at_least,
    CASE WHEN b.least_m < -b.blur_m THEN format('contact between this step and the next, {:.2f} m deep', -b.least_m)
        WHEN b.least_m IS NOT NULL THEN format('contact between this step and the next, {:.2f} s later, cannot be ruled out', (b.t_next_ns - b.t_ns) / 1e9) END AS reason
FROM pair p
LEFT JOIN between_steps b USING (drive_id, ego_id, t_ns, object_id)
LEFT JOIN clearance_least l USING (drive_id, ego_id, t_ns, object_id)
WHERE coalesce(p.clearance_m > 0 OR p.clearance_is_bound, true)
UNION ALL
-- A contact at a step: the reason says whether the ego moved.
SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, p.clearance_m, 0.0, false,
    format('contact, {:.2f} m deep, ', -p.clearance_m) || CASE WHEN e.fastest_3s_mps < standing_mps() THEN 'while the ego stood still: it was struck'
        WHEN e.fastest_3s_mps IS NOT NULL THEN format('the ego having moved at {:.1f} m/s in the 3 s before', e.fastest_3s_mps) ELSE 'the ego''s speed is not known' END
FROM pair p
LEFT JOIN ego_state e USING (drive_id, ego_id, t_ns)
WHERE p.clearance_m <= 0 AND NOT p.clearance_is_bound
