-- Results of logs that have another result before, which stands for them where a log counts once, and whether both were judged by the same options.
SELECT d.log, o.log AS other, r.options = f.options AS same_options
FROM counted_key k
JOIN drives d ON d.key = k.key
JOIN drives o ON o.key = k.log_key
JOIN receipts r ON r.key = k.key
JOIN receipts f ON f.key = k.log_key
WHERE k.no > 1
ORDER BY d.log, other, k.no
LIMIT $most
