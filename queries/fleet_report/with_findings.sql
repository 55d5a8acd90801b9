-- How many drives have a finding, logs of one content once; how many findings no rate has, as another result of the log counts for it.
WITH {subject}
SELECT count(DISTINCT f.key) AS drives, count(*) FILTER (s.key IS NULL) AS without_rate
FROM counted_findings f
LEFT JOIN subject s ON s.key = f.result_key AND s.ego_id = f.ego_id
