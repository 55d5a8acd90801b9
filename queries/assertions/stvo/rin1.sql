-- title = "Three seconds at the stop sign"
-- clause = "StVO 41(1), Anlage 2 no. 3, sign 206 (R_IN1 of Maierhofer et al. 2022): at a stop sign halt at the line"
-- hypothesis = "Before the ego crossed a stop line with a stop sign, did it stand close before it for the whole time?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = ">="
-- unit = "s"
-- observes = "time stood before the stop line"
-- reads = ["stop_line_crossing"]
-- requires = ["map", "registration", "ego_size", "stop_lines"]
--
-- [params.stand_s]
-- default = 3.0
-- unit = "s"
-- why = "how long a halt lasts: the law names no time"
-- source = "Maierhofer et al. 2022 (t_slw = 3 s, standing within 1 m of the line)"

-- @reference
SELECT drive_id, ego_id, t_ns, control, begin_seen, stood_s
FROM stop_line_crossing
WHERE coalesce(control, 'stop') = 'stop'

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, $stand_s AS required,
    -- where the approach was not seen, it may have stood longer
    CASE WHEN control IS NOT NULL AND (begin_seen OR stood_s >= $stand_s) THEN stood_s END AS observed,
    CASE WHEN control IS NULL THEN 'the map does not say what governs this line' END AS reason
FROM reference
