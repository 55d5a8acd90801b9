-- Failed verdicts of stable rules by severity.
SELECT e.key AS severity, sum(e.value)::BIGINT AS n
FROM (SELECT unnest(map_entries(failed)) AS e FROM {of})
GROUP BY ALL
ORDER BY severity
