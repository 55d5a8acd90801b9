-- # Draft: on the way into a roundabout, a signal to the side opposite to the first bend is correct; maps do not say where roundabouts are.
-- title = "No signal to the wrong side at a junction"
-- breach = "Signalled to the wrong side at a junction"
-- clause = "UKHC R103: signals must not mislead: do not signal to one side and turn to the other"
-- hypothesis = "When the ego's front came into the junction in which it turned, was the indicator of the other side off?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "draft"
-- sense = "holds"
-- reads = ["ego_state", "junction_passage"]
-- requires = ["map", "registration", "ego_size", "indicator"]
-- without_time = "the log does not show the ego on its way into the junction: begin recording before it"

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, turn
FROM junction_passage
WHERE coalesce(turn, 'left') IN ('left', 'right')

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id,
    CASE r.turn WHEN 'left' THEN e.indicator <> 'right' WHEN 'right' THEN e.indicator <> 'left' END AS holds,
    CASE WHEN r.turn IS NULL THEN why('turn_unseen')
        WHEN e.indicator IS NOT NULL THEN why('turned_with_indicator', {'turn': r.turn, 'indicator': e.indicator}) END AS reason
FROM reference r
JOIN ego_state e USING (drive_id, ego_id, t_ns)
