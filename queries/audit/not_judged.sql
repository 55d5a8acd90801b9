-- Drives that were not judged, logs of one content once, and why; those with one reason together.
SELECT min(log) AS log, status, reason, count(*) AS n
FROM (
    FROM receipts WHERE status <> 'judged' QUALIFY row_number() OVER (PARTITION BY coalesce(log_sha256, key) ORDER BY status, log, key) = 1
)
GROUP BY ALL
ORDER BY n DESC, log, status, reason
