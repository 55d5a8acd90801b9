-- The tags of judged drives and how many values each has.
SELECT tag, count(DISTINCT value) AS n_values
FROM (SELECT unnest(map_keys(tags)) AS tag, unnest(map_values(tags)) AS value FROM drives WHERE status = 'judged')
WHERE value IS NOT NULL
GROUP BY tag
ORDER BY tag
