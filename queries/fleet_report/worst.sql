-- The drives with the gravest and most findings, each with the rules that it broke most often.
WITH counted AS (
    SELECT key, count(*) FILTER (severity = 'critical') AS critical, count(*) FILTER (severity = 'major') AS major,
        count(*) FILTER (severity = 'minor') AS minor, count(*) FILTER (n_stays < {least_share} * n_copies) AS possible
    FROM findings GROUP BY key
), worst AS (
    SELECT c.*, d.drive_id, d.log, d.file_name, d.map_name, d.km, d.duration_s, d.lossy, d.tags
    FROM counted c JOIN drives d ON d.key = c.key
    ORDER BY c.critical DESC, c.major DESC, c.minor DESC, d.log, c.key LIMIT $most
), broken AS (
    SELECT key, rule_id, count(*) AS n FROM findings SEMI JOIN worst USING (key) GROUP BY ALL
)
SELECT w.*, {options} AS options, b.rules
FROM worst w
JOIN (SELECT key, list({'rule_id': rule_id, 'n': n} ORDER BY n DESC, rule_id) AS rules FROM broken GROUP BY key) b ON b.key = w.key
LEFT JOIN receipts r ON r.key = w.key
ORDER BY w.critical DESC, w.major DESC, w.minor DESC, w.log, w.key
