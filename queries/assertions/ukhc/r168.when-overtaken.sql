-- title = "Steady while being overtaken"
-- breach = "Unsteady while being overtaken"
-- clause = "UKHC R168: if a driver is trying to overtake you, keep a steady course and speed, and slow down if need be to let them pass"
-- hypothesis = "At every step at which a vehicle overtook it in the opposing lane, or came up to do so, did the ego neither accelerate, not even little by little, nor drift towards it?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- merge_gap_s = 2.0
-- reads = ["beside", "data_log", "ego_corridor", "ego_motion", "ego_state", "environment", "neighbour"]
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
-- why = "our default: an ego that only keeps its lane drifts by this much, too"
--
-- [params.gained_mps]
-- default = 1.5
-- unit = "m/s"
-- why = "our default: 3 mph, as much as the speed varies on a gradient with a steady foot; an ego that gains more while it is overtaken, however gently, makes the overtake longer"
--
-- [params.queue_mps]
-- default = 4.47
-- unit = "m/s"
-- why = "our default: at 10 mph and less the ego moves in a queue that two-wheelers go past"
--
-- [params.coming_s]
-- default = 4.0
-- unit = "s"
-- why = "our default, that of r162.not-being-overtaken: a vehicle in the opposing lane that reaches the ego within this time is overtaking it"
--
-- [reasons.accelerates_and_drifts]
-- says = "the ego accelerates by {accel_mps2:.2f} m/s2 and drifts towards it at {drift_mps:.2f} m/s[, and is {gained_mps:.1f} m/s faster than before]"

-- @applies
-- If the lane beside is driven the other way, a vehicle that is beside the ego there and drives the ego's way is overtaking it, and so is a
-- vehicle that comes up there.
WITH near_object AS (
    SELECT drive_id, ego_id, t_ns, object_id, actor_class, side, along, ego_speed_mps, speed_mps FROM beside
    UNION ALL
    SELECT drive_id, ego_id, t_ns, object_id, actor_class, side, abs(heading_diff_rad) < pi() / 4 AS along, ego_speed_mps, speed_mps
    FROM neighbour
    WHERE gap_behind_m > 0 AND gap_behind_m <= $coming_s * (speed_mps - ego_speed_mps) AND abs(d_m) > half_width_m AND gap_m > 0
)
SELECT o.drive_id, o.ego_id, o.t_ns, o.object_id,
    o.along AND o.side = overtaking_side(m.handedness) AND coalesce(c.over_against, false) AND o.speed_mps > standing_mps()
        AND is_vehicle(o.actor_class) AND o.ego_speed_mps > $queue_mps AS applies
FROM near_object o
JOIN data_log g USING (drive_id)
JOIN environment m USING (environment_id)
LEFT JOIN ego_state e USING (drive_id, ego_id, t_ns)
LEFT JOIN ego_corridor c ON c.drive_id = o.drive_id AND c.ego_id = o.ego_id AND c.t_ns = o.t_ns AND c.chain_id = e.chain_id

-- @condition
WITH near_object AS (
    SELECT drive_id, ego_id, t_ns, object_id, along, ego_speed_mps, speed_mps, ego_lat_mps, true AS is_out FROM beside
    UNION ALL
    SELECT drive_id, ego_id, t_ns, object_id, abs(heading_diff_rad) < pi() / 4, ego_speed_mps, speed_mps, CASE side WHEN 'left' THEN ego_left_mps ELSE -ego_left_mps END,
        gap_behind_m <= $coming_s * (speed_mps - ego_speed_mps) AND abs(d_m) > half_width_m AND gap_m > 0
    FROM neighbour
    WHERE gap_behind_m > 0
),
-- The steps at which an object overtakes, or comes up to do so, numbered by stretches without a pause. An object that only follows does not
-- overtake.
overtaking_step AS (
    SELECT *, sum((t_ns - t_before_ns > 2_000_000_000)::INTEGER) OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY t_ns) AS stretch_no
    FROM (
        SELECT *, lag(t_ns, 1, t_ns) OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY t_ns) AS t_before_ns
        FROM near_object
        WHERE is_out AND along AND speed_mps > standing_mps() AND ego_speed_mps > $queue_mps
    )
),
speed_gain AS (
    SELECT drive_id, ego_id, object_id, t_ns, ego_speed_mps - min(ego_speed_mps) OVER (PARTITION BY drive_id, ego_id, object_id, stretch_no ORDER BY t_ns) AS gained_mps
    FROM overtaking_step
)
SELECT o.drive_id, o.ego_id, o.t_ns, o.object_id, m.accel_mps2 <= $accel_mps2 AND o.ego_lat_mps <= $drift_mps AND coalesce(g.gained_mps <= $gained_mps, true) AS holds,
    CASE WHEN m.accel_mps2 IS NOT NULL AND o.ego_lat_mps IS NOT NULL THEN why('accelerates_and_drifts', {
        'accel_mps2': m.accel_mps2, 'drift_mps': o.ego_lat_mps, 'gained_mps': CASE WHEN g.gained_mps > $gained_mps THEN g.gained_mps END
    }) END AS reason
FROM near_object o
LEFT JOIN ego_motion m USING (drive_id, ego_id, t_ns)
LEFT JOIN speed_gain g USING (drive_id, ego_id, t_ns, object_id)
