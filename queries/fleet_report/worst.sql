-- The drives with the gravest and most findings, each with the rules that it broke most often and its worst finding. `key` is that of the result
-- that has the worst finding.
WITH worst AS (
    SELECT * FROM ({ranked}) WHERE no <= $most
), broken AS (
    SELECT key, rule_id, count(*) AS n FROM ({event}) SEMI JOIN worst USING (key) GROUP BY ALL
), gravest AS (
    SELECT f.key, f.result_key, f.finding_id, f.rule_id AS worst_rule, f.object_id, f.t_worst_s, coalesce(f.n_stays < {least_share} * f.n_copies, false) AS is_possible
    FROM counted_findings f SEMI JOIN worst USING (key) LEFT JOIN rules r ON r.rule_id = f.rule_id
    QUALIFY row_number() OVER (PARTITION BY f.key ORDER BY {gravest_first}) = 1
)
SELECT w.* EXCLUDE (key), d.key, d.drive_id, d.log, d.file_name, d.map_name, d.km, d.duration_s, d.lossy, d.tags, g.* EXCLUDE (key, result_key),
    {options} AS options, b.rules
FROM worst w
JOIN (SELECT key, list({'rule_id': rule_id, 'n': n} ORDER BY n DESC, rule_id) AS rules FROM broken GROUP BY key) b ON b.key = w.key
JOIN gravest g ON g.key = w.key
JOIN drives d ON d.key = g.result_key
LEFT JOIN receipts r ON r.key = d.key
ORDER BY w.no
