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
-- reads = ["clock", "ego_mode", "ego_motion"]
-- requires = ["mode_engaged", "mode_minimal_risk_manoeuvre"]
--
-- [params.brake_mps2]
-- default = 4.0
-- unit = "m/s2"
-- why = "deceleration allowed"
-- source = "UN R157 5.5.1"
--
-- [params.edge_s]
-- default = 1.0
-- unit = "s"
-- why = "our default: so near to the ends of the log the filter's windows are not whole"

-- @condition
SELECT m.drive_id, m.ego_id, m.t_ns, m.accel_mps2 AS observed, -$brake_mps2 AS required, f.is_on AND judged_inside(m.accel_mps2, m.t_ns, c.t_start_ns, c.t_end_ns, $edge_s) AS applies
FROM ego_motion m
JOIN clock c ON c.drive_id = m.drive_id AND c.ego_id = m.ego_id
LEFT JOIN (SELECT * FROM ego_mode WHERE mode = 'minimal_risk_manoeuvre') f ON f.drive_id = m.drive_id AND f.ego_id = m.ego_id AND f.t_ns = m.t_ns
