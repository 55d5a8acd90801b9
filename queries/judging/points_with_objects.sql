    -- part of `judged_of_references.sql`: each point with each object present at it, and with each lost object that could still be there
    -- (`lost`: why). An anchor without a time is unknown, whatever objects there are. A point without objects has a row only if objects are
    -- combined.
    SELECT p.* REPLACE (q.object_id AS object_id), q.object_id IS NULL AND p.t_ns IS NOT NULL AS nobody,
        s.sensor_range_m, NULL::VARCHAR AS lost
    FROM reference_step p JOIN _subject s ON s.drive_id = p.drive_id AND s.ego_id = p.ego_id
    LEFT JOIN pair q ON q.drive_id = p.drive_id AND q.ego_id = p.ego_id AND q.t_ns = p.t_ns
    WHERE $_combined OR q.object_id IS NOT NULL OR p.t_ns IS NULL
    UNION ALL BY NAME
    SELECT p.* REPLACE (l.object_id AS object_id), false AS nobody, NULL::DOUBLE AS sensor_range_m, min(l.code) AS lost
    FROM reference_step p JOIN lost_object l ON l.drive_id = p.drive_id AND l.ego_id = p.ego_id
        AND p.t_ns >= l.t_from_ns AND p.t_ns <= l.t_to_ns
    ANTI JOIN pair q ON q.drive_id = p.drive_id AND q.ego_id = p.ego_id AND q.t_ns = p.t_ns AND q.object_id = l.object_id
    GROUP BY ALL
