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
-- reads = ["following", "velocity_bound"]
-- requires = ["way", "ego_size"]
-- unaffected_by = ["velocity"]
--
-- [params.settle_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: time to restore the gap after one of the two changed into the lane, the same as in r126.two-second; a vehicle that was ahead already, or whose coming was not seen (at the log's begin, say), counts as settled"

-- @applies
-- A vehicle that is not seen is at least free_m away: if that is enough, the rule does not apply. A velocity in doubt does not excuse.
SELECT f.drive_id, f.ego_id, f.t_ns, f.object_id,
    unless_in_doubt(
        CASE WHEN f.follows IS NULL AND f.free_m >= thinking_distance_m(f.ego_speed_mps) THEN false ELSE f.follows AND (f.joined_ns IS NULL OR f.t_ns - f.joined_ns >= ($settle_s * 1e9)::BIGINT) END,
        CASE WHEN b.t_ns IS NULL AND o.t_ns IS NULL THEN 0 ELSE 1 END
    ) AS applies
FROM following f
LEFT JOIN velocity_bound b ON b.drive_id = f.drive_id AND b.ego_id = f.ego_id AND b.t_ns = f.t_ns AND b.object_id IS NULL
LEFT JOIN velocity_bound o ON o.drive_id = f.drive_id AND o.ego_id = f.ego_id AND o.t_ns = f.t_ns AND o.object_id = f.object_id

-- @condition
-- With a velocity in doubt, the rule can be kept, by the greatest speed that the ego can have, but not broken.
SELECT f.drive_id, f.ego_id, f.t_ns, f.object_id, thinking_distance_m(f.ego_speed_mps) AS required,
    CASE WHEN b.t_ns IS NULL AND o.t_ns IS NULL OR f.gap_m >= thinking_distance_m(CASE WHEN b.t_ns IS NULL THEN f.ego_speed_mps ELSE b.most_mps END) THEN f.gap_m END AS observed,
    CASE WHEN (b.t_ns IS NOT NULL OR o.t_ns IS NOT NULL) AND (f.gap_m >= thinking_distance_m(CASE WHEN b.t_ns IS NULL THEN f.ego_speed_mps ELSE b.most_mps END)) IS NOT true THEN why('velocity_in_doubt', {'object_id': f.object_id}) END AS reason
FROM following f
LEFT JOIN velocity_bound b ON b.drive_id = f.drive_id AND b.ego_id = f.ego_id AND b.t_ns = f.t_ns AND b.object_id IS NULL
LEFT JOIN velocity_bound o ON o.drive_id = f.drive_id AND o.ego_id = f.ego_id AND o.t_ns = f.t_ns AND o.object_id = f.object_id
