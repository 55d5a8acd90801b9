-- The rows of a table of an audit, each row that results of one log share only once.
CREATE OR REPLACE TEMP VIEW {counted}{table} AS
SELECT t.* REPLACE (k.log_key AS key), t.key AS result_key FROM {of}{table} t JOIN {counted}key k ON k.key = t.key AND k.n = 1
UNION ALL
SELECT t.* REPLACE (k.log_key AS key), t.key AS result_key FROM {of}{table} t JOIN {counted}key k ON k.key = t.key AND k.n > 1
QUALIFY row_number() OVER (PARTITION BY k.log_key, {same} ORDER BY k.no) = 1
