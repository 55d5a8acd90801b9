-- title = "Clear of everybody else"
-- clause = "UKHC R144: do not drive dangerously or without care for others; a collision is the plainest breach"
-- hypothesis = "At every step, was the ego's box clear of every other actor's box?"
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
-- reads = ["ego_state", "pair"]
-- requires = ["ego_size"]

-- @condition
SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed, 0.0 AS required, clearance_is_bound AS at_least, NULL AS reason
FROM pair
WHERE coalesce(clearance_m > 0 OR clearance_is_bound, true)
UNION ALL
-- contact: whether the ego moved is part of the answer
SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, p.clearance_m, 0.0, false,
    format('contact, {:.2f} m deep, ', -p.clearance_m) || CASE WHEN e.fastest_3s_mps < standing_mps() THEN 'while the ego stood still: it was struck'
        WHEN e.fastest_3s_mps IS NOT NULL THEN format('the ego having moved at {:.1f} m/s in the 3 s before', e.fastest_3s_mps) ELSE 'the ego''s speed is not known' END
FROM pair p
LEFT JOIN ego_state e USING (drive_id, ego_id, t_ns)
WHERE p.clearance_m <= 0 AND NOT p.clearance_is_bound
