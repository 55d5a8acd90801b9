-- Number of verdicts of each kind.
SELECT verdict, count(*) AS n FROM {of}verdicts GROUP BY ALL ORDER BY ALL
