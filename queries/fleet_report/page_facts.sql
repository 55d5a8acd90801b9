-- The facts of each drive that has a page. `same_content` counts the other logs of the audit that have the same bytes.
CREATE OR REPLACE TEMP TABLE page_facts AS
WITH content AS (
    SELECT sha256, count(*) AS n FROM drives WHERE sha256 IS NOT NULL GROUP BY sha256
)
SELECT p.no, p.key, d.drive_id, d.log, d.format, d.sha256, d.map_name, d.map_sha256, d.handedness, d.utc_start_ns, d.t_start_ns, d.duration_s, d.lon, d.lat,
    d.km, d.n_states, d.n_steps, d.n_egos, d.status, d.status_reason, d.lossy, d.conditions, d.quality, d.not_judged, d.tags,
    {options} AS options, coalesce(c.n - 1, 0) AS same_content
FROM page_drive p
JOIN drives d ON d.key = p.key
LEFT JOIN receipts r ON r.key = p.key
LEFT JOIN content c ON c.sha256 = d.sha256
ORDER BY p.no
