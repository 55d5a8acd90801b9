-- What all drives that have a receipt come to. Of logs of one content, one counts for way and time.
SELECT
    count(*) AS n_drives,
    count(*) FILTER (status = 'judged') AS judged,
    count(*) FILTER (status = 'refused') AS refused,
    count(*) FILTER (status = 'quarantined') AS quarantined,
    count(DISTINCT content) FILTER (lossy) AS lossy,
    count(DISTINCT content) FILTER (off_map) AS off_map,
    count(*) FILTER (NOT is_first) AS copies,
    coalesce(sum(round(km * 1e6)::HUGEINT) FILTER (is_first), 0) / 1e6 AS km,
    coalesce(sum(round(duration_s * 1e6)::HUGEINT) FILTER (is_first), 0) / 3.6e9 AS hours,
    coalesce(sum(unknown), 0)::BIGINT AS unknown,
    coalesce(sum(counts['error']), 0)::BIGINT AS errors
FROM (
    SELECT *, coalesce(log_sha256, key) AS content, status <> 'judged' OR row_number() OVER (PARTITION BY content, status ORDER BY key) = 1 AS is_first
    FROM {of}
)
