-- title = "Never closer than the thinking distance"
-- breach = "Closer than the thinking distance"
-- clause = "UKHC R126: leave enough space to the vehicle in front; within the thinking distance no braking helps, whatever the weather"
-- hypothesis = "At every step behind a vehicle, was the gap to it at least the ego's thinking distance?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "critical"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "m"
-- observes = "gap to the vehicle ahead"
-- near_margin = 1.0
-- merge_gap_s = 5.0
-- reads = ["following"]
-- requires = ["way", "ego_size"]
--
-- [params.settle_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: time to restore the gap after one of the two changed into the lane, the same as in r126.two-second; a vehicle that was ahead already, or whose coming was not seen (at the log's begin, say), counts as settled"

-- @applies
-- A vehicle that is not seen is at least free_m away: if that is enough, the rule does not apply.
SELECT drive_id, ego_id, t_ns, object_id,
    CASE WHEN follows IS NULL AND free_m >= thinking_distance_m(ego_speed_mps) THEN false ELSE follows AND (joined_ns IS NULL OR t_ns - joined_ns >= ($settle_s * 1e9)::BIGINT) END AS applies
FROM following

-- @condition
SELECT drive_id, ego_id, t_ns, object_id, gap_m AS observed, thinking_distance_m(ego_speed_mps) AS required
FROM following
