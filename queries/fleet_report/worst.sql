-- The drives with the gravest and most findings, each with the rules that it broke most often and its worst finding.
WITH counted AS (
    SELECT key, count(*) FILTER (severity = 'critical') AS critical, count(*) FILTER (severity = 'major') AS major,
        count(*) FILTER (severity = 'minor') AS minor, count(*) FILTER (n_stays < {least_share} * n_copies) AS possible
    FROM counted_findings GROUP BY key
), worst AS (
    SELECT c.*, d.drive_id, d.log, d.file_name, d.map_name, d.km, d.duration_s, d.lossy, d.tags
    FROM counted c JOIN drives d ON d.key = c.key
    ORDER BY c.critical DESC, c.major DESC, c.minor DESC, d.log, c.key LIMIT $most
), broken AS (
    SELECT key, rule_id, count(*) AS n FROM counted_findings SEMI JOIN worst USING (key) GROUP BY ALL
), gravest AS (
    -- severity first, then contacts, sure ones and the least margin: the order of every report
    SELECT f.key, f.finding_id, f.rule_id AS worst_rule, f.object_id, f.t_worst_s, coalesce(f.n_stays < {least_share} * f.n_copies, false) AS is_possible
    FROM counted_findings f SEMI JOIN worst USING (key) LEFT JOIN rules r ON r.rule_id = f.rule_id
    QUALIFY row_number() OVER (PARTITION BY f.key ORDER BY list_position(['critical', 'major', 'minor'], f.severity),
        list_contains(r.tags, 'contact') DESC, is_possible, coalesce(f.margin, 0), f.t_worst_ns, f.finding_id) = 1
)
SELECT w.*, g.* EXCLUDE (key), {options} AS options, b.rules
FROM worst w
JOIN (SELECT key, list({'rule_id': rule_id, 'n': n} ORDER BY n DESC, rule_id) AS rules FROM broken GROUP BY key) b ON b.key = w.key
JOIN gravest g ON g.key = w.key
LEFT JOIN receipts r ON r.key = w.key
ORDER BY w.critical DESC, w.major DESC, w.minor DESC, w.log, w.key
