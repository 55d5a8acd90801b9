-- title = "Jerk within ISO 15622"
-- breach = "Jerk beyond ISO 15622"
-- clause = "ISO 15622 (adaptive cruise control): let braking grow gently; the faster the vehicle, the more gently"
-- hypothesis = "At every step, did the ego's deceleration grow, over the last second, by at most 5 m/s3 up to 5 m/s, falling to 2.5 m/s3 at 20 m/s?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "<="
-- unit = "m/s3"
-- observes = "growth of the deceleration over 1 s"
-- near_margin = 0.5
-- reads = ["clock", "ego_motion"]
-- requires = ["speeds"]
--
-- [params.slow_mps3]
-- default = 5.0
-- unit = "m/s3"
-- why = "limit up to 5 m/s"
-- source = "ISO 15622:2018 6.4, operational limits, negative jerk (second-hand: the standard itself was not seen)"
--
-- [params.fast_mps3]
-- default = 2.5
-- unit = "m/s3"
-- why = "limit from 20 m/s on"
-- source = "ISO 15622:2018 6.4, operational limits, negative jerk (second-hand: the standard itself was not seen)"
--
-- [params.edge_s]
-- default = 1.5
-- unit = "s"
-- why = "our default: this near to the ends of the log, the second and the filter's window are not complete"

-- @condition
-- The speed is filtered before it is differentiated, see ego_motion. An ego that only ends its acceleration does not brake: the growth of
-- the deceleration counts only up to the present deceleration. A reversing ego brakes when the speed along its heading rises.
SELECT m.drive_id, m.ego_id, m.t_ns, CASE WHEN m.accel_mps2 IS NOT NULL AND m.jerk_1s_mps3 IS NOT NULL
        THEN least(-way.sign * m.jerk_1s_mps3, greatest(-way.sign * m.accel_mps2, 0.0)) END AS observed,
    iso15622_limit(abs(m.v_long_mps), $slow_mps3, $fast_mps3) AS required, m.jerk_1s_error_mps3 AS error,
    is_judged(m.jerk_1s_mps3, m.t_ns, c.t_start_ns, c.t_end_ns, $edge_s) AS applies
FROM ego_motion m
JOIN clock c ON c.drive_id = m.drive_id AND c.ego_id = m.ego_id
CROSS JOIN LATERAL (SELECT CASE WHEN m.v_long_mps < -standing_mps() THEN -1 ELSE 1 END AS sign) way
