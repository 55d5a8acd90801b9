-- Findings by severity, and how many of them are only possible; a touch of two egos counts once.
SELECT severity, count(*) AS findings, count(*) FILTER (is_possible) AS possible FROM ({event}) GROUP BY ALL ORDER BY ALL
