-- The findings on a grid of $cell degrees of latitude, cells with most findings first. `rank` is that of the gravest one there.
SELECT floor((lon - $west) * $stretch / $cell)::INTEGER AS column_no, floor(($north - lat) / $cell)::INTEGER AS row_no,
    count(*) AS n, min(list_position(['critical', 'major', 'minor'], severity)) AS rank
FROM counted_findings WHERE lon IS NOT NULL AND lat IS NOT NULL
GROUP BY ALL ORDER BY n DESC, row_no, column_no LIMIT $most
