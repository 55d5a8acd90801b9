-- The sums over all drives that have a receipt, each counted by itself. Only a whole audit counts each log once: see `fleet/totals.sql`.
SELECT
    count(*) AS n_drives,
    count(*) FILTER (status = 'judged') AS n_judged,
    count(*) FILTER (status = 'refused') AS n_refused,
    count(*) FILTER (status = 'quarantined') AS quarantined,
    count(DISTINCT content) FILTER (lossy) AS lossy,
    count(DISTINCT content) FILTER (off_map) AS off_map,
    coalesce(sum(round(km * 1e6)::HUGEINT), 0) / 1e6 AS km,
    coalesce(sum(round(duration_s * 1e6)::HUGEINT), 0) / 3.6e9 AS hours,
    coalesce(sum(unknown), 0)::BIGINT AS unknown,
    coalesce(sum(counts['error']), 0)::BIGINT AS errors,
    coalesce(sum(beyond_limits), 0)::BIGINT AS beyond_limits
FROM (SELECT *, coalesce(log_sha256, key) AS content FROM {of})
