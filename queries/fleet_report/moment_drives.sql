-- The judged drives with findings that have a page, the worst first, with what judges them again.
SELECT p.no, p.key, d.drive_id, d.log, d.sha256, d.map_sha256, d.n_states, {options} AS options, list(f.finding_id ORDER BY f.finding_id) AS finding_ids
FROM page_drive p
JOIN drives d ON d.key = p.key
JOIN findings f ON f.key = p.key
LEFT JOIN receipts r ON r.key = p.key
WHERE d.status = 'judged' AND ($most_states IS NULL OR d.n_states <= $most_states)
GROUP BY ALL
ORDER BY p.no
LIMIT $most
