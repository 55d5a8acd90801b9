-- The inputs ("signals") that rules may require, and whether each log and its map have them. If a rule requires an input without a row with
-- available = true, the rule is not run and its verdict is unknown.
-- lifetime: run
CREATE TABLE capability (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    signal VARCHAR NOT NULL,          -- [signal] an input that a rule may require
    available BOOLEAN NOT NULL,       -- the log and map provide it
    reason VARCHAR NOT NULL           -- why the signal is available or missing, as JSON from the macro why
);

INSERT INTO capability BY NAME
WITH ego_log AS (
    SELECT
        c.drive_id, c.ego_id, g.environment_id,
        coalesce((
            SELECT min(q.message) FROM quality q WHERE q.drive_id = c.drive_id AND q.check_id IN ('own_map_unusable', 'map_not_in_folder', 'lanes_without_width')
        ), why('no_map')) AS no_map_reason, g.has_indicator, g.has_brake_light,
        a.length_m IS NOT NULL AND a.width_m IS NOT NULL AS has_ego_size,
        NOT EXISTS (FROM quality q WHERE q.drive_id = c.drive_id AND q.check_id = 'assumed_motion') AS has_speeds,
        -- Headlights are recorded lamps. A log may have them even if the ego declares nothing about its observations or intentions.
        EXISTS (FROM declared_event d WHERE d.drive_id = c.drive_id AND d.actor_id = c.ego_id AND d.event <> 'headlights') AS has_events,
        EXISTS (FROM signal_state l WHERE l.drive_id = c.drive_id AND l.state IS NOT NULL) AS has_signals,
        EXISTS (FROM drive_condition x WHERE x.drive_id = c.drive_id AND x.condition = 'road_type') AS is_road_type_given,
        EXISTS (FROM drive_condition x WHERE x.drive_id = c.drive_id AND x.condition = 'engaged') AS is_engaged_given,
        -- A log has the actors around the ego, unless its format or its recorder's options show that not all were recorded.
        NOT EXISTS (FROM quality q WHERE q.drive_id = c.drive_id AND q.check_id IN ('no_road_users', 'road_users_left_out')) AS has_road_users,
        EXISTS (FROM quality q WHERE q.drive_id = c.drive_id AND q.check_id = 'road_users_left_out') AS has_some_road_users,
        EXISTS (FROM actor o WHERE o.drive_id = c.drive_id AND o.actor_id <> c.ego_id) AS has_others,
        EXISTS (FROM actor o WHERE o.drive_id = c.drive_id AND o.actor_id <> c.ego_id AND o.actor_class <> 'vehicle') AS has_classes,
        coalesce((SELECT min(q.message) FROM quality q WHERE q.drive_id = c.drive_id AND q.check_id = 'unmapped_class'), why('no_actor_classes')) AS no_classes_reason
    FROM clock c
    JOIN data_log g USING (drive_id)
    JOIN actor a ON a.drive_id = c.drive_id AND a.actor_id = c.ego_id
),
declared_mode AS (
    SELECT drive_id, ego_id, list(DISTINCT mode) AS modes FROM ego_mode GROUP BY ALL
),
map_content AS (
    SELECT
        e.environment_id, e.handedness, e.handedness_source,
        EXISTS (FROM lanelet n WHERE n.environment_id = e.environment_id AND n.lane_type IN ('sidewalk', 'walking', 'curb', 'border', 'shoulder')) AS has_lane_types,
        EXISTS (FROM lanelet n WHERE n.environment_id = e.environment_id AND n.drivable AND n.road_type IS NOT NULL) AS has_road_types,
        EXISTS (FROM lanelet n WHERE n.environment_id = e.environment_id AND n.junction_id IS NOT NULL) AS has_junctions,
        EXISTS (FROM lane_boundary b WHERE b.environment_id = e.environment_id AND b.marking IS NOT NULL) AS has_markings,
        EXISTS (FROM speed_limit v WHERE v.environment_id = e.environment_id AND v.source <> 'unread') AS has_speed_limits,
        EXISTS (FROM speed_limit v WHERE v.environment_id = e.environment_id AND v.source = 'unread') AS has_unread_limits,
        EXISTS (FROM traffic_signal t WHERE t.environment_id = e.environment_id AND t.kind = 'crossing') AS has_crossing_signs,
        EXISTS (FROM traffic_signal t WHERE t.environment_id = e.environment_id AND t.kind = 'traffic_light') AS has_traffic_lights,
        EXISTS (FROM stop_line t WHERE t.environment_id = e.environment_id) AS has_stop_lines,
        EXISTS (FROM crossing t WHERE t.environment_id = e.environment_id) AS has_crossings,
        EXISTS (FROM traffic_signal t WHERE t.environment_id = e.environment_id AND t.kind = 'exit') AS has_exit_signs,
        EXISTS (FROM _exit_lane x WHERE x.environment_id = e.environment_id) AS has_exits
    FROM environment e
),
-- Per signal: whether the map must have it, whether it is available, and the reason to state if it is available and if it is missing.
ego_input AS (
    SELECT s.drive_id, s.ego_id, s.environment_id, s.no_map_reason, unnest([
        {'signal': 'map', 'is_of_map': true, 'available': m.environment_id IS NOT NULL, 'reason_available': why('has_map', {'environment_id': m.environment_id}), 'reason_missing': NULL},
        {'signal': 'registration', 'is_of_map': false, 'available': r.ok, 'reason_available': r.reason, 'reason_missing': CASE WHEN s.environment_id IS NULL THEN s.no_map_reason ELSE coalesce(r.reason, why('ego_never_placed')) END},
        {'signal': 'way', 'is_of_map': false, 'available': CASE WHEN s.environment_id IS NULL THEN r.n_steps > 0 ELSE r.ok END,
            'reason_available': CASE WHEN s.environment_id IS NULL THEN why('has_own_way') ELSE r.reason END, 'reason_missing': coalesce(CASE WHEN s.environment_id IS NOT NULL THEN r.reason END, why('ego_never_placed'))},
        {'signal': 'handedness', 'is_of_map': true, 'available': m.handedness_source <> 'default',
            'reason_available': why('has_handedness', {'handedness': m.handedness, 'source': m.handedness_source}),
            'reason_missing': why('default_handedness', {'handedness': m.handedness})},
        {'signal': 'lane_types', 'is_of_map': true, 'available': m.has_lane_types, 'reason_available': why('has_lane_types'), 'reason_missing': why('no_lane_types')},
        {'signal': 'markings', 'is_of_map': true, 'available': m.has_markings, 'reason_available': why('has_markings'), 'reason_missing': why('no_markings')},
        {'signal': 'speed_limits', 'is_of_map': true, 'available': m.has_speed_limits, 'reason_available': why('has_speed_limits'), 'reason_missing': CASE WHEN m.has_unread_limits THEN why('unread_speed_limits') ELSE why('no_speed_limits') END},
        {'signal': 'road_types', 'is_of_map': NOT s.is_road_type_given, 'available': s.is_road_type_given OR m.has_road_types,
            'reason_available': CASE WHEN s.is_road_type_given THEN why('given_road_type') ELSE why('has_road_types') END,
            'reason_missing': why('no_road_types')},
        {'signal': 'junctions', 'is_of_map': true, 'available': m.has_junctions, 'reason_available': why('has_junctions'), 'reason_missing': why('no_junctions')},
        -- A map without junctions and crossings needs no traffic lights. A map without traffic lights needs no recorded states of lights.
        {'signal': 'traffic_lights', 'is_of_map': true, 'available': m.has_traffic_lights OR NOT (m.has_junctions OR m.has_crossings),
            'reason_available': CASE WHEN m.has_traffic_lights THEN why('has_traffic_lights') ELSE why('needs_no_lights') END,
            'reason_missing': why('no_traffic_lights')},
        {'signal': 'stop_lines', 'is_of_map': true, 'available': m.has_stop_lines, 'reason_available': why('has_stop_lines'), 'reason_missing': why('no_stop_lines')},
        {'signal': 'crossings', 'is_of_map': true, 'available': m.has_crossings, 'reason_available': why('has_crossings'), 'reason_missing': CASE WHEN m.has_crossing_signs THEN why('undrawn_crossings') ELSE why('no_crossings') END},
        -- Without exits the map needs no exit signs: the signal is available then.
        {'signal': 'exit_signs', 'is_of_map': true, 'available': m.has_exit_signs OR NOT m.has_exits,
            'reason_available': CASE WHEN m.has_exit_signs THEN why('has_exit_signs') ELSE why('no_exits') END, 'reason_missing': why('no_exit_signs')},
        {'signal': 'indicator', 'is_of_map': false, 'available': s.has_indicator, 'reason_available': why('has_indicator'), 'reason_missing': why('no_indicator')},
        {'signal': 'brake_light', 'is_of_map': false, 'available': s.has_brake_light, 'reason_available': why('has_brake_light'), 'reason_missing': why('no_brake_light')},
        {'signal': 'ego_size', 'is_of_map': false, 'available': s.has_ego_size, 'reason_available': why('has_ego_size'), 'reason_missing': why('no_ego_size')},
        {'signal': 'speeds', 'is_of_map': false, 'available': s.has_speeds, 'reason_available': why('has_speeds'), 'reason_missing': why('assumed_speeds')},
        {'signal': 'road_users', 'is_of_map': false, 'available': s.has_road_users, 'reason_available': why('has_road_users'), 'reason_missing': CASE WHEN s.has_some_road_users THEN why('road_users_left_out') ELSE why('no_road_users') END},
        -- A vehicle of unknown kind may be a bicycle. A log without other actors needs no classes.
        {'signal': 'actor_classes', 'is_of_map': false, 'available': s.has_classes OR NOT s.has_others,
            'reason_available': CASE WHEN s.has_others THEN why('has_actor_classes') ELSE why('nobody_else') END, 'reason_missing': s.no_classes_reason},
        {'signal': 'signals', 'is_of_map': false, 'available': s.has_signals OR NOT (m.has_traffic_lights OR m.has_junctions OR m.has_crossings),
            'reason_available': CASE WHEN s.has_signals THEN why('has_light_states') ELSE why('needs_no_lights') END, 'reason_missing': why('no_light_states')},
        {'signal': 'declared_events', 'is_of_map': false, 'available': s.has_events, 'reason_available': why('has_declared_events'), 'reason_missing': why('no_declared_events')},
        {'signal': 'modes', 'is_of_map': false, 'available': d.modes IS NOT NULL, 'reason_available': why('has_modes', {'modes': array_to_string(list_sort(d.modes), ', ')}),
            'reason_missing': why('no_modes')}
    ] || [
        {'signal': 'mode_' || mode, 'is_of_map': false, 'available': coalesce(list_contains(d.modes, mode), false) OR mode = 'engaged' AND s.is_engaged_given,
            'reason_available': CASE WHEN mode = 'engaged' AND s.is_engaged_given THEN why('given_engaged') ELSE why('has_mode', {'mode': mode}) END,
            'reason_missing': why(CASE mode WHEN 'headlights' THEN 'no_headlights' WHEN 'engaged' THEN 'no_engaged_mode' ELSE 'no_mode' END, {'mode': mode, 'name': replace(mode, '_', ' ')})}
        FOR mode IN ['engaged', 'emergency_manoeuvre', 'minimal_risk_manoeuvre', 'lane_change_procedure', 'headlights', 'horn']
    ], recursive := true)
    FROM ego_log s
    LEFT JOIN map_content m USING (environment_id)
    LEFT JOIN registration r USING (drive_id, ego_id)
    LEFT JOIN declared_mode d USING (drive_id, ego_id)
)
SELECT
    drive_id, ego_id, signal, coalesce(available, false) AS available,
    CASE WHEN available THEN reason_available WHEN is_of_map AND environment_id IS NULL THEN no_map_reason ELSE coalesce(reason_missing, no_map_reason) END AS reason
FROM ego_input
