-- title = "No collision"
-- clause = "UKHC introduction and R144: drive so as not to collide with anybody or anything"
-- hypothesis = "At every step, was the ego's box clear of every other actor's box?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = ">"
-- unit = "m"
-- near_margin = 0.5
-- merge_gap_s = 2.0
-- reads = ["pair"]
-- requires = ["ego_size"]

-- @condition
SELECT drive_id, ego_id, t_ns, object_id, clearance_m AS observed, 0.0 AS required, clearance_is_bound AS at_least
FROM pair
