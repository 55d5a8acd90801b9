-- title = "Lane change completed in less than 5 s"
-- breach = "Lane change not completed in 5 s"
-- clause = "UN R79 5.6.4.6.5: the lane change manoeuvre of a car is completed in less than 5 s"
-- hypothesis = "Was the ego wholly in the new lane in less than 5 s after it first reached over the line?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "minor"
-- legal = "must"
-- status = "stable"
-- sense = "<"
-- unit = "s"
-- observes = "time over the line"
-- near_margin = 0.2
-- reads = ["clock", "lane_change"]
-- requires = ["mode_engaged", "map", "registration", "ego_size"]
--
-- [applies]
-- vehicle_class = ["car", "car_towing"]
--
-- [params.most_s]
-- default = 5.0
-- unit = "s"
-- why = "time allowed for cars and light goods vehicles; heavy ones have ten"
-- source = "UN R79 5.6.4.6.5"

-- @reference
SELECT drive_id, ego_id, t_start_ns AS t_ns, t_done_ns, begin_seen
FROM lane_change

-- @condition
-- The ego comes over the line in the step before t_ns, and is done in the step before t_done_ns: the time may be one step longer or shorter.
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, CASE WHEN r.begin_seen THEN (r.t_done_ns - r.t_ns) / 1e9 END AS observed, $most_s AS required, k.period_ns / 1e9 AS error
FROM reference r
JOIN clock k USING (drive_id, ego_id)
