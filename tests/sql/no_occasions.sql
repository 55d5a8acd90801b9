-- SELECTs, and behind the arrow parts that do not tell that each has no rows.
WITH p AS (FROM a), q AS (FROM b) FROM p UNION ALL FROM q --> p
WITH p AS (FROM a) FROM b LEFT JOIN p USING (x) --> p
WITH p AS (FROM a) SELECT count(*) FROM p --> p
WITH p AS (FROM a) SELECT x FROM b WHERE NOT EXISTS (FROM p) --> p
WITH p AS (FROM a) SELECT * FROM (WITH p AS (FROM b) FROM p) JOIN a USING (x) --> p
WITH p AS (FROM a) FROM main.b --> p
FROM a --> p
