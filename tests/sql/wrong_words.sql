-- SELECTs that ask for an actor of the class 'cyclist', which does not exist: one a line.
-- compared
SELECT actor_class = 'cyclist' FROM pair
SELECT 'cyclist' <> p.actor_class FROM pair p
SELECT actor_class IS DISTINCT FROM 'cyclist' FROM pair
SELECT ACTOR_CLASS = 'cyclist' FROM Pair
SELECT actor_class IN ('car', 'cyclist') FROM pair
SELECT actor_class NOT IN ('cyclist') FROM pair
SELECT actor_class IN ['car', 'cyclist'] FROM pair
SELECT actor_class = ANY(['car', 'cyclist']) FROM pair
SELECT actor_class IN (SELECT * FROM (VALUES ('car'), ('cyclist'))) FROM pair
SELECT CASE actor_class WHEN 'cyclist' THEN 1 ELSE 2 END AS x FROM pair
SELECT nullif(actor_class, 'cyclist') FROM pair
SELECT list_contains(['car', 'cyclist'], actor_class) FROM pair
SELECT list_contains(list(actor_class), 'cyclist') FROM pair
SELECT ['cyclist'] && list(actor_class) FROM pair
SELECT list_filter(list(actor_class), lambda each: each = 'cyclist') FROM pair
SELECT [each FOR each IN list(actor_class) IF each = 'cyclist'] FROM pair
SELECT actor_class LIKE 'cyclist%' FROM pair
SELECT starts_with(actor_class, 'cyclist') FROM pair
-- given to a macro
SELECT is_class(actor_class, 'cyclist') FROM pair
SELECT is_class(p.actor_class, CASE WHEN p.off_level THEN 'car' ELSE 'cyclist' END) FROM pair p
SELECT is_class(lower(actor_class), 'cyclist') FROM pair
-- read under another name, or through a function
WITH seen AS (SELECT actor_class AS kind FROM pair) SELECT s.kind = 'cyclist' FROM seen s
WITH a(kind) AS (SELECT actor_class FROM pair), b AS (FROM a) SELECT kind = 'cyclist' FROM b
SELECT k = 'cyclist' FROM (SELECT actor_class AS k FROM pair)
SELECT actor_class AS k, k = 'cyclist' AS is_one FROM pair
SELECT x.k = 'cyclist' FROM (SELECT * EXCLUDE (x_m) REPLACE (actor_class AS object_id) FROM pair) AS x(a, b, c, k)
SELECT k = 'cyclist' FROM (SELECT actor_class AS k FROM pair UNION ALL SELECT actor_class FROM actor)
SELECT actor_class = 'cyclist' FROM (FROM pair UNION ALL BY NAME FROM actor)
SELECT coalesce(actor_class, 'car') = 'cyclist' FROM pair
SELECT max(actor_class) = 'cyclist' FROM pair
SELECT lag(actor_class) OVER (ORDER BY t_ns) = 'cyclist' FROM pair
SELECT arg_max(actor_class, t_ns) = 'cyclist' FROM pair
SELECT min({'t': t_ns, 'k': actor_class}).k = 'cyclist' FROM pair
SELECT (CASE WHEN off_level THEN actor_class END) = 'cyclist' FROM pair
SELECT actor_class::VARCHAR = 'cyclist' FROM pair
SELECT (SELECT actor_class FROM actor LIMIT 1) = 'cyclist'
SELECT l[1] = 'cyclist' FROM (SELECT list(actor_class) AS l FROM pair)
SELECT u = 'cyclist' FROM (SELECT unnest(list(actor_class)) AS u FROM pair)
SELECT u.k = 'cyclist' FROM (SELECT list(actor_class) AS l FROM pair) s, unnest(s.l) AS u(k)
WITH RECURSIVE r AS (SELECT actor_class AS k FROM pair UNION ALL SELECT k FROM r) SELECT k = 'cyclist' FROM r
-- wherever an expression may stand
SELECT count(*) FILTER (actor_class = 'cyclist') FROM pair
SELECT 1 FROM pair WHERE actor_class = 'cyclist' AND off_level
SELECT 1 FROM pair p JOIN actor a ON a.actor_id = p.object_id AND a.actor_class = 'cyclist'
SELECT 1 FROM pair p LEFT JOIN LATERAL (SELECT p.actor_class = 'cyclist' AS y) ON true
SELECT 1 FROM pair WHERE EXISTS (FROM actor WHERE actor_class = 'cyclist')
SELECT 1 FROM ego_state e WHERE e.ego_id IN (SELECT ego_id FROM pair WHERE actor_class = 'cyclist')
SELECT count(*) FROM pair GROUP BY actor_class HAVING actor_class = 'cyclist'
SELECT 1 FROM pair QUALIFY row_number() OVER (PARTITION BY actor_class = 'cyclist') = 1
SELECT 1 FROM pair ORDER BY actor_class = 'cyclist'
SELECT list(t_ns ORDER BY actor_class = 'cyclist') FROM pair
