-- What the drives come to. Way and time are summed as whole micrometres and microseconds, so that the order of summation does not matter.
SELECT count(*) AS drives, count(*) FILTER (status = 'judged') AS judged, count(*) FILTER (lossy) AS lossy,
    count(DISTINCT coalesce(sha256, key)) AS logs, coalesce(sum(n_egos), 0)::BIGINT AS egos,
    coalesce(sum(round(1e9 * km)::HUGEINT), 0) / 1e9 AS km, coalesce(sum(round(1e6 * duration_s)::HUGEINT), 0) / 3.6e9 AS hours
FROM {of}drives
