-- How many drives have a finding, logs of one content once; how many findings no rate has, as another log of the content counts for it.
WITH {subject}
SELECT count(DISTINCT coalesce(d.sha256, d.key)) AS drives, count(*) FILTER (s.key IS NULL) AS without_rate
FROM counted_findings f JOIN drives d ON d.key = f.key
LEFT JOIN subject s ON s.key = f.key AND s.ego_id = f.ego_id
