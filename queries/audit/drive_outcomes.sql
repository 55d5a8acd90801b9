-- What each drive came to: its verdicts by kind, and their worst. A drive that was not judged, was lossy or is off its map has passed nothing.
WITH counted AS (
    SELECT
        key,
        count(*) FILTER (verdict = 'fail') AS n_fail,
        count(*) FILTER (verdict = 'error') AS n_error,
        count(*) FILTER (verdict = 'unknown') AS n_unknown,
        count(*) FILTER (near_miss) AS n_near_miss,
        count(*) FILTER (verdict = 'pass') AS n_pass,
        count(*) FILTER (verdict = 'not_applicable') AS n_not_applicable
    FROM verdicts
    GROUP BY key
)
SELECT
    r.drive_id, r.key, d.file_name AS log, r.log_sha256, d.map_name AS map, r.map_sha256, r.status, r.reason, r.lossy, r.rows_sha256,
    coalesce(c.n_fail, 0) AS n_fail, coalesce(c.n_error, 0) AS n_error, coalesce(c.n_unknown, 0) AS n_unknown,
    coalesce(c.n_near_miss, 0) AS n_near_miss, coalesce(c.n_pass, 0) AS n_pass, coalesce(c.n_not_applicable, 0) AS n_not_applicable,
    CASE
        WHEN c.n_fail > 0 THEN 'fail'
        WHEN r.status <> 'judged' OR r.lossy OR c.n_error > 0 OR c.n_unknown > 0
            OR list_has_any([x.reason_code FOR x IN d.not_judged], $misfits) THEN 'unknown'
        WHEN c.n_near_miss > 0 THEN 'near_miss'
        WHEN c.n_pass > 0 THEN 'pass'
    END AS outcome
FROM receipts r
LEFT JOIN drives d USING (key)
LEFT JOIN counted c USING (key)
ORDER BY r.drive_id, r.key
