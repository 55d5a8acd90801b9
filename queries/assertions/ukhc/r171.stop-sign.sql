-- title = "Stop at a stop sign"
-- breach = "Did not stop at a stop sign"
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
-- reads = ["junction_passage", "stop_line_crossing"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way into the junction: begin recording before it"
--
-- [params.standing_mps]
-- default = 0.1
-- unit = "m/s"
-- why = "our default: slower than this is a halt, for a recorded speed is seldom exactly zero"
--
-- [params.line_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: a stop line crossed longer than this before or after is not the one at this junction"
--
-- [reasons.no_stop_line]
-- says = "the map has a stop sign here, but no stop line"
--
-- [reasons.approach_unseen]
-- says = "the log does not show how the ego approached the stop line"
--
-- [reasons.may_have_halted]
-- says = "the slowest step was at {slowest_mps:.2f} m/s: the ego may have come to a halt between two steps, or before the log begins"
-- advice = "record more steps a second"

-- @reference
-- A way into a junction that is, or may be, governed by a stop sign, and has no stop line in the map, cannot be judged.
SELECT drive_id, ego_id, t_ns, stop_line_id, control, begin_seen, slowest_mps, least_mps
FROM stop_line_crossing
WHERE control = 'stop'
UNION ALL
SELECT p.drive_id, p.ego_id, p.t_in_ns, NULL, p.control, NULL, NULL, NULL
FROM junction_passage p
ANTI JOIN stop_line_crossing c ON c.drive_id = p.drive_id AND c.ego_id = p.ego_id AND c.control = 'stop'
    AND c.t_ns >= p.t_in_ns - ($line_s * 1e9)::BIGINT AND c.t_ns <= p.t_in_ns + ($line_s * 1e9)::BIGINT
WHERE coalesce(p.control, 'stop') = 'stop'

-- @anchor
SELECT ref_id, t_ns
FROM reference

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, $standing_mps AS required,
    -- A halt of any length is enough.
    CASE WHEN begin_seen AND (least_mps <= $standing_mps) IS DISTINCT FROM true OR slowest_mps <= $standing_mps THEN slowest_mps END AS observed,
    CASE WHEN control IS NULL THEN why('way_in_control_unknown')
        WHEN stop_line_id IS NULL THEN why('no_stop_line')
        WHEN NOT begin_seen THEN why('approach_unseen')
        WHEN slowest_mps > $standing_mps AND least_mps <= $standing_mps THEN why('may_have_halted', {'slowest_mps': slowest_mps}) END AS reason
FROM reference
