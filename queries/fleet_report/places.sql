-- The places with most findings, of about 100 m: in how many drives, of which rules.
WITH placed AS (
    SELECT round(lat, 3) AS lat, round(lon, 3) AS lon, key, rule_id, severity FROM counted_findings WHERE lon IS NOT NULL AND lat IS NOT NULL
), counted AS (
    SELECT lat, lon, count(*) AS n, count(*) FILTER (severity = 'critical') AS critical, count(DISTINCT key) AS drives
    FROM placed GROUP BY ALL ORDER BY n DESC, critical DESC, lat, lon LIMIT $most
), broken AS (
    SELECT lat, lon, rule_id, count(*) AS n FROM placed SEMI JOIN counted USING (lat, lon) GROUP BY ALL
)
SELECT c.*, b.rules
FROM counted c
JOIN (SELECT lat, lon, list({'rule_id': rule_id, 'n': n} ORDER BY n DESC, rule_id) AS rules FROM broken GROUP BY ALL) b USING (lat, lon)
ORDER BY c.n DESC, c.critical DESC, c.lat, c.lon
