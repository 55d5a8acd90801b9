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
-- An ego that went back into its lane, and of which it is not sure that it wanted to overtake, did not break the rule for sure.
SELECT
    r.drive_id, r.ego_id, r.t_ns, r.ref_id, s.profile, s.sda_m AS required, s.at_least,
    CASE WHEN NOT doubt.is_doubtful THEN s.da_m END AS observed,
    CASE WHEN doubt.is_doubtful THEN overtake_doubt(o.vbp_id) ELSE s.reason END AS reason
FROM reference r
JOIN overtake o USING (drive_id, ego_id, occurrence)
JOIN overtake_sda s USING (drive_id, ego_id, occurrence)
JOIN profile p USING (profile)
CROSS JOIN LATERAL (
    SELECT coalesce(NOT s.at_least AND s.da_m <= s.sda_m AND o.status = 'aborted' AND NOT o.sure, false) AS is_doubtful
) doubt
WHERE p.selected
