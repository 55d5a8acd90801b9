-- title = "Safe distance ahead before overtaking"
-- breach = "Too little clear road ahead to overtake"
-- clause = "UKHC R162: before overtaking, make sure that the road is sufficiently clear ahead"
-- hypothesis = "When the ego first left its lane, was the distance to the oncoming vehicle more than the whole manoeuvre needs?"
-- kind = "execution"
-- derivation = "model"
-- severity = "critical"
-- legal = "should"
-- status = "stable"
-- sense = ">"
-- unit = "m"
-- observes = "distance ahead"
-- near_margin = 5.0
-- reads = ["overtake", "overtake_sda", "profile"]
-- requires = ["map", "registration", "handedness", "ego_size"]

-- @reference
SELECT drive_id, ego_id, t0_ns AS t_ns, ov_id AS object_id, occurrence
FROM overtake
WHERE opposing IS DISTINCT FROM false

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, s.profile, s.da_m AS observed, s.sda_m AS required, s.at_least, s.reason
FROM reference r
JOIN overtake_sda s USING (drive_id, ego_id, occurrence)
JOIN profile p USING (profile)
WHERE p.selected
