-- Why the verdicts of `_closed` are unknown that say only when something is not known: the ego, the object of the verdict or an actor nearby
-- has no place, or the ego is off the lanes. Where all say more, `no_cause.sql` makes the table, empty.
CREATE OR REPLACE TEMP TABLE _cause AS
WITH _unexplained_verdict AS (
    SELECT DISTINCT v.drive_id, v.ego_id, coalesce(s.start_ns, 0) AS start_ns, t_decides_ns AS t_ns, nullif(object_id, '') AS object_id,
        of_hidden, of_lanes
    FROM _closed v JOIN _rule r USING (rule_no) LEFT JOIN _subject s ON s.drive_id = v.drive_id AND s.ego_id = v.ego_id
    WHERE verdict = 'unknown' AND reason IS NULL AND tells_no_cause(code)
), _tracked AS (
    SELECT drive_id, ego_id, object_id, min(t_ns) AS from_ns, max(t_ns) AS to_ns
    FROM pair SEMI JOIN _unexplained_verdict d USING (drive_id, ego_id)
    GROUP BY ALL
), _nearest_hidden AS (
    SELECT drive_id, ego_id, t_ns, min({
        'm': h.lane_m, 'id': h.object_id,
        'code': coalesce(u.code, lack(p.off_level, p.x_m, p.y_m, p.yaw_rad, p.length_m, p.width_m), 'off_lanes'),
        'from_ns': k.from_ns, 'to_ns': k.to_ns
    }) AS nearest
    FROM (SELECT DISTINCT drive_id, ego_id, t_ns FROM _unexplained_verdict WHERE of_hidden)
    JOIN hidden h USING (drive_id, ego_id, t_ns)
    LEFT JOIN _unseen u USING (drive_id, ego_id, t_ns, object_id)
    LEFT JOIN _tracked k USING (drive_id, ego_id, object_id)
    LEFT JOIN pair p USING (drive_id, ego_id, t_ns, object_id)
    GROUP BY drive_id, ego_id, t_ns
), _speedless AS (
    -- a measure over some time needs every speed in that time
    SELECT DISTINCT d.drive_id, d.ego_id, d.t_ns
    FROM _unexplained_verdict d
    JOIN ego_state e ON e.drive_id = d.drive_id AND e.ego_id = d.ego_id AND e.speed_mps IS NULL
        AND e.t_ns >= d.t_ns - 1_000_000_000 AND e.t_ns <= d.t_ns + 1_000_000_000
), _ahead AS (
    -- the nearest actor in the lane ahead that is not known to be a vehicle
    SELECT drive_id, ego_id, t_ns, n.id AS object_id, n.actor_class AS actor_class
    FROM (
        SELECT drive_id, ego_id, t_ns, min({'s_m': p.rear_s_m, 'id': p.object_id, 'actor_class': p.actor_class}) AS n
        FROM (SELECT DISTINCT drive_id, ego_id, t_ns FROM _unexplained_verdict WHERE of_hidden AND of_lanes AND object_id IS NULL)
        JOIN ego_state e USING (drive_id, ego_id, t_ns)
        JOIN pair p USING (drive_id, ego_id, t_ns)
        WHERE is_vehicle(p.actor_class) IS DISTINCT FROM true AND in_lane(p.d_m, p.lat_half_m, p.half_width_m) AND p.front_s_m > e.rear_s_m
        GROUP BY drive_id, ego_id, t_ns
    )
)
    SELECT {'drive_id': d.drive_id, 'ego_id': d.ego_id, 't_ns': d.t_ns, 'object_id': coalesce(d.object_id, ''),
        'of_hidden': d.of_hidden, 'of_lanes': d.of_lanes} AS key,
        lack(p.off_level, p.x_m, p.y_m, p.yaw_rad, p.length_m, p.width_m) AS lack, CASE
        WHEN e.x_m + e.y_m + e.yaw_rad IS NULL THEN ego_lacks(e.x_m + e.y_m, e.yaw_rad, e.lanelet_id, e.front_s_m)
        WHEN p.off_level THEN why('object_off_level', {'object_id': p.object_id, 'z_m': h.z_m, 'ego_z_m': e.z_m})
        WHEN p.object_id IS NOT NULL AND lack IS NOT NULL THEN why('object_lacks', {'object_id': p.object_id, 'lack': lack})
        WHEN p.object_id IS NULL AND o.to_ns < d.t_ns THEN why('track_ends', {'object_id': d.object_id, 't_ns': o.to_ns})
        WHEN p.object_id IS NULL AND o.from_ns > d.t_ns THEN why('track_begins', {'object_id': d.object_id, 't_ns': o.from_ns})
        -- a rule without object_id looks for the object itself, so the verdict does not say which object is meant
        WHEN n.nearest IS NOT NULL AND d.of_hidden AND d.object_id IS NULL THEN hidden_reason(n.nearest)
        WHEN e.speed_mps IS NULL THEN why(CASE WHEN c.drive_id IS NULL THEN 'ego_speed_unknown' ELSE 'ego_speed_contradicted' END)
        WHEN p.object_id IS NOT NULL AND p.speed_mps IS NULL
            THEN why(CASE WHEN c.drive_id IS NULL THEN 'object_speed_unknown' ELSE 'object_speed_contradicted' END,
                {'object_id': p.object_id})
        WHEN p.object_id IS NOT NULL AND p.actor_class IS NULL THEN why('object_class_unknown', {'object_id': p.object_id})
        WHEN n.nearest IS NOT NULL AND d.of_hidden THEN hidden_reason(n.nearest)
        WHEN d.of_lanes AND (e.lanelet_id IS NULL AND (g.environment_id IS NOT NULL OR e.chain_id IS NULL) OR e.front_s_m IS NULL) THEN ego_lacks(e.x_m, e.yaw_rad, e.lanelet_id, e.front_s_m)
        WHEN d.of_lanes AND p.object_id IS NOT NULL AND p.s_m IS NULL THEN why('object_off_lanes', {'object_id': p.object_id})
        WHEN d.of_hidden AND d.of_lanes AND d.object_id IS NULL AND f.object_id IS NOT NULL
            THEN why(CASE WHEN f.actor_class IS NULL THEN 'may_be_vehicle_ahead' ELSE 'no_vehicle_ahead' END, {'object_id': f.object_id})
        WHEN b.drive_id IS NOT NULL
            THEN why(CASE WHEN c.drive_id IS NULL THEN 'ego_speed_unknown_near' ELSE 'ego_speed_contradicted_near' END) END AS because
    FROM _unexplained_verdict d
    LEFT JOIN data_log g USING (drive_id)
    LEFT JOIN ego_state e USING (drive_id, ego_id, t_ns)
    LEFT JOIN pair p USING (drive_id, ego_id, t_ns, object_id)
    LEFT JOIN state_dynamics h ON h.drive_id = d.drive_id AND h.actor_id = CASE WHEN p.off_level THEN d.object_id END AND h.t_ns = d.t_ns
    LEFT JOIN _nearest_hidden n USING (drive_id, ego_id, t_ns)
    LEFT JOIN _speedless b USING (drive_id, ego_id, t_ns)
    LEFT JOIN _ahead f USING (drive_id, ego_id, t_ns)
    LEFT JOIN _tracked o USING (drive_id, ego_id, object_id)
    LEFT JOIN (SELECT DISTINCT drive_id FROM quality WHERE check_id = 'velocity_unknown') c USING (drive_id)
