-- The rows of a table of an audit, each row that logs of one content share only once.
CREATE OR REPLACE TEMP VIEW counted_{table} AS
WITH content AS (
    SELECT key, coalesce(sha256, key) AS content, count(*) OVER (PARTITION BY coalesce(sha256, key)) AS n FROM drives WHERE status = 'judged'
)
SELECT t.* FROM {table} t SEMI JOIN (FROM content WHERE n = 1) c ON c.key = t.key
UNION ALL
SELECT t.* FROM {table} t JOIN content c ON c.key = t.key AND c.n > 1
QUALIFY row_number() OVER (PARTITION BY c.content, {columns} ORDER BY t.key) = 1
