-- title = "No overtaking shortly before a junction"
-- breach = "Overtook shortly before a junction"
-- clause = "UKHC R167: do not overtake where you might come into conflict with others, such as when approaching a junction"
-- hypothesis = "When the ego pulled out into the opposing lane to overtake a moving vehicle, was the next junction far enough away?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "draft"
-- sense = ">="
-- unit = "m"
-- observes = "distance to the next junction"
-- near_margin = 5.0
-- reads = ["overtake", "overtake_place"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [params.junction_m]
-- default = 20.0
-- unit = "m"
-- why = "our default: four car lengths"
--
-- # Draft: how near is near is a judgement, and a junction of a private way counts as much as one of main roads.

-- @reference
SELECT drive_id, ego_id, t0_ns AS t_ns, vbp_id AS object_id, occurrence
FROM overtake
WHERE opposing IS DISTINCT FROM false

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, o.v_vbp_mps > standing_mps() AS applies, $junction_m AS required,
    CASE WHEN o.begin_seen THEN p.junction_m END AS observed,
    CASE WHEN NOT o.begin_seen THEN why('overtake_begin_unseen') END AS reason
FROM reference r
JOIN overtake o USING (drive_id, ego_id, occurrence)
LEFT JOIN overtake_place p USING (drive_id, ego_id, occurrence)
