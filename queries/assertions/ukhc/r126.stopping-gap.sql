-- title = "Room to stop behind the vehicle ahead"
-- breach = "No room to stop behind the vehicle ahead"
-- clause = "UKHC R126, R227 and R230: leave enough space to the vehicle in front to pull up if it suddenly slows down or stops, never less than the overall stopping distance; twice that in the wet, up to ten times on ice"
-- hypothesis = "At every step behind a vehicle, was the gap to it at least the ego's stopping distance?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = ">="
-- unit = "m"
-- observes = "gap to the vehicle ahead"
-- near_margin = 2.0
-- merge_gap_s = 5.0
-- reads = ["ego_condition", "following"]
-- requires = ["way", "ego_size"]
--
-- [params.settle_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: time to restore the gap after one of the two changed into the lane, the same as in r126.two-second; a vehicle that was ahead already, or whose coming was not seen (at the log's begin, say), counts as settled; weather that is not known counts as dry: too close in the dry is too close in any weather"
--
-- # Draft: in the dry the two seconds of the same rule 126 are less than the stopping distance above 40 mph: which of the two a driver keeps
-- # is a judgement.

-- @applies
SELECT drive_id, ego_id, t_ns, object_id, follows AND (joined_ns IS NULL OR t_ns - joined_ns >= ($settle_s * 1e9)::BIGINT) AS applies
FROM following

-- @condition
SELECT f.drive_id, f.ego_id, f.t_ns, f.object_id, f.gap_m AS observed,
    stopping_factor(c.weather) * danger_space_m(f.ego_speed_mps) AS required
FROM following f
LEFT JOIN ego_condition c USING (drive_id, ego_id, t_ns)
