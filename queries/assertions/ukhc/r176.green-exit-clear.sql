-- title = "Room to clear the junction on green"
-- breach = "Entered the junction on green without room to clear it"
-- clause = "UKHC R176: go forward on green only if there is room to clear the junction, or to take up a position to turn right"
-- hypothesis = "After it had passed the light, did the ego get through the junction without standing in it behind somebody?"
-- kind = "postcondition"
-- subtype = "physical"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["junction_passage", "standstill"]
-- requires = ["map", "registration", "ego_size", "traffic_lights"]
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
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, junction_id, t_out_ns, across, control
FROM junction_passage
WHERE coalesce(control, 'traffic_light') = 'traffic_light'

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
    CASE WHEN r.control IS NOT NULL
        -- An ego that turns across may wait for the oncoming traffic, behind a vehicle that waits for it, or for a full exit: which of
        -- these is not known.
        THEN s.t_start_ns IS NULL OR coalesce(s.junction_inside_m < $inside_m, false)
            OR NOT exit_full(
                s.blocking_id, s.blocking_gap_m, s.blocking_speed_mps, s.blocking_known, s.junction_clear_m, CASE WHEN r.across THEN 0 ELSE s.t_end_ns - s.t_start_ns END,
                $near_m, $slow_mps, $long_s
            ) OR CASE WHEN NOT r.across THEN false END END AS holds,
    CASE WHEN s.t_start_ns IS NOT NULL
        THEN why(CASE WHEN r.across THEN 'stood_in_junction_turning' ELSE 'stood_in_junction' END, {'object_id': s.blocking_id}) END AS reason
FROM reference_step rs
JOIN reference r USING (ref_id)
LEFT JOIN standstill s ON s.drive_id = rs.drive_id AND s.ego_id = rs.ego_id AND s.t_start_ns = rs.t_ns AND s.junction_id = r.junction_id
