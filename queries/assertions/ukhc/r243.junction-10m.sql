-- # Draft: whether it is parking or waiting, and in an authorised place, is not in a trace.
-- title = "No parking near a junction"
-- breach = "Parked near a junction"
-- clause = "UKHC R243: do not stop or park within 10 metres of a junction or opposite one, except in an authorised space or when stationary traffic forces you to"
-- hypothesis = "Where the ego stood for long and not in a queue or at a stop line, was it clear of the next junction?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- law = ["gb"]
-- sense = ">="
-- unit = "m"
-- observes = "way to the next junction"
-- tags = ["standing"]
-- reads = ["standstill"]
-- requires = ["map", "registration", "ego_size"]
--
-- [params.clear_m]
-- default = 10.0
-- unit = "m"
-- why = "ten metres of a junction"
-- source = "UKHC R243"
--
-- [params.parked_s]
-- default = 60.0
-- unit = "s"
-- why = "our default: an ego that stands longer than this has parked, or waits so long that it has the same effect"
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
-- [reasons.may_have_queued]
-- says = "not every actor ahead can be placed: it may have been a queue"

-- @reference
SELECT drive_id, ego_id, t_start_ns AS t_ns, occurrence, junction_id, junction_m,
    queued(ahead_id, ahead_gap_m, ahead_speed_mps, ahead_known, $near_m, $slow_mps) AS queues
FROM standstill
WHERE t_end_ns - t_start_ns >= $parked_s * 1e9 AND stop_line_id IS NULL

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, $clear_m AS required, NOT queues AS applies,
    CASE WHEN junction_id IS NOT NULL THEN 0.0::DOUBLE ELSE junction_m END AS observed,
    CASE WHEN queues IS NULL THEN why('may_have_queued') END AS reason
FROM reference
