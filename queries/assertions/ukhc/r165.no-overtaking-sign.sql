-- title = "No overtaking where a sign forbids it"
-- breach = "Overtook where a sign forbids it"
-- clause = "UKHC R165: you must not overtake after a no-overtaking sign, until the sign that cancels it"
-- hypothesis = "When the ego pulled out to overtake a moving vehicle, and when it drew level with one that it passed, did no no-overtaking sign hold?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- reads = ["overtake", "overtake_place"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [reasons.sign_unknown]
-- says = "it is not known whether a no-overtaking sign applies here, because behind the ego the map has no such sign, no end of such a sign and no junction, or because the sign is variable or has a plate"
-- advice = "use a map that goes back to the last junction"

-- @reference
SELECT o.drive_id, o.ego_id, o.t0_ns AS t_ns, o.vbp_id AS object_id, o.occurrence
FROM overtake o

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, o.v_vbp_mps > standing_mps() AS applies,
    -- If it is not sure that the manoeuvre is an overtake, the rule can be kept, but not broken.
    CASE WHEN o.begin_seen AND NOT (p.no_overtaking AND may_be_no_overtake(o.status, o.sure)) THEN NOT p.no_overtaking END AS holds,
    CASE WHEN NOT o.begin_seen THEN why('overtake_begin_unseen') WHEN p.no_overtaking IS NULL THEN why('sign_unknown')
        WHEN p.no_overtaking AND may_be_no_overtake(o.status, o.sure) THEN overtake_doubt(o.vbp_id) END AS reason
FROM reference r
JOIN overtake o USING (drive_id, ego_id, occurrence)
LEFT JOIN overtake_place p USING (drive_id, ego_id, occurrence)
