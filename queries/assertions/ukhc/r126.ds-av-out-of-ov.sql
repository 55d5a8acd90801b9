-- title = "Ego outside the oncoming vehicle's danger space"
-- breach = "Ego inside the oncoming vehicle's danger space"
-- clause = "UKHC R126 and R162 (runtime assertion of Harper et al. 2021): leave enough space to stop, in an overtake too"
-- hypothesis = "At every step of the overtake, was the ego outside the space that the oncoming vehicle needs to stop?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = "<"
-- unit = "m"
-- observes = "reach into the oncoming vehicle's danger space"
-- near_margin = 1.0
-- merge_gap_s = 1.0
-- tags = ["danger_space"]
-- reads = ["overtake_step"]
-- requires = ["map", "registration", "handedness", "ego_size"]

-- @applies
SELECT drive_id, ego_id, t_ns, ov_id AS object_id, stage AS episode,
    -- If it is not sure that the manoeuvre is an overtake, the rule can be kept, but not broken.
    CASE WHEN ov_id IS NOT NULL THEN CASE WHEN sure OR av_in_ds_ov_m < 0 THEN true END WHEN ov_known THEN false END AS applies,
    CASE WHEN ov_id IS NULL THEN ov_reason ELSE overtake_doubt(vbp_id) END AS reason
FROM overtake_step

-- @condition
SELECT DISTINCT drive_id, ego_id, t_ns, ov_id AS object_id, 0.0 AS required,
    -- A nearer vehicle without a place could only make the value worse: then only a violation is certain.
    CASE WHEN ov_known OR av_in_ds_ov_m >= 0 THEN av_in_ds_ov_m END AS observed
FROM overtake_step
