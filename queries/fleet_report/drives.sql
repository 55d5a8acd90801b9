-- What the drives come to, logs of one content once. Way and time are those of the egos, as of rates; they are summed as whole micrometres and
-- microseconds, so that the order of summation does not matter.
WITH one AS (
    FROM drives QUALIFY row_number() OVER (PARTITION BY coalesce(sha256, key), status ORDER BY key) = 1
), ego AS (
    SELECT DISTINCT ON (content, ego_id) km, hours
    FROM (SELECT key, coalesce(sha256, key) AS content, unnest(exposure, recursive := true) FROM drives WHERE status = 'judged')
    ORDER BY content, ego_id, key
), way AS (
    SELECT count(*) AS egos, coalesce(sum(round(1e9 * km)::HUGEINT), 0) / 1e9 AS km,
        coalesce(sum(round(3.6e9 * hours)::HUGEINT), 0) / 3.6e9 AS hours FROM ego
)
SELECT count(*) AS drives, count(*) FILTER (status = 'judged') AS judged, count(*) FILTER (lossy) AS lossy,
    (SELECT count(*) FROM drives) - count(*) AS copies, (SELECT egos FROM way) AS egos, (SELECT km FROM way) AS km,
    (SELECT hours FROM way) AS hours
FROM one
