-- Per result of an audit: the key of the first result of its log, its number among them, and how many there are. A drive that could not be
-- judged stands only for others that could not.
CREATE OR REPLACE TEMP TABLE {counted}key AS
SELECT d.key, first_value(d.key) OVER same AS log_key, row_number() OVER same AS no,
    count(*) OVER (PARTITION BY coalesce(d.sha256, d.key), d.status) AS n
FROM {of}drives d
WINDOW same AS (PARTITION BY coalesce(d.sha256, d.key), d.status ORDER BY {first})
