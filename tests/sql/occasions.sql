-- SELECTs, and behind the arrow the parts without whose rows each has none.
WITH p AS (FROM a) FROM p --> p
WITH p AS (FROM a), q AS (FROM b) FROM p UNION ALL FROM q --> p q
WITH p AS (FROM a), q AS (SELECT * FROM p LEFT JOIN b USING (x)) SELECT x, count(*) AS n FROM q GROUP BY x --> p
WITH p AS (FROM a) FROM b SEMI JOIN p USING (x) --> p
