-- Drives that were not judged, and why; those with one reason together.
SELECT min(log) AS log, status, reason, count(*) AS n FROM receipts WHERE status <> 'judged' GROUP BY ALL ORDER BY n DESC, log, status, reason
