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
-- reads = ["clock", "stop_line_crossing"]
-- requires = ["map", "registration", "ego_size", "stop_lines"]
--
-- [params.stand_s]
-- default = 1.0
-- unit = "s"
-- why = "our default: a complete halt that can be seen; the law demands a halt of any length, the model one of 3 s (t_slw)"
--
-- [reasons.line_control_unknown]
-- says = "the map does not state what governs this line"
--
-- [reasons.stood_between_steps]
-- says = "the ego stood for {stood_s:.1f} s as far as its steps show, and for at most {error_s:.1f} s more before the first and after the last of them"
-- advice = "record more steps a second"

-- @reference
SELECT drive_id, ego_id, t_ns, control, begin_seen, stood_s, slowest_mps
FROM stop_line_crossing
WHERE coalesce(control, 'stop') = 'stop'

-- @condition
-- An ego that stood at a step stood for up to one step longer before and after; one that stood at no step, for less than one.
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, $stand_s AS required,
    -- If the approach was not seen, the ego may have stood longer.
    CASE WHEN r.control IS NOT NULL AND (r.begin_seen OR r.stood_s >= $stand_s) THEN r.stood_s END AS observed, longer.error_s AS error,
    CASE WHEN r.control IS NULL THEN why('line_control_unknown')
        WHEN r.stood_s < $stand_s AND r.stood_s + longer.error_s >= $stand_s THEN why('stood_between_steps', {'stood_s': r.stood_s, 'error_s': longer.error_s}) END AS reason
FROM reference r
LEFT JOIN clock k USING (drive_id, ego_id)
CROSS JOIN LATERAL (SELECT coalesce(k.period_ns * CASE WHEN r.slowest_mps <= standstill_mps() THEN 2 ELSE 1 END / 1e9, 0.0) AS error_s) longer
