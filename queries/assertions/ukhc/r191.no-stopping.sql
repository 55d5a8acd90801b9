-- title = "No stopping on a crossing"
-- clause = "UKHC R191 and R240: you must not stop or park on a pedestrian crossing; to stand for somebody in the way, or in a queue, is neither"
-- hypothesis = "Did the ego get over the crossing without standing on it for long of its own accord?"
-- kind = "postcondition"
-- subtype = "physical"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- reads = ["crossing_passage", "in_way", "standstill"]
-- requires = ["map", "registration", "ego_size"]
--
-- [params.stop_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: shorter is a pause, such as for somebody on foot"
--
-- [params.near_m]
-- default = 10.0
-- unit = "m"
-- why = "our default: who stands closer than this behind somebody stands because of them"
--
-- [params.slow_mps]
-- default = 1.0
-- unit = "m/s"
-- why = "our default: slower than this moves up in a queue"

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, crossing_id, t_out_ns
FROM crossing_passage

-- @anchor
SELECT ref_id, t_out_ns AS t_ns
FROM reference
UNION ALL
SELECT r.ref_id, s.t_start_ns
FROM reference r
JOIN standstill s ON s.drive_id = r.drive_id AND s.ego_id = r.ego_id AND s.crossing_id = r.crossing_id
    AND s.t_start_ns >= r.t_ns AND s.t_start_ns <= coalesce(r.t_out_ns, s.t_start_ns)

-- @condition
SELECT g.drive_id, g.ego_id, g.t_ns, g.ref_id,
    CASE WHEN s.t_start_ns IS NULL THEN true
        WHEN s.t_end_ns - s.t_start_ns > $stop_s * 1e9 THEN queued(s.ahead_id, s.ahead_gap_m, s.ahead_speed_mps, s.ahead_known, $near_m, $slow_mps)
            OR stands_for(w.object_id, w.actor_class, w.gap_m, w.along_mps, w.known, $near_m, $near_m, $slow_mps)
        WHEN s.end_seen THEN true END AS holds,
    format('the ego stood on the crossing for {:.1f} s', (s.t_end_ns - s.t_start_ns) / 1e9) AS reason
FROM reference_step g
JOIN reference r USING (ref_id)
LEFT JOIN standstill s ON s.drive_id = g.drive_id AND s.ego_id = g.ego_id AND s.t_start_ns = g.t_ns AND s.crossing_id = r.crossing_id
LEFT JOIN in_way w ON w.drive_id = g.drive_id AND w.ego_id = g.ego_id AND w.t_ns = g.t_ns
