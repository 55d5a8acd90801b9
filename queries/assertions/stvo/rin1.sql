-- title = "A complete halt at the stop sign"
-- breach = "Did not come to a halt at the stop sign"
-- clause = "StVO 41(1), Anlage 2 no. 3, sign 206 (R_IN1 of Maierhofer et al. 2022): at a stop sign halt at the line; the law names no time"
-- hypothesis = "Before the ego crossed a stop line with a stop sign, did it stand close before the line, long enough to be seen?"
-- kind = "execution"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- law = ["de"]
-- sense = ">="
-- unit = "s"
-- observes = "time stood before the stop line"
-- reads = ["stop_line_crossing"]
-- requires = ["map", "registration", "ego_size", "stop_lines"]
--
-- [params.stand_s]
-- default = 1.0
-- unit = "s"
-- why = "our default: a complete halt that can be seen; the law demands a halt of any length, the model one of 3 s (t_slw)"
--
-- [reasons.line_control_unknown]
-- says = "the map does not state what governs this line"

-- @reference
SELECT drive_id, ego_id, t_ns, control, begin_seen, stood_s
FROM stop_line_crossing
WHERE coalesce(control, 'stop') = 'stop'

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, $stand_s AS required,
    -- If the approach was not seen, the ego may have stood longer.
    CASE WHEN control IS NOT NULL AND (begin_seen OR stood_s >= $stand_s) THEN stood_s END AS observed,
    CASE WHEN control IS NULL THEN why('line_control_unknown') END AS reason
FROM reference
