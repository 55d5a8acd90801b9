-- title = "Not cutting in after overtaking"
-- breach = "Cut in after overtaking"
-- clause = "UKHC R163: move back when you can, but do not cut in"
-- hypothesis = "When the ego was wholly back in its lane, was its gap to the vehicle that it passed at least that vehicle's thinking distance?"
-- kind = "execution"
-- derivation = "model"
-- severity = "major"
-- legal = "should"
-- status = "draft"
-- sense = ">="
-- unit = "m"
-- observes = "gap to the vehicle passed"
-- near_margin = 1.0
-- reads = ["overtake"]
-- without_time = "the log does not show the ego back in its lane: record it until it is"
-- requires = ["map", "registration", "handedness", "ego_size"]

-- @reference
SELECT drive_id, ego_id, t3_ns AS t_ns, vbp_id AS object_id, occurrence
FROM overtake
-- If the log ends after the ego has passed the vehicle, the time of the return is not known.
WHERE passed AND (t3_ns IS NOT NULL OR status = 'truncated')

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, o.t3_gap_m AS observed, thinking_distance_m(o.v_vbp_t3_mps) AS required
FROM reference r
JOIN overtake o USING (drive_id, ego_id, occurrence)
