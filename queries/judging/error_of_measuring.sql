-- Who was measured by the sensors of a recorder is known no more exactly than to some share, and no distance better than to a decimetre: a step that misses what is required by less
-- is not decided.
UPDATE _judged SET holds = NULL, code = 'within_error'
FROM data_log g CROSS JOIN _rule r
WHERE r.rule_no = _judged.rule_no AND r.sense <> 'holds' AND NOT _judged.holds AND _judged.drive_id = g.drive_id AND g.sensor_range_m IS NOT NULL
    AND abs(_judged.observed - _judged.required) <= greatest(measured_share() * abs(_judged.required), CASE WHEN r.unit = 'm' THEN measured_m() ELSE 0.0 END)
