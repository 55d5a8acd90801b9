-- title = "Keep the crossing clear in a queue"
-- breach = "Stood on the crossing in a queue"
-- clause = "UKHC R192: in queuing traffic keep pedestrian crossings clear"
-- hypothesis = "Did the ego get over the crossing without standing on it behind somebody?"
-- kind = "postcondition"
-- subtype = "physical"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- tags = ["standing"]
-- reads = ["crossing_passage", "standstill"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way onto the crossing: begin recording before it"
-- without_anchor = "the log does not show the ego past the crossing: record it until it is"
--
-- [params.near_m]
-- default = 10.0
-- unit = "m"
-- why = "our default: an ego that stands closer than this behind another vehicle stands because of it"
--
-- [params.slow_mps]
-- default = 1.0
-- unit = "m/s"
-- why = "our default: a vehicle slower than this moves up in a queue"
--
-- [params.long_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: shorter is a pause in traffic"
--
-- [reasons.stood_on_crossing]
-- says = "the ego stood on the crossing[ behind {object_id}]"

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
SELECT rs.drive_id, rs.ego_id, rs.t_ns, rs.ref_id,
    s.t_start_ns IS NULL OR NOT exit_full(s.blocking_id, s.blocking_gap_m, s.blocking_speed_mps, s.blocking_known, s.crossing_clear_m, s.t_end_ns - s.t_start_ns, $near_m, $slow_mps, $long_s) AS holds,
    CASE WHEN s.t_start_ns IS NOT NULL THEN why('stood_on_crossing', {'object_id': s.blocking_id}) END AS reason
FROM reference_step rs
JOIN reference r USING (ref_id)
LEFT JOIN standstill s ON s.drive_id = rs.drive_id AND s.ego_id = rs.ego_id AND s.t_start_ns = rs.t_ns AND s.crossing_id = r.crossing_id
