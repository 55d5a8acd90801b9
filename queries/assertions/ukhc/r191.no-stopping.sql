-- title = "No stopping on a crossing"
-- breach = "Stopped on a crossing"
-- clause = "UKHC R191 and R240: you must not stop or park on a pedestrian crossing; to stand for somebody in the way, or in a queue, is neither"
-- hypothesis = "Did the ego get over the crossing without standing on it for long of its own accord?"
-- kind = "postcondition"
-- subtype = "physical"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- tags = ["excuses", "standing"]
-- reads = ["crossing_passage", "standstill"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way onto the crossing: begin recording before it"
-- without_anchor = "the log does not show the ego past the crossing: record it until it is"
--
-- [params.stop_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: shorter is a pause, such as for a pedestrian"
--
-- [reasons.stood_idle_on_crossing]
-- says = "the ego stood on the crossing for {stood_s:.1f} s, and for {idle_s:.1f} s of these nothing was in its way"

-- @reference
-- An ego that reverses onto the crossing and stands there has no passage: its standstill is the reference point.
WITH standstill_in_passage AS (
    SELECT s.drive_id, s.ego_id, s.t_start_ns
    FROM standstill s
    JOIN crossing_passage p USING (drive_id, ego_id, crossing_id)
    WHERE coalesce(p.t_in_ns, s.t_start_ns) <= s.t_start_ns AND coalesce(p.t_out_ns, s.t_start_ns) >= s.t_start_ns
)
SELECT drive_id, ego_id, t_ns, (row_number() OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns NULLS FIRST, crossing_id) - 1)::INTEGER AS occurrence, crossing_id, t_out_ns
FROM (
    SELECT drive_id, ego_id, t_in_ns AS t_ns, crossing_id, t_out_ns FROM crossing_passage
    UNION ALL
    SELECT drive_id, ego_id, t_start_ns, crossing_id, t_end_ns FROM standstill ANTI JOIN standstill_in_passage USING (drive_id, ego_id, t_start_ns) WHERE crossing_id IS NOT NULL
)

-- @anchor
SELECT ref_id, t_out_ns AS t_ns
FROM reference
UNION ALL
SELECT r.ref_id, s.t_start_ns
FROM reference r
JOIN standstill s ON s.drive_id = r.drive_id AND s.ego_id = r.ego_id AND s.crossing_id = r.crossing_id
    AND s.t_start_ns >= r.t_ns AND s.t_start_ns <= coalesce(r.t_out_ns, s.t_start_ns)

-- @condition
SELECT rs.drive_id, rs.ego_id, rs.t_ns, rs.ref_id,
    CASE WHEN s.t_start_ns IS NULL THEN true
        WHEN s.idle_ns > $stop_s * 1e9 THEN false
        WHEN s.idle_at_most_ns > $stop_s * 1e9 THEN NULL
        WHEN s.end_seen THEN true END AS holds,
    CASE WHEN s.t_start_ns IS NOT NULL
        THEN why('stood_idle_on_crossing', {'stood_s': (s.t_end_ns - s.t_start_ns) / 1e9, 'idle_s': s.idle_ns / 1e9}) END AS reason
FROM reference_step rs
JOIN reference r USING (ref_id)
LEFT JOIN standstill s ON s.drive_id = rs.drive_id AND s.ego_id = rs.ego_id AND s.t_start_ns = rs.t_ns AND s.crossing_id = r.crossing_id
