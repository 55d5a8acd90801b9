-- The drives that could not be judged.
SELECT key, log, status_reason FROM drives WHERE status <> 'judged' ORDER BY log, key LIMIT $most
