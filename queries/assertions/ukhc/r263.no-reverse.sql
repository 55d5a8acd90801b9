-- title = "No reversing on a motorway"
-- breach = "Reversed on a motorway"
-- clause = "UKHC R263: you must not reverse along any part of a motorway, unless an officer directs you to"
-- hypothesis = "At every step on a motorway, did the ego not move backwards?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = ">="
-- unit = "m/s"
-- observes = "speed along its heading"
-- reads = ["ego_motion"]
-- requires = ["map", "registration", "road_types"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.back_mps]
-- default = 0.5
-- unit = "m/s"
-- why = "our default: slower than this is standing: recorded speeds of standing vehicles jitter"

-- @condition
SELECT drive_id, ego_id, t_ns, v_long_mps AS observed, -$back_mps AS required
FROM ego_motion
