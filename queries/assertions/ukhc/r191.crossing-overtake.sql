-- title = "No passing in the zig-zags before a crossing"
-- clause = "UKHC R191: you must not overtake the moving motor vehicle nearest the crossing, or the one that has stopped there to give way, in the area marked by zig-zag lines"
-- hypothesis = "When the ego went over a pedestrian crossing, had it got past no vehicle between the zig-zags' beginning and the crossing?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- reads = ["crossing_passage", "passing", "step"]
-- requires = ["map", "registration", "ego_size"]
--
-- [params.zigzag_m]
-- default = 18.0
-- unit = "m"
-- why = "our default, since maps do not show them: eight marks of two metres and the space between"

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, coalesce(t_out_ns, t_in_ns) AS t_out_ns, crossing_id, kind, occurrence
FROM crossing_passage

-- @condition
-- a crossing that is neither a zebra nor signalled has no zig-zags
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.kind <> 'other' AS applies, count(p.object_id) = 0 AS holds,
    'passed ' || string_agg(DISTINCT p.object_id, ', ' ORDER BY p.object_id) || ' before crossing ' || r.crossing_id AS reason
FROM reference r
JOIN step i USING (drive_id, ego_id, t_ns)
LEFT JOIN (
    SELECT drive_id, ego_id, t_ns, object_id, s.travel_m
    FROM passing JOIN step s USING (drive_id, ego_id, t_ns)
    WHERE ego_passes AND may_be_vehicle(actor_class) AND actor_class IS DISTINCT FROM 'bicycle'
) p ON p.drive_id = r.drive_id AND p.ego_id = r.ego_id AND p.t_ns <= r.t_out_ns AND p.travel_m >= i.travel_m - $zigzag_m
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.kind, r.crossing_id
