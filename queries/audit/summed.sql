-- What all drives that have a receipt come to.
SELECT
    count(*) AS n_drives,
    count(*) FILTER (status = 'judged') AS judged,
    count(*) FILTER (status = 'refused') AS refused,
    count(*) FILTER (status = 'quarantined') AS quarantined,
    count(*) FILTER (lossy) AS lossy,
    count(*) FILTER (off_map) AS off_map,
    count(log_sha256) FILTER (status = 'judged') - count(DISTINCT log_sha256) FILTER (status = 'judged') AS copies,
    coalesce(sum(round(km * 1e6)::HUGEINT), 0) / 1e6 AS km,
    coalesce(sum(round(duration_s * 1e6)::HUGEINT), 0) / 3.6e9 AS hours,
    coalesce(sum(unknown), 0)::BIGINT AS unknown,
    coalesce(sum(counts['error']), 0)::BIGINT AS errors
FROM {of}
