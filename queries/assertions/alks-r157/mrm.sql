-- title = "A gentle minimal risk manoeuvre"
-- clause = "UN R157 5.5.1: a minimal risk manoeuvre does not ask for more than 4 m/s2 of braking"
-- hypothesis = "During a minimal risk manoeuvre, did the ego brake no harder than 4 m/s2?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = ">="
-- unit = "m/s2"
-- observes = "acceleration"
-- near_margin = 0.2
-- reads = ["ego_mode", "ego_motion"]
-- requires = ["mode_engaged", "mode_minimal_risk_manoeuvre"]
--
-- [params.brake_mps2]
-- default = 4.0
-- unit = "m/s2"
-- why = "deceleration allowed"
-- source = "UN R157 5.5.1"

-- @condition
SELECT drive_id, ego_id, t_ns, m.accel_mps2 AS observed, -$brake_mps2 AS required, f.is_on AS applies
FROM ego_motion m
LEFT JOIN (SELECT * FROM ego_mode WHERE mode = 'minimal_risk_manoeuvre') f USING (drive_id, ego_id, t_ns)
