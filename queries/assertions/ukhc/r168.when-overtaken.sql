-- title = "Steady while being overtaken"
-- clause = "UKHC R168: if a driver is trying to overtake you, keep a steady course and speed, and slow down if need be to let them pass"
-- hypothesis = "At every step at which a vehicle overtook it in the opposing lane, did the ego neither accelerate nor drift towards it?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- merge_gap_s = 2.0
-- reads = ["beside", "data_log", "ego_corridor", "ego_motion", "ego_state", "environment"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [params.accel_mps2]
-- default = 0.3
-- unit = "m/s2"
-- why = "our default: what gradients and the accelerator's play make anyway"
--
-- [params.drift_mps]
-- default = 0.3
-- unit = "m/s"
-- why = "our default: what keeping the lane makes anyway"
--
-- [params.queue_mps]
-- default = 4.47
-- unit = "m/s"
-- why = "our default: at 10 mph and less the ego moves in a queue that two-wheelers go past"

-- @applies
-- where the lane beside is driven the other way, whoever is beside the ego there and drives its way is overtaking it
SELECT b.drive_id, b.ego_id, b.t_ns, b.object_id,
    b.along AND b.side = overtaking_side(m.handedness) AND coalesce(c.over_against, false) AND b.speed_mps > standing_mps()
        AND may_be_vehicle(b.actor_class) AND b.ego_speed_mps > $queue_mps AS applies
FROM beside b
JOIN data_log g USING (drive_id)
JOIN environment m USING (environment_id)
LEFT JOIN ego_state e USING (drive_id, ego_id, t_ns)
LEFT JOIN ego_corridor c ON c.drive_id = b.drive_id AND c.ego_id = b.ego_id AND c.t_ns = b.t_ns AND c.chain_id = e.chain_id

-- @condition
SELECT b.drive_id, b.ego_id, b.t_ns, b.object_id, a.accel_mps2 <= $accel_mps2 AND b.ego_lat_mps <= $drift_mps AS holds,
    format('accelerates by {:.2f} m/s2, drifts towards it at {:.2f} m/s', a.accel_mps2, b.ego_lat_mps) AS reason
FROM beside b
LEFT JOIN ego_motion a USING (drive_id, ego_id, t_ns)
