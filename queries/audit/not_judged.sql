-- Drives that were not judged, and why.
SELECT log, status, reason FROM receipts WHERE status <> 'judged' ORDER BY log, key
