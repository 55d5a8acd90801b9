-- # Draft: maps do not say which junctions are boxes: every one in which three or more roads meet is taken for one.
-- title = "Keep the box junction clear"
-- breach = "Stood in the box junction"
-- clause = "UKHC R174: you must not enter a box junction until your exit is clear, except to turn right when only oncoming traffic, or others waiting to turn right, hold you up"
-- hypothesis = "Did the ego get through the junction without standing in it behind somebody?"
-- kind = "postcondition"
-- subtype = "physical"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "draft"
-- sense = "holds"
-- tags = ["standing"]
-- reads = ["junction_passage", "standstill"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way into the junction: begin recording before it"
-- without_anchor = "the log does not show the ego on its way out of the junction: record it until it has left"
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
-- [params.inside_m]
-- default = 2.5
-- unit = "m"
-- why = "our default: about half a car; less of it in the junction is a bumper over its edge"

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, junction_id, t_out_ns, across
FROM junction_passage
WHERE branches NOT IN (1, 2)

-- @anchor
SELECT ref_id, t_out_ns AS t_ns
FROM reference
UNION ALL
SELECT r.ref_id, s.t_start_ns
FROM reference r
JOIN standstill s ON s.drive_id = r.drive_id AND s.ego_id = r.ego_id AND s.junction_id = r.junction_id
    AND s.t_start_ns >= r.t_ns AND s.t_start_ns <= coalesce(r.t_out_ns, s.t_start_ns)

-- @condition
SELECT rs.drive_id, rs.ego_id, rs.t_ns, rs.ref_id,
    -- An ego that turns across may wait for the oncoming traffic, behind a vehicle that waits for it, or for a full exit: which of these is
    -- not known.
    s.t_start_ns IS NULL OR coalesce(s.junction_inside_m < $inside_m, false)
        OR NOT exit_full(
            s.blocking_id, s.blocking_gap_m, s.blocking_speed_mps, s.blocking_known, s.junction_clear_m, CASE WHEN r.across THEN 0 ELSE s.t_end_ns - s.t_start_ns END,
            $near_m, $slow_mps, $long_s
        ) OR CASE WHEN NOT r.across THEN false END AS holds,
    CASE WHEN s.t_start_ns IS NOT NULL
        THEN why(CASE WHEN r.across THEN 'stood_in_junction_turning' ELSE 'stood_in_junction' END, {'object_id': s.blocking_id}) END AS reason
FROM reference_step rs
JOIN reference r USING (ref_id)
LEFT JOIN standstill s ON s.drive_id = rs.drive_id AND s.ego_id = rs.ego_id AND s.t_start_ns = rs.t_ns AND s.junction_id = r.junction_id
