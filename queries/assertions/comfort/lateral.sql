-- title = "Lateral acceleration"
-- clause = "UN R79 5.6.2.1.3 (lane keeping): no more lateral acceleration than passengers bear"
-- hypothesis = "At every step, was the ego's lateral acceleration at most 3 m/s2?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "<="
-- unit = "m/s2"
-- observes = "lateral acceleration"
-- near_margin = 0.3
-- reads = ["clock", "ego_motion"]
--
-- [params.most_mps2]
-- default = 3.0
-- unit = "m/s2"
-- why = "the most that a lane keeping system may ask for"
-- source = "UN R79 5.6.2.1.3 (not seen)"
--
-- [params.edge_s]
-- default = 0.5
-- unit = "s"
-- why = "our default: so near to the ends of the log the filter's window is not whole"

-- @condition
-- filtered before it is differentiated, see ego_motion
SELECT m.drive_id, m.ego_id, m.t_ns, abs(m.lat_accel_mps2) AS observed, $most_mps2 AS required,
    judged_inside(m.lat_accel_mps2, m.t_ns, c.t_start_ns, c.t_end_ns, $edge_s) AS applies
FROM ego_motion m
JOIN clock c ON c.drive_id = m.drive_id AND c.ego_id = m.ego_id
