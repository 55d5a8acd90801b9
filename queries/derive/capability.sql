-- What each drive can be judged by; a rule whose `requires` is not here with available = true is unknown, before it runs.
WITH subject AS (
    SELECT
        c.drive_id, c.ego_id, g.environment_id,
        coalesce((
            SELECT min(q.message) FROM quality q WHERE q.drive_id = c.drive_id AND q.check_id IN ('own_map_unusable', 'lanes_without_width')
        ), 'no map: give one with --map') AS no_map, g.has_indicator, g.has_brake_light,
        a.length_m IS NOT NULL AND a.width_m IS NOT NULL AS ego_size,
        NOT EXISTS (FROM quality q WHERE q.drive_id = c.drive_id AND q.check_id = 'assumed_motion') AS speeds,
        -- a log may record lamps without anything that the ego declares of what it looks at or means to do
        EXISTS (FROM declared_event d WHERE d.drive_id = c.drive_id AND d.actor_id = c.ego_id AND d.event <> 'headlights') AS events,
        EXISTS (FROM signal_state l WHERE l.drive_id = c.drive_id AND l.state IS NOT NULL) AS signals,
        EXISTS (FROM drive_condition x WHERE x.drive_id = c.drive_id AND x.condition = 'road_type') AS road_type_given,
        EXISTS (FROM drive_condition x WHERE x.drive_id = c.drive_id AND x.condition = 'engaged') AS engaged_given,
        EXISTS (FROM actor o WHERE o.drive_id = c.drive_id AND o.actor_id <> c.ego_id) AS others,
        EXISTS (FROM actor o WHERE o.drive_id = c.drive_id AND o.actor_id <> c.ego_id AND o.actor_class <> 'vehicle') AS classes
    FROM clock c
    JOIN data_log g USING (drive_id)
    JOIN actor a ON a.drive_id = c.drive_id AND a.actor_id = c.ego_id
),
declared AS (
    SELECT drive_id, ego_id, list(DISTINCT mode) AS modes FROM ego_mode GROUP BY ALL
),
map AS (
    SELECT
        e.environment_id, e.handedness, e.handedness_source,
        EXISTS (FROM lanelet n WHERE n.environment_id = e.environment_id AND n.lane_type IN ('sidewalk', 'walking', 'curb', 'border', 'shoulder')) AS lane_types,
        EXISTS (FROM lanelet n WHERE n.environment_id = e.environment_id AND n.drivable AND n.road_type IS NOT NULL) AS road_types,
        EXISTS (FROM lanelet n WHERE n.environment_id = e.environment_id AND n.junction_id IS NOT NULL) AS junctions,
        EXISTS (FROM lane_boundary b WHERE b.environment_id = e.environment_id AND b.marking IS NOT NULL) AS markings,
        EXISTS (FROM speed_limit v WHERE v.environment_id = e.environment_id AND v.source <> 'unread') AS speed_limits,
        EXISTS (FROM speed_limit v WHERE v.environment_id = e.environment_id AND v.source = 'unread') AS unread_limits,
        EXISTS (FROM traffic_signal t WHERE t.environment_id = e.environment_id AND t.kind = 'crossing') AS crossing_signs,
        EXISTS (FROM traffic_signal t WHERE t.environment_id = e.environment_id AND t.kind = 'traffic_light') AS traffic_lights,
        EXISTS (FROM stop_line t WHERE t.environment_id = e.environment_id) AS stop_lines,
        EXISTS (FROM crossing t WHERE t.environment_id = e.environment_id) AS crossings,
        EXISTS (FROM traffic_signal t WHERE t.environment_id = e.environment_id AND t.kind = 'exit') AS exit_signs,
        EXISTS (FROM exit_lane x WHERE x.environment_id = e.environment_id) AS exits
    FROM environment e
),
-- per signal: whether it is there, whether the map must give it, and what to say where it is and where it is not
answer AS (
    SELECT s.drive_id, s.ego_id, s.environment_id, s.no_map, unnest([
        {'signal': 'map', 'of_map': true, 'available': m.environment_id IS NOT NULL, 'yes': 'map ' || m.environment_id, 'no': NULL},
        {'signal': 'registration', 'of_map': false, 'available': r.ok, 'yes': r.reason, 'no': CASE WHEN s.environment_id IS NULL THEN s.no_map ELSE coalesce(r.reason, 'the ego has no position') END},
        {'signal': 'handedness', 'of_map': true, 'available': m.handedness_source <> 'default',
            'yes': 'side of the road (' || m.handedness || ') by ' || m.handedness_source,
            'no': 'side of the road (' || m.handedness || ') by ' || m.handedness_source || ': give it with --handedness'},
        {'signal': 'lane_types', 'of_map': true, 'available': m.lane_types, 'yes': 'the map has ways beside the carriageway', 'no': 'the map has no footway, kerb, border or shoulder'},
        {'signal': 'markings', 'of_map': true, 'available': m.markings, 'yes': 'the map has road markings', 'no': 'the map has no road markings'},
        {'signal': 'speed_limits', 'of_map': true, 'available': m.speed_limits, 'yes': 'the map has speed limits', 'no': CASE WHEN m.unread_limits THEN 'the map''s speed limits cannot be read' ELSE 'the map has no speed limits' END},
        {'signal': 'road_types', 'of_map': NOT s.road_type_given, 'available': s.road_type_given OR m.road_types,
            'yes': CASE WHEN s.road_type_given THEN 'the road type is given' ELSE 'the map has road types' END,
            'no': 'the map has no road types: give one that has, or --env road_type=...'},
        {'signal': 'junctions', 'of_map': true, 'available': m.junctions, 'yes': 'the map has junctions', 'no': 'the map has no junctions: give one that has'},
        -- where no ways meet, there is nothing to light; and where nothing is lit, nothing to record
        {'signal': 'traffic_lights', 'of_map': true, 'available': m.traffic_lights OR NOT (m.junctions OR m.crossings),
            'yes': CASE WHEN m.traffic_lights THEN 'the map has traffic lights' ELSE 'the map has neither junctions nor crossings' END,
            'no': 'the map has junctions or crossings and no traffic lights: give one that has'},
        {'signal': 'stop_lines', 'of_map': true, 'available': m.stop_lines, 'yes': 'the map has stop lines', 'no': 'the map has no stop lines: give one that has'},
        {'signal': 'crossings', 'of_map': true, 'available': m.crossings, 'yes': 'the map has pedestrian crossings', 'no': CASE WHEN m.crossing_signs THEN 'the map signs pedestrian crossings and does not draw them: give one that does' ELSE 'the map has no pedestrian crossings: give one that has' END},
        -- without exits there is nothing to sign: then it is enough to know that
        {'signal': 'exit_signs', 'of_map': true, 'available': m.exit_signs OR NOT m.exits,
            'yes': CASE WHEN m.exit_signs THEN 'the map has exit signs' ELSE 'the map has no exits' END, 'no': 'the map has exits, but no exit signs'},
        {'signal': 'indicator', 'of_map': false, 'available': s.has_indicator, 'yes': 'the log has the ego''s indicators', 'no': 'the log has no indicators of the ego'},
        {'signal': 'brake_light', 'of_map': false, 'available': s.has_brake_light, 'yes': 'the log has the ego''s brake lights', 'no': 'the log has no brake lights of the ego'},
        {'signal': 'ego_size', 'of_map': false, 'available': s.ego_size, 'yes': 'the ego''s box is known', 'no': 'the ego''s length or width is not known'},
        {'signal': 'speeds', 'of_map': false, 'available': s.speeds, 'yes': 'speeds are recorded, or follow from the positions', 'no': 'the mapping assumes the speeds: give a log that has them'},
        -- a vehicle of no kind may be a bicycle; where nobody else is, there is nobody to know the class of
        {'signal': 'actor_classes', 'of_map': false, 'available': s.classes OR NOT s.others,
            'yes': CASE WHEN s.others THEN 'the log says what the others are' ELSE 'nobody else is in the log' END, 'no': 'the log does not say what the others are: give their classes'},
        {'signal': 'signals', 'of_map': false, 'available': s.signals OR NOT (m.traffic_lights OR m.junctions OR m.crossings),
            'yes': CASE WHEN s.signals THEN 'the log has the states of traffic lights' ELSE 'the map has neither junctions nor crossings' END, 'no': 'the log has no states of traffic lights: record them'},
        {'signal': 'declared_events', 'of_map': false, 'available': s.events, 'yes': 'the log has events that the ego declares', 'no': 'the ego declares no events in the log: record them'},
        {'signal': 'modes', 'of_map': false, 'available': d.modes IS NOT NULL, 'yes': 'the log says when the ego''s modes are on: ' || array_to_string(list_sort(d.modes), ', '),
            'no': 'the log declares no modes of the ego: record them as events that are on and off'}
    ] || [
        {'signal': 'mode_' || mode, 'of_map': false, 'available': coalesce(list_contains(d.modes, mode), false) OR mode = 'engaged' AND s.engaged_given,
            'yes': CASE WHEN mode = 'engaged' AND s.engaged_given THEN 'whether the automated driver drives is given' ELSE 'the log says when ' || mode || ' is on' END,
            'no': 'the log does not tell about ' || replace(mode, '_', ' ') || ': record the event ' || mode || ', on and off' || CASE WHEN mode = 'engaged' THEN ', or give --env engaged=yes or no' ELSE '' END}
        FOR mode IN ['engaged', 'emergency_manoeuvre', 'minimal_risk_manoeuvre', 'lane_change_procedure', 'headlights', 'horn']
    ], recursive := true)
    FROM subject s
    LEFT JOIN map m USING (environment_id)
    LEFT JOIN registration r USING (drive_id, ego_id)
    LEFT JOIN declared d USING (drive_id, ego_id)
)
SELECT
    drive_id, ego_id, signal, coalesce(available, false) AS available,
    CASE WHEN available THEN yes WHEN of_map AND environment_id IS NULL THEN no_map ELSE coalesce(no, no_map) END AS reason
FROM answer
