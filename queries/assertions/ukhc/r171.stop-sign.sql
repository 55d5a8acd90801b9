-- title = "Stop at a stop sign"
-- clause = "UKHC R171: at a stop sign you must stop behind the line"
-- hypothesis = "Did the ego come to a halt just before the stop line that it crossed?"
-- kind = "precondition"
-- subtype = "physical"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "<="
-- unit = "m/s"
-- observes = "least speed just before the stop line"
-- reads = ["stop_line_crossing"]
-- requires = ["map", "registration", "ego_size", "stop_lines"]
--
-- [params.standing_mps]
-- default = 0.1
-- unit = "m/s"
-- why = "our default: slower than this is a halt, for a recorded speed is seldom exactly zero"

-- @reference
SELECT drive_id, ego_id, t_ns, occurrence, stop_line_id, begin_seen, slowest_mps
FROM stop_line_crossing
WHERE control = 'stop'

-- @anchor
SELECT ref_id, t_ns
FROM reference

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, $standing_mps AS required,
    CASE WHEN begin_seen OR slowest_mps <= $standing_mps THEN slowest_mps END AS observed,
    CASE WHEN NOT begin_seen THEN 'the log does not show how the ego came to the stop line' END AS reason
FROM reference
