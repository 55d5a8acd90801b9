-- The drives of an audit, logs of one content once: the first result of each log, with the egos of all results, each as the first that has it.
-- Where results have several values of a tag, it is not known which one holds.
CREATE OR REPLACE TEMP VIEW {counted}drives AS
WITH result AS (
    SELECT k.log_key, k.no, d.exposure, d.tags, d.lossy FROM {of}drives d JOIN {counted}key k ON k.key = d.key AND k.n > 1
), ego AS (
    SELECT log_key, e
    FROM (SELECT log_key, no, unnest(exposure) AS e FROM result)
    QUALIFY row_number() OVER (PARTITION BY log_key, e.ego_id ORDER BY no) = 1
), tag AS (
    SELECT log_key, t.key AS name, min(t.value) AS value
    FROM (SELECT log_key, unnest(map_entries(tags)) AS t FROM result) GROUP BY ALL HAVING count(DISTINCT t.value) = 1
), whole AS (
    SELECT log_key, bool_or(lossy) AS lossy FROM result GROUP BY log_key
), egos AS (
    SELECT log_key, list(e ORDER BY e.ego_id) AS exposure FROM ego GROUP BY log_key
), tags AS (
    SELECT log_key, map_from_entries(list({'key': name, 'value': value} ORDER BY name)) AS tags FROM tag GROUP BY log_key
)
SELECT d.* REPLACE (
    CASE WHEN k.n = 1 THEN d.exposure ELSE e.exposure END AS exposure, CASE WHEN k.n = 1 THEN d.tags ELSE t.tags END AS tags,
    CASE WHEN k.n = 1 THEN d.lossy ELSE w.lossy END AS lossy)
FROM {of}drives d
JOIN {counted}key k ON k.key = d.key AND k.no = 1
LEFT JOIN whole w ON w.log_key = d.key
LEFT JOIN egos e ON e.log_key = d.key
LEFT JOIN tags t ON t.log_key = d.key
