-- title = "Not too close to the vehicle ahead when pulling out"
-- breach = "Pulled out too close to the vehicle ahead"
-- clause = "UKHC R163: do not get too close to the vehicle you intend to overtake"
-- hypothesis = "When the ego first left its lane, was it further from the vehicle being passed than its stopping distance?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = ">"
-- unit = "m"
-- observes = "gap to the vehicle ahead"
-- near_margin = 1.0
-- reads = ["overtake"]
-- requires = ["map", "registration", "handedness", "ego_size"]

-- @reference
SELECT drive_id, ego_id, t0_ns AS t_ns, vbp_id AS object_id, occurrence
FROM overtake
-- A vehicle that is beside the ego when the ego leaves its lane is not ahead: the ego is close to it across the lane, not behind it.
WHERE NOT begin_seen OR coalesce(vbp_gap_m >= 0, true)

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, stopping_distance_m(o.v_av_mps) AS required,
    CASE WHEN o.begin_seen AND NOT is_doubtful THEN o.vbp_gap_m END AS observed,
    CASE WHEN NOT o.begin_seen THEN why('overtake_begin_unseen') WHEN is_doubtful THEN overtake_doubt(o.vbp_id) END AS reason
FROM reference r
JOIN overtake o USING (drive_id, ego_id, occurrence)
CROSS JOIN LATERAL (SELECT coalesce(o.vbp_gap_m <= stopping_distance_m(o.v_av_mps), false) AND may_be_no_overtake(o.status, o.sure) AS is_doubtful) doubt
