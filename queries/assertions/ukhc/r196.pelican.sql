-- title = "Stop at a signalled crossing"
-- breach = "Did not stop at a signalled crossing"
-- clause = "UKHC R196 and R197: at a signalled crossing you must stop on red, and give way to people on it while amber flashes, to those from beyond an island too"
-- hypothesis = "When the ego went onto the crossing, did the light allow it? And if amber flashed, or the light turned red after the ego had crossed the stop line, was nobody on the ego's half or about to come onto it?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- law = ["gb"]
-- sense = "holds"
-- reads = ["crossing_passage", "ego_state", "stop_line_crossing"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way onto the crossing: begin recording before it"
--
-- [params.past_line_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: a stop line crossed longer ago is not the one before this crossing"
--
-- [reasons.light_changed]
-- says = "the light was {line_state} at the line and {state} at the crossing[, and {object_id} on the crossing]"
--
-- [reasons.light_unknown]
-- says = "the state of the light was not known[, and {object_id} on the crossing]"
-- advice = "record the light's state at every step"
--
-- [reasons.light_unknown_at_line]
-- says = "the state of the light was not known at the line and {state} at the crossing[, and {object_id} on the crossing]"
-- advice = "record the light's state at every step"
--
-- [reasons.light_unknown_at_crossing]
-- says = "the light was {line_state} at the line, and its state not known at the crossing[, and {object_id} on the crossing]"
-- advice = "record the light's state at every step"

-- @reference
-- If the crossing has a stop line, the ego must obey the light at that line; if it stood between the two, that at the crossing.
-- The later state of the light says whether it must give way.
SELECT c.drive_id, c.ego_id, c.t_in_ns AS t_ns, c.occurrence, c.on_id AS object_id, c.t_on_ns, c.known, c.coming_id, c.coming_known, c.state,
    count(l.t_ns) > 0 AND count(e.t_ns) = 0 AS has_line, max({'t': l.t_ns, 'state': l.state}).state AS line_state
FROM crossing_passage c
LEFT JOIN stop_line_crossing l ON l.drive_id = c.drive_id AND l.ego_id = c.ego_id AND l.signal_id = c.signal_id
    AND l.t_ns <= c.t_in_ns AND l.t_ns >= c.t_in_ns - ($past_line_s * 1e9)::BIGINT
LEFT JOIN (SELECT drive_id, ego_id, t_ns FROM ego_state WHERE speed_mps <= standstill_mps()) e
    ON e.drive_id = l.drive_id AND e.ego_id = l.ego_id AND e.t_ns > l.t_ns AND e.t_ns < c.t_in_ns
WHERE coalesce(c.kind, 'signalled') = 'signalled'
GROUP BY c.drive_id, c.ego_id, c.t_in_ns, c.occurrence, c.on_id, c.t_on_ns, c.known, c.coming_id, c.coming_known, c.state

-- @condition
-- A light that is off allows nothing and forbids nothing: if a pedestrian is there, a person must judge. On green and amber, another rule
-- applies to the people on the crossing.
SELECT drive_id, ego_id, t_ns, ref_id,
    NOT forbids(CASE WHEN has_line THEN line_state ELSE state END)
        AND (coalesce(state IN ('green', 'amber'), false)
            OR CASE WHEN object_id IS NOT NULL AND t_on_ns < t_ns OR coming_id IS NOT NULL THEN CASE WHEN state = 'flashing' OR forbids(state) THEN false END
                -- At the step at which both come, it is not known who was first.
                WHEN object_id IS NOT NULL AND t_on_ns = t_ns THEN NULL
                WHEN known AND coming_known THEN true END) AS holds,
    why(CASE WHEN has_line AND line_state IS DISTINCT FROM state
            THEN CASE WHEN line_state IS NULL THEN 'light_unknown_at_line' WHEN state IS NULL THEN 'light_unknown_at_crossing' ELSE 'light_changed' END
        WHEN state IS NULL THEN 'light_unknown' ELSE 'light_was' END,
        {'line_state': line_state, 'state': state, 'object_id': coalesce(object_id, coming_id)}) AS reason
FROM reference
