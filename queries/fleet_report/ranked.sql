-- Part of the statements of this folder: the drives with findings and their numbers, a touch of two egos once, the gravest and most findings first; `no` counts from 1.
SELECT c.*, row_number() OVER (ORDER BY c.critical DESC, c.major DESC, c.minor DESC, d.log, c.key) AS no
FROM (
    SELECT key, count(*) FILTER (severity = 'critical') AS critical, count(*) FILTER (severity = 'major') AS major,
        count(*) FILTER (severity = 'minor') AS minor, count(*) FILTER (n_stays < {least_share} * n_copies) AS possible
    FROM ({event}) GROUP BY key
) c JOIN counted_drives d ON d.key = c.key
