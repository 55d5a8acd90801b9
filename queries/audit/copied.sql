-- Judged results of logs that have another result before, which stands for them where a log counts once.
SELECT d.log, o.log AS other
FROM counted_key k
JOIN drives d ON d.key = k.key
JOIN drives o ON o.key = k.log_key
WHERE k.no > 1
ORDER BY d.log, other
LIMIT $most
