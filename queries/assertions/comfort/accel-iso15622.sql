-- title = "Acceleration within ISO 15622"
-- breach = "Acceleration beyond ISO 15622"
-- clause = "ISO 15622 (adaptive cruise control): speed up gently; the faster the vehicle, the more gently"
-- hypothesis = "At every step, was the ego's acceleration at most 4 m/s2 up to 5 m/s, falling to 2 m/s2 at 20 m/s?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "<="
-- unit = "m/s2"
-- observes = "acceleration"
-- near_margin = 0.3
-- reads = ["clock", "ego_motion"]
-- requires = ["speeds"]
--
-- [params.slow_mps2]
-- default = 4.0
-- unit = "m/s2"
-- why = "limit up to 5 m/s"
-- source = "ISO 15622:2018 6.4, operational limits (second-hand: the standard itself was not seen)"
--
-- [params.fast_mps2]
-- default = 2.0
-- unit = "m/s2"
-- why = "limit from 20 m/s on"
-- source = "ISO 15622:2018 6.4, operational limits (second-hand: the standard itself was not seen)"
--
-- [params.tolerance_mps2]
-- default = 0.05
-- unit = "m/s2"
-- why = "our default: the error of an acceleration from recorded speeds; scripted vehicles drive at exactly the limit"
--
-- [params.edge_s]
-- default = 0.5
-- unit = "s"
-- why = "our default: this near to the ends of the log, the filter's window is not complete"

-- @condition
-- The speed is filtered before it is differentiated, see ego_motion. A reversing ego accelerates when the speed along its heading falls.
SELECT m.drive_id, m.ego_id, m.t_ns, peak_sure_at_most(bound.accel_mps2, m.accel_peak_mps2, bound.limit_mps2) AS observed, bound.limit_mps2 AS required, m.accel_error_mps2 AS error,
    is_judged(m.accel_mps2, m.t_ns, c.t_start_ns, c.t_end_ns, $edge_s) AS applies,
    CASE WHEN bound.accel_mps2 <= bound.limit_mps2 AND bound.accel_mps2 + m.accel_peak_mps2 > bound.limit_mps2 THEN why('peak_flattened') END AS reason
FROM ego_motion m
JOIN clock c ON c.drive_id = m.drive_id AND c.ego_id = m.ego_id
CROSS JOIN LATERAL (
    SELECT CASE WHEN m.v_long_mps < -standing_mps() THEN -m.accel_mps2 ELSE m.accel_mps2 END AS accel_mps2,
        iso15622_limit(abs(m.v_long_mps), $slow_mps2, $fast_mps2) + $tolerance_mps2 AS limit_mps2
) bound
