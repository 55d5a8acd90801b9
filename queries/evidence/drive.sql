-- One row per log in the database, or per log in $only: map, distance, conditions, occasions judged, quality, what could not be judged, and when who was
-- recorded.
WITH
    exposure_of_egos AS (
        SELECT drive_id,
            list({'ego_id': ego_id, 'km': km, 'hours': hours, 'engaged_km': engaged_km, 'engaged_hours': engaged_hours,
                'n_steps': n_steps} ORDER BY ego_id) AS exposure
        FROM exposure WHERE coalesce(list_contains($only::VARCHAR[], drive_id), true) GROUP BY drive_id),
    applied AS (
        SELECT drive_id, rule_id, profile, count(*) AS n, count(*) FILTER (verdict IN ('pass', 'fail')) AS n_judged
        FROM verdict
        WHERE verdict <> 'not_applicable' AND coalesce(list_contains($only::VARCHAR[], drive_id), true) GROUP BY ALL),
    occasion AS (
        SELECT drive_id,
            list({'rule_id': rule_id, 'profile': profile, 'n': n, 'n_judged': n_judged}
                ORDER BY rule_id, profile NULLS FIRST) AS occasions
        FROM applied GROUP BY drive_id),
    defect AS (
        SELECT drive_id, check_id, severity, actor_id, n, t_first_ns, message,
            severity = 'error' OR list_contains($losses, check_id) AS loss
        FROM quality
        UNION ALL
        SELECT l.drive_id, m.check_id, m.severity, NULL, m.n, NULL,
            'map ' || e.name || coalesce(', ' || m.lanelet_id, '') || ': ' || m.message, false
        FROM data_log l JOIN map_quality m USING (environment_id) JOIN environment e USING (environment_id)
        UNION ALL
        SELECT drive_id, $aside_check, 'warning', ego_id, 1, NULL,
            format('{} keeps {:.2f} m beside the middle of its lane (median): is the map moved against the log? --map-offset puts it right',
                CASE WHEN ego_id = 'ego' THEN ego_id ELSE 'ego ' || ego_id END, lateral_median_m),
            false
        FROM registration WHERE ok AND is_aside),
    defects AS (
        SELECT drive_id, bool_or(loss) AS lossy,
            list({'check_id': check_id, 'severity': severity, 'actor_id': actor_id, 'n': n, 't_first_ns': t_first_ns,
                'message': message} ORDER BY check_id, actor_id NULLS FIRST, t_first_ns NULLS FIRST, message) AS quality
        FROM defect GROUP BY drive_id),
    conditions_of_drive AS (
        SELECT drive_id, list({'condition': condition, 'value': value, 'source': source} ORDER BY condition) AS conditions
        FROM drive_condition WHERE coalesce(list_contains($only::VARCHAR[], drive_id), true) GROUP BY drive_id),
    missing_signals AS (
        SELECT drive_id,
            list({'ego_id': ego_id, 'signal': signal, 'reason_code': cause_code, 'reason': words} ORDER BY ego_id, signal) AS not_judged
        FROM capability JOIN _worded ON cause = reason
        WHERE NOT available AND coalesce(list_contains($only::VARCHAR[], drive_id), true) GROUP BY drive_id),
    recorded_of_drive AS (
        SELECT drive_id, list({'actor_id': actor_id, 't_from_ns': t_from_ns, 't_to_ns': t_to_ns} ORDER BY actor_id, t_from_ns) AS recorded
        FROM recorded WHERE coalesce(list_contains($only::VARCHAR[], drive_id), true) GROUP BY drive_id)
SELECT l.drive_id, l.file_name, l.sha256, l.format, l.environment_id, e.name AS map_name, e.sha256 AS map_sha256,
    e.handedness, e.handedness_source, l.utc_start_ns, l.t_start_ns, (l.t_end_ns - l.t_start_ns) / 1e9 AS duration_s,
    l.lon, l.lat,
    coalesce(list_sum([x.km FOR x IN w.exposure]), 0.0::DOUBLE) AS km, l.n_states,
    coalesce(list_sum([x.n_steps FOR x IN w.exposure]), 0)::BIGINT AS n_steps, coalesce(len(w.exposure), 0) AS n_egos,
    'judged' AS status, NULL::VARCHAR AS status_reason, coalesce(d.lossy, false) AS lossy,
    coalesce(c.conditions, []) AS conditions,
    coalesce(w.exposure, []) AS exposure, coalesce(o.occasions, []) AS occasions, coalesce(d.quality, []) AS quality,
    coalesce(g.not_judged, []) AS not_judged, coalesce(r.recorded, []) AS recorded
FROM data_log l
LEFT JOIN environment e USING (environment_id)
LEFT JOIN exposure_of_egos w USING (drive_id)
LEFT JOIN occasion o USING (drive_id)
LEFT JOIN defects d USING (drive_id)
LEFT JOIN conditions_of_drive c USING (drive_id)
LEFT JOIN missing_signals g USING (drive_id)
LEFT JOIN recorded_of_drive r USING (drive_id)
WHERE coalesce(list_contains($only::VARCHAR[], l.drive_id), true)
ORDER BY l.drive_id
