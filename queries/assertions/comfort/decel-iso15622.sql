-- title = "Deceleration within ISO 15622"
-- breach = "Deceleration beyond ISO 15622"
-- clause = "ISO 15622 (adaptive cruise control): over two seconds brake no harder than people in traffic do; the faster the vehicle, the less hard"
-- hypothesis = "At every step, was the ego's mean deceleration over the last 2 s at most 5 m/s2 up to 5 m/s, falling to 3.5 m/s2 at 20 m/s?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "<="
-- unit = "m/s2"
-- observes = "mean deceleration over 2 s"
-- near_margin = 0.3
-- reads = ["clock", "ego_motion"]
-- requires = ["speeds"]
--
-- [params.slow_mps2]
-- default = 5.0
-- unit = "m/s2"
-- why = "limit of the mean over 2 s up to 5 m/s"
-- source = "ISO 15622:2018 6.4, operational limits (second-hand: the standard itself was not seen)"
--
-- [params.fast_mps2]
-- default = 3.5
-- unit = "m/s2"
-- why = "limit of the mean over 2 s from 20 m/s on"
-- source = "ISO 15622:2018 6.4, operational limits (second-hand: the standard itself was not seen)"
--
-- [params.tolerance_mps2]
-- default = 0.05
-- unit = "m/s2"
-- why = "our default: the error of an acceleration from recorded speeds; scripted vehicles drive at exactly the limit"
--
-- [params.edge_s]
-- default = 2.5
-- unit = "s"
-- why = "our default: this near to the ends of the log, the two seconds are not complete"

-- @condition
-- An ego that reverses brakes when its speed along its heading rises: what counts is by how much it is slower than 2 s before, in either
-- direction. Rounded, because the speed of 2 s before is computed back from the mean.
SELECT m.drive_id, m.ego_id, m.t_ns, round((abs(m.v_long_mps - 2 * m.accel_2s_mps2) - abs(m.v_long_mps)) / 2, 9) AS observed,
    iso15622_limit(abs(m.v_long_mps), $slow_mps2, $fast_mps2) + $tolerance_mps2 AS required,
    is_judged(m.accel_2s_mps2, m.t_ns, c.t_start_ns, c.t_end_ns, $edge_s) AS applies
FROM ego_motion m
JOIN clock c ON c.drive_id = m.drive_id AND c.ego_id = m.ego_id
