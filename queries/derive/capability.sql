-- What each drive can be judged by; a rule whose `requires` is not here with available = true is unknown, before it runs.
WITH subject AS (
    SELECT c.drive_id, c.ego_id, g.environment_id, g.has_indicator, g.has_brake_light, a.length_m IS NOT NULL AND a.width_m IS NOT NULL AS ego_size
    FROM clock c
    JOIN data_log g USING (drive_id)
    JOIN actor a ON a.drive_id = c.drive_id AND a.actor_id = c.ego_id
),
map AS (
    SELECT
        e.environment_id, e.handedness, e.handedness_source,
        EXISTS (FROM lanelet n WHERE n.environment_id = e.environment_id AND n.lane_type IN ('sidewalk', 'walking', 'curb', 'border', 'shoulder')) AS lane_types,
        EXISTS (FROM lane_boundary b WHERE b.environment_id = e.environment_id AND b.marking IS NOT NULL) AS markings,
        EXISTS (FROM speed_limit v WHERE v.environment_id = e.environment_id) AS speed_limits,
        EXISTS (FROM traffic_signal t WHERE t.environment_id = e.environment_id AND t.kind = 'exit') AS exit_signs,
        EXISTS (FROM exit_lane x WHERE x.environment_id = e.environment_id) AS exits
    FROM environment e
),
answer AS (
    SELECT
        s.drive_id, s.ego_id, v.signal,
        CASE v.signal
            WHEN 'map' THEN m.environment_id IS NOT NULL
            WHEN 'registration' THEN r.ok
            WHEN 'handedness' THEN m.handedness_source <> 'default'
            WHEN 'lane_types' THEN m.lane_types
            WHEN 'markings' THEN m.markings
            WHEN 'speed_limits' THEN m.speed_limits
            -- without exits there is nothing to sign: then it is enough to know that
            WHEN 'exit_signs' THEN m.exit_signs OR NOT m.exits
            WHEN 'indicator' THEN s.has_indicator
            WHEN 'brake_light' THEN s.has_brake_light
            WHEN 'ego_size' THEN s.ego_size
        END AS available,
        CASE v.signal
            WHEN 'map' THEN coalesce('map ' || m.environment_id, 'no map: give one with --map')
            WHEN 'registration' THEN coalesce(r.reason, 'the ego has no position')
            WHEN 'handedness' THEN coalesce('side of the road (' || m.handedness || ') by ' || m.handedness_source, 'no map')
                || CASE WHEN m.handedness_source = 'default' THEN ': give it with --handedness' ELSE '' END
            WHEN 'lane_types' THEN CASE WHEN m.lane_types THEN 'the map has ways beside the carriageway' ELSE 'the map has no footway, kerb, border or shoulder' END
            WHEN 'markings' THEN CASE WHEN m.markings THEN 'the map has road markings' ELSE 'the map has no road markings' END
            WHEN 'speed_limits' THEN CASE WHEN m.speed_limits THEN 'the map has speed limits' ELSE 'the map has no speed limits' END
            WHEN 'exit_signs' THEN CASE WHEN m.exit_signs THEN 'the map has exit signs' WHEN m.exits THEN 'the map has exits, but no exit signs' ELSE 'the map has no exits' END
            WHEN 'indicator' THEN CASE WHEN s.has_indicator THEN 'the log has the ego''s indicators' ELSE 'the log has no indicators of the ego' END
            WHEN 'brake_light' THEN CASE WHEN s.has_brake_light THEN 'the log has the ego''s brake lights' ELSE 'the log has no brake lights of the ego' END
            WHEN 'ego_size' THEN CASE WHEN s.ego_size THEN 'the ego''s box is known' ELSE 'the ego''s length or width is not known' END
        END AS reason
    FROM subject s
    LEFT JOIN map m USING (environment_id)
    LEFT JOIN registration r USING (drive_id, ego_id)
    CROSS JOIN (VALUES ('map'), ('registration'), ('handedness'), ('lane_types'), ('markings'), ('speed_limits'), ('exit_signs'), ('indicator'), ('brake_light'), ('ego_size')) AS v(signal)
)
SELECT drive_id, ego_id, signal, coalesce(available, false) AS available, coalesce(reason, 'no map: give one with --map') AS reason FROM answer
