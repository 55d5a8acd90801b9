-- What the drives of an audit come to, by its counted views. Distance and time are those of the egos, as of rates; `log_hours` is that of the logs.
-- They are summed as whole micrometres and microseconds, so that the order of summation does not matter.
WITH way AS (
    SELECT count(*) AS egos, coalesce(sum(round(1e9 * km)::HUGEINT), 0) / 1e9 AS km, coalesce(sum(round(3.6e9 * hours)::HUGEINT), 0) / 3.6e9 AS hours
    FROM (SELECT unnest(exposure, recursive := true) FROM counted_drives WHERE status = 'judged')
)
SELECT count(*) AS drives, count(*) FILTER (status = 'judged') AS judged, count(*) FILTER (lossy) AS lossy,
    (SELECT count(*) FROM drives) - count(*) AS copies,
    (SELECT count(*) FROM drives WHERE status <> 'judged') - count(*) FILTER (status <> 'judged') AS copies_not_judged, (SELECT egos FROM way) AS egos, (SELECT km FROM way) AS km,
    (SELECT hours FROM way) AS hours, coalesce(sum(round(duration_s * 1e6)::HUGEINT), 0) / 3.6e9 AS log_hours
FROM counted_drives
