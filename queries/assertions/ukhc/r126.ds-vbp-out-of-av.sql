-- title = "Vehicle being passed outside the ego's danger space"
-- breach = "Vehicle being passed inside the ego's danger space"
-- clause = "UKHC R126 and R162 (runtime assertion of Harper et al. 2021): leave enough space to stop, in an overtake too"
-- hypothesis = "At every step of the overtake, was the vehicle being passed outside the space that the ego needs to stop?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "<"
-- unit = "m"
-- observes = "reach into the ego's danger space"
-- near_margin = 1.0
-- merge_gap_s = 1.0
-- tags = ["danger_space"]
-- reads = ["overtake_step"]
-- requires = ["map", "registration", "handedness", "ego_size"]

-- @applies
-- If it is not sure that the manoeuvre is an overtake, the rule can be kept, but not broken.
SELECT drive_id, ego_id, t_ns, vbp_id AS object_id, stage AS episode, CASE WHEN sure OR vbp_in_ds_av_m < 0 THEN true END AS applies,
    overtake_doubt(vbp_id) AS reason
FROM overtake_step

-- @condition
SELECT drive_id, ego_id, t_ns, vbp_id AS object_id, vbp_in_ds_av_m AS observed, 0.0 AS required FROM overtake_step
