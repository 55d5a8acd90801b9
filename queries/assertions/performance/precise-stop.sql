-- title = "Stop close before the line"
-- breach = "Stopped far before the line"
-- clause = "Harper et al. 2021, performance (precise stopping): who stops for a line stops at it, not over it and not far before it"
-- hypothesis = "When the ego stopped for a stop line, did it stand with its front at most half a metre before the line?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "<="
-- unit = "m"
-- observes = "distance of the front from the best place to stop, a quarter of a metre before the line"
-- reads = ["clock", "standstill"]
-- requires = ["map", "registration", "ego_size", "stop_lines"]
--
-- [params.within_m]
-- default = 0.5
-- unit = "m"
-- why = "our default: a driver's eye is about that exact"
--
-- [params.for_it_m]
-- default = 5.0
-- unit = "m"
-- why = "our default: a vehicle that stands further away, a car's length or more, stands for another reason and drives up to the line later"
--
-- [reasons.stood_beyond_line]
-- says = "the front stood {front_m:.2f} m beyond the line; it should stand before the line, at most {within_m:.2f} m away"
--
-- [reasons.stood_before_line]
-- says = "the front stood {front_m:.2f} m before the line; it should stand before the line, at most {within_m:.2f} m away"

-- @reference
SELECT drive_id, ego_id, t_start_ns AS t_ns, occurrence FROM standstill
-- Where the place of the ego is not known, there may be a stop line.
WHERE stop_line_id IS NOT NULL OR junction_m IS NULL

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, abs(s.stop_line_m - $within_m / 2) AS observed, $within_m / 2 AS required,
    CASE WHEN s.stop_line_m IS NOT NULL
        THEN why(CASE WHEN s.stop_line_m < 0 THEN 'stood_beyond_line' ELSE 'stood_before_line' END, {'front_m': abs(s.stop_line_m), 'within_m': $within_m}) END AS reason,
    -- The rule does not apply if the ego stood from the beginning of the log, stood behind another vehicle at the line, or had a green
    -- light. Of a stop that begins in a hole of the log it is not known whether the ego stopped for the line.
    CASE WHEN s.begin_seen THEN true WHEN r.t_ns <= c.t_start_ns THEN false END AND s.stop_line_m <= $for_it_m AND s.state IS DISTINCT FROM 'green'
        AND CASE WHEN s.ahead_id IS NOT NULL THEN s.ahead_gap_m >= s.stop_line_m WHEN s.ahead_known THEN true END AS applies
FROM reference r
JOIN standstill s USING (drive_id, ego_id, occurrence)
JOIN clock c USING (drive_id, ego_id)
