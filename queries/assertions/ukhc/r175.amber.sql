-- # Draft: whether pulling up might have caused a collision is more than a deceleration.
-- title = "Stop at amber if there is room"
-- breach = "Passed amber although there was room to stop"
-- clause = "UKHC R175: at amber go on only if you have crossed the line or are so close to it that pulling up might cause a collision"
-- hypothesis = "Where the ego crossed the stop line on amber, would stopping before it have needed harder braking than can be asked for?"
-- kind = "execution"
-- derivation = "model"
-- severity = "major"
-- legal = "must"
-- status = "draft"
-- sense = ">"
-- unit = "m/s2"
-- observes = "deceleration needed to stop before the line"
-- reads = ["stop_line_crossing"]
-- requires = ["map", "registration", "ego_size", "traffic_lights", "signals"]
--
-- [params.decel_mps2]
-- default = 3.5
-- unit = "m/s2"
-- why = "our default: firm braking that a driver behind can follow"
--
-- [reasons.amber_begin_unseen]
-- says = "the log does not show when the light turned amber"
-- advice = "record its state from before that"

-- @reference
SELECT drive_id, ego_id, t_ns, occurrence, state, signal_id, amber_speed_mps AS v, amber_front_m - thinking_distance_m(amber_speed_mps) AS room_m
FROM stop_line_crossing
WHERE control = 'traffic_light' AND coalesce(state, 'amber') = 'amber'

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, $decel_mps2 AS required,
    CASE WHEN state IS NULL THEN NULL WHEN room_m <= 0 THEN 'inf'::DOUBLE ELSE v ** 2 / (2 * room_m) END AS observed,
    CASE WHEN state IS NULL THEN why('light_state_unknown') WHEN room_m IS NULL THEN why('amber_begin_unseen') END AS reason
FROM reference
