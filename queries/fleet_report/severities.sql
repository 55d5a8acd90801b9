-- Findings by severity, the drives that have them, and how many of the findings are only possible.
SELECT severity, count(*) AS findings, count(DISTINCT key) AS drives, count(*) FILTER (n_stays < {least_share} * n_copies) AS possible
FROM findings GROUP BY ALL ORDER BY ALL
