-- title = "Signal on at the last exit sign"
-- breach = "No signal at the last exit sign"
-- clause = "UKHC R103 and R273: signal in good time before leaving by an exit (physical precondition of Harper et al. 2021)"
-- hypothesis = "When the ego passed the last exit sign before it left, was the indicator to the exit's side on?"
-- kind = "precondition"
-- subtype = "physical"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["ego_state", "exit_taken"]
-- requires = ["map", "registration", "indicator", "exit_signs", "ego_size"]

-- @reference
SELECT drive_id, ego_id, t_ns, side, sign_id, t_sign_ns
FROM exit_taken

-- @anchor
SELECT ref_id, t_sign_ns AS t_ns
FROM reference
WHERE sign_id IS NOT NULL

-- @condition
SELECT r.drive_id, r.ego_id, r.t_sign_ns AS t_ns, r.ref_id, e.indicator = r.side AS holds
FROM reference r
JOIN ego_state e ON e.drive_id = r.drive_id AND e.ego_id = r.ego_id AND e.t_ns = r.t_sign_ns
