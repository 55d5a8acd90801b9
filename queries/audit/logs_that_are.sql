-- The logs of which the receipt says this; of logs of one content the first.
SELECT min(log) AS log FROM receipts WHERE {what} GROUP BY coalesce(log_sha256, key) ORDER BY log
