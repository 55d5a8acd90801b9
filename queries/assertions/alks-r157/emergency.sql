-- title = "Hard braking declared as an emergency manoeuvre"
-- breach = "Hard braking not declared as an emergency manoeuvre"
-- clause = "UN R157 5.3.1.1: a system that asks for more than 5 m/s2 of braking carries out an emergency manoeuvre, which is to be recorded"
-- hypothesis = "While the ego braked harder than 5 m/s2, did it declare an emergency manoeuvre?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "minor"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- exempt_after_s = "grace_s"
-- reads = ["clock", "ego_mode", "ego_motion"]
-- requires = ["mode_engaged"]
--
-- [params.emergency_mps2]
-- default = 5.0
-- unit = "m/s2"
-- why = "deceleration beyond which it is an emergency manoeuvre"
-- source = "UN R157 5.3.1.1"
--
-- [params.grace_s]
-- default = 0.3
-- unit = "s"
-- why = "our default: the smoothing of the acceleration and the delay of the message"
--
-- [params.edge_s]
-- default = 1.0
-- unit = "s"
-- why = "our default: this near to the ends of the log, the filter's windows are not complete"
--
-- [reasons.emergency_undeclared]
-- says = "the log never declares emergency_manoeuvre"
--
-- [reasons.braking_within_error]
-- says = "the ego braked at {decel_mps2:.1f} m/s2, which may be wrong by {error_mps2:.1f} m/s2"
-- advice = "record speeds with less noise"

-- @condition
SELECT m.drive_id, m.ego_id, m.t_ns, emergency.is_on AS holds, is_judged(m.accel_mps2, m.t_ns, c.t_start_ns, c.t_end_ns, $edge_s)
        AND m.accel_mps2 < -$emergency_mps2 AND CASE WHEN emergency.is_on OR m.accel_mps2 + coalesce(m.accel_error_mps2, 0.0) < -$emergency_mps2 THEN true END AS applies,
    CASE WHEN emergency.mode IS NULL THEN why('emergency_undeclared')
        WHEN NOT emergency.is_on AND m.accel_mps2 < -$emergency_mps2 AND m.accel_mps2 + m.accel_error_mps2 >= -$emergency_mps2
            THEN why('braking_within_error', {'decel_mps2': -m.accel_mps2, 'error_mps2': m.accel_error_mps2}) END AS reason
FROM ego_motion m
JOIN clock c ON c.drive_id = m.drive_id AND c.ego_id = m.ego_id
LEFT JOIN (SELECT * FROM ego_mode WHERE mode = 'emergency_manoeuvre') emergency ON emergency.drive_id = m.drive_id AND emergency.ego_id = m.ego_id AND emergency.t_ns = m.t_ns
