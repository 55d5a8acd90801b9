-- title = "No passing in the zig-zags before a crossing"
-- clause = "UKHC R191 and R165: you must not overtake the moving motor vehicle nearest the crossing, or the one that has stopped there to give way, in the area marked by zig-zag lines"
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
-- a crossing that is neither a zebra nor signalled has no zig-zags; whom the ego got past before the log began is not known
WITH passed AS (
    SELECT p.drive_id, p.ego_id, p.object_id, p.ego_passes AND p.t_unseen_ns IS NULL AS seen, p.t_ns, coalesce(p.t_unseen_ns, p.t_ns) AS t_first_ns, s.travel_m
    FROM passing p
    JOIN step s USING (drive_id, ego_id, t_ns)
    WHERE p.ego_passes IS DISTINCT FROM false AND may_be_vehicle(p.actor_class) AND p.actor_class IS DISTINCT FROM 'bicycle'
)
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.kind <> 'other' AS applies,
    CASE WHEN bool_or(p.seen) THEN false WHEN i.travel_m >= $zigzag_m AND count(p.object_id) = 0 THEN true END AS holds,
    CASE WHEN bool_or(p.seen) THEN 'passed ' || string_agg(DISTINCT p.object_id, ', ' ORDER BY p.object_id) FILTER (p.seen) || ' before crossing ' || r.crossing_id
        WHEN count(p.object_id) > 0 THEN format('actor {} may have been passed before crossing {}', min(p.object_id), r.crossing_id)
        WHEN i.travel_m < $zigzag_m THEN 'the log does not show the way to the crossing' END AS reason
FROM reference r
JOIN step i USING (drive_id, ego_id, t_ns)
LEFT JOIN passed p ON p.drive_id = r.drive_id AND p.ego_id = r.ego_id AND p.t_first_ns <= r.t_out_ns AND p.travel_m >= i.travel_m - $zigzag_m
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id, r.kind, r.crossing_id, i.travel_m
