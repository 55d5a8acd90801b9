-- The values of a tag that most drives have, one row for those without a value, and how many values there are in all.
CREATE OR REPLACE TEMP TABLE shown_value AS
SELECT tag_value, n, count(tag_value) OVER () AS n_values
FROM (SELECT {value} AS tag_value, count(*) AS n FROM drives d GROUP BY ALL)
QUALIFY tag_value IS NULL OR row_number() OVER (PARTITION BY tag_value IS NULL ORDER BY n DESC, tag_value) <= $most
