-- SELECTs in which nothing is wrong: one a line.
SELECT coalesce(lane_type, '') <> '' FROM lanelet
SELECT coalesce(actor_class, 'nobody') = 'nobody' FROM pair
SELECT ifnull(state, 'dark') IN ('dark', 'red') FROM mark_phase
SELECT CASE WHEN drivable THEN lane_type ELSE 'other' END = 'other' FROM lanelet
-- texts of the log's own
SELECT value = 'anything', event = 'door_opened' FROM declared_event
SELECT mode = 'platooning' FROM ego_mode
SELECT object_id = 'cyclist' FROM pair
SELECT nation = 'fr' FROM ego_condition
SELECT starts_with(nation, 'f') FROM ego_condition
SELECT lower(actor_class) = 'CYCLIST' FROM pair
SELECT starts_with(road_type, 'town'), actor_class LIKE '%cycle', lane_type LIKE '_us' FROM ego_state, pair, lanelet
-- words of a rule's own
SELECT part = 'before' FROM (SELECT CASE WHEN k = 0 THEN 'before' ELSE 'after' END AS part FROM step)
SELECT v.part = 'a' FROM (VALUES ('a', 1), ('b', 2)) AS v(part, n)
-- a class that is none of a narrower set, by way of a macro or of a set
SELECT is_vehicle(kind) FROM (SELECT CASE WHEN k = 0 THEN 'car' ELSE 'bus' END AS kind FROM step)
SELECT p.actor_class = s.kind FROM pair p, (SELECT CASE WHEN k = 0 THEN 'car' ELSE 'none of these' END AS kind FROM step) s
-- a recursive CTE whose second part has more words than its first
WITH RECURSIVE r AS (SELECT 'a' AS s UNION ALL SELECT CASE WHEN s = 'b' THEN 'c' ELSE 'b' END FROM r) SELECT s = 'c' FROM r
SELECT NULL::VARCHAR = 'anything', NULL IN ('a')
SELECT code = 'no_class' FROM (SELECT code FROM unplaced UNION ALL SELECT 'no_class' FROM _oncoming_vehicle)
SELECT columns_of_a_table_that_nobody_knows = 'x', t.actor_class = 'cyclist' FROM elsewhere t
SELECT e.x = 'y' FROM (SELECT * FROM elsewhere) e
SELECT COLUMNS('a.*') = 'cyclist' FROM elsewhere
SELECT lights[1].fit = 'own', list_filter(lights, lambda l: l.fit IN ('own', 'maybe')) FROM way_mark
SELECT list_contains(turns, 'left') FROM traffic_signal
SELECT unnest(turns) = 'u_turn' FROM traffic_signal
-- any SELECT can be looked at
SELECT actor_class, count(*) FROM pair GROUP BY GROUPING SETS ((actor_class), ())
FROM range(3) t(i) SELECT i = 1
SELECT * FROM (DESCRIBE pair)
SELECT COLUMNS(c -> c LIKE 'x%') FROM pair
SELECT * EXCLUDE (p.x_m) FROM pair p
SELECT * RENAME (x_m AS y) FROM pair
SELECT s.*, s.a.b FROM (SELECT {'a': {'b': actor_class}} AS s FROM pair)
SELECT row(1, 'a'), MAP {'a': 'b'}, {'a': 1}.a, [1, 2][1:2], 'a'[1]
SELECT list_transform([1, 2], lambda x, i: x = i), list_transform(turns, x -> x || 'a') FROM traffic_signal
SELECT list_transform(turns, f) FROM (SELECT turns, 1 AS f FROM traffic_signal)
SELECT TRY_CAST(actor_class AS INTEGER), actor_class COLLATE NOCASE = 'x', INTERVAL 1 DAY FROM pair
SELECT count(), unnest([]), unnest(NULL), list(), lag() FROM pair
SELECT x = ALL(SELECT actor_class FROM pair), (1, 'a') IN ((1, 'b')) FROM pair
VALUES ('a', 1), ('b', NULL)
(SELECT 'a' AS s) EXCEPT (SELECT 'b') INTERSECT SELECT 'c' UNION ALL SELECT 'd'
WITH RECURSIVE r AS (SELECT 'a' AS s UNION SELECT s || 'a' FROM r WHERE length(s) < 9) FROM r
SELECT why('a'), why('a', {'b': 'c'}), why(), is_class(actor_class) FROM pair
SELECT 1 FROM a NATURAL JOIN b POSITIONAL JOIN c ASOF JOIN pair p ON p.t_ns >= a.t_ns
SELECT * FROM pair, LATERAL (SELECT unnest([actor_class]) AS k) WHERE k = 'car'
SELECT DISTINCT ON (actor_class) * FROM pair ORDER BY ALL LIMIT 3 OFFSET 1
SELECT actor_class.x.y, pair.actor_class, main.pair.actor_class, pair FROM pair
