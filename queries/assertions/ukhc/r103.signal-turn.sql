-- # Draft: on a priority road that bends, and on the way into a roundabout, no signal is needed; maps show neither.
-- title = "Signal when turning at a junction"
-- breach = "No signal when turning at a junction"
-- clause = "UKHC R103, R179 and R182: give a signal to the side to which you are going to turn"
-- hypothesis = "When the ego's front came into the junction in which it turned, was the indicator of that side on?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = "holds"
-- reads = ["ego_state", "junction_passage"]
-- requires = ["map", "registration", "ego_size", "indicator"]
-- without_time = "the log does not show the ego on its way into the junction: begin recording before it"

-- @reference
SELECT drive_id, ego_id, t_in_ns AS t_ns, occurrence, turn
FROM junction_passage
WHERE coalesce(turn, 'left') IN ('left', 'right') AND branches NOT IN (1, 2)

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, e.indicator = r.turn AS holds,
    CASE WHEN r.turn IS NULL THEN why('turn_unseen')
        WHEN e.indicator IS NOT NULL THEN why('turned_with_indicator', {'turn': r.turn, 'indicator': e.indicator}) END AS reason
FROM reference r
JOIN ego_state e USING (drive_id, ego_id, t_ns)
