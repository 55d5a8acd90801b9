-- Number of verdicts by what they are and what they become.
SELECT profile, tag_value, was, becomes, count(*) AS n FROM what_if GROUP BY ALL ORDER BY ALL NULLS FIRST
