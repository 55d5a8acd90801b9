-- SELECTs, and behind the arrow the tables without whose rows each has none: one a line.
FROM a --> a
SELECT 1 --> nothing
SELECT * FROM (VALUES (1)) v --> nothing
SELECT * FROM range(3) --> nothing
SELECT unnest([1, 2]) FROM a --> a
SELECT a.x FROM a JOIN b USING (x) --> a b
SELECT a.x FROM a, b CROSS JOIN c --> a b c
SELECT a.x FROM a LEFT JOIN b USING (x) JOIN c USING (x) --> a c
SELECT a.x FROM a RIGHT JOIN b USING (x) -->  -- b, but we have no such join
SELECT a.x FROM a FULL JOIN b USING (x) --> nothing
SELECT a.x FROM a POSITIONAL JOIN b --> nothing
FROM a SEMI JOIN b USING (x) --> a b
FROM a ANTI JOIN (SELECT x + 1 AS x FROM b) USING (x) --> a
SELECT a.x FROM a ASOF JOIN b ON a.x >= b.x --> a b
SELECT a.x FROM a ASOF LEFT JOIN b ON a.x >= b.x --> a
SELECT x FROM a WHERE EXISTS (FROM b) --> a -- b too, which would only save time
SELECT x FROM a UNION ALL SELECT x FROM b --> nothing
SELECT x FROM a JOIN c USING (x) UNION ALL BY NAME SELECT x FROM b JOIN c USING (x) --> c
FROM a EXCEPT SELECT x + 1 FROM b -->  -- a
WITH w AS (SELECT a.x FROM a JOIN b USING (x)), v AS (FROM w) SELECT v.x FROM v LEFT JOIN c USING (x) --> a b
WITH a AS (FROM b) FROM a --> b
WITH b AS (FROM a) SELECT * FROM (WITH a AS (FROM c) FROM a JOIN b USING (x)) --> a c
WITH RECURSIVE w AS (SELECT x FROM a UNION ALL SELECT w.x + 1 FROM w, b WHERE w.x < 3) FROM w --> a
WITH RECURSIVE w AS (SELECT x FROM a UNION SELECT x FROM b) FROM w --> nothing
SELECT count(*) FROM a --> nothing
SELECT max(x) + 1 FROM a --> nothing
SELECT 1 FROM a HAVING count(*) >= 0 --> nothing
SELECT count(*) OVER () FROM a --> a
SELECT x, count(*) FROM a GROUP BY x --> a
SELECT count(*) FROM a GROUP BY x --> a
SELECT count(*) FROM a GROUP BY () --> nothing
SELECT count(*) FROM a GROUP BY ROLLUP (x) --> nothing
SELECT x, count(*) FROM a GROUP BY ALL --> a
SELECT count(*) FROM a GROUP BY ALL --> nothing
SELECT b.x FROM b JOIN (SELECT count(*) AS n FROM a) ON true --> b
SELECT DISTINCT x FROM a ORDER BY x LIMIT 1 --> a
WITH A AS (SELECT 7 AS x) FROM a --> nothing
WITH a AS (FROM b) FROM main.a --> a
SELECT x FROM B --> b
SELECT 1 FROM a HAVING true --> nothing
SELECT 1 FROM a ORDER BY count(*) --> nothing
SELECT DISTINCT ON (count(*)) 1 FROM a --> nothing
SELECT 1 FROM a QUALIFY row_number() OVER (ORDER BY count(*)) = 1 --> nothing
SELECT count(*) AS n, n FROM a GROUP BY ALL --> nothing
SELECT 5 AS k, k, count(*) FROM a GROUP BY ALL --> nothing
SELECT l.n FROM b, LATERAL (SELECT b.x, count(*) AS n FROM a GROUP BY ALL) l --> b
SELECT geomean(x) FROM a --> nothing
SELECT wavg(x, x) FROM a --> nothing
SELECT b.x FROM b JOIN (SELECT x, count(*) AS n FROM a GROUP BY x) USING (x) --> a b
