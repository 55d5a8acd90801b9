-- The rules that were broken most: severity first, then findings.
SELECT severity, rule_id, n_findings, n_drives, n_possible, is_contact
FROM (
    SELECT
        f.severity, f.rule_id, count(*) AS n_findings, count(DISTINCT f.key) AS n_drives, count(*) FILTER (is_possible) AS n_possible,
        coalesce(bool_or(list_contains(r.tags, 'contact')), false) AS is_contact
    FROM ({event}) f
    LEFT JOIN rules r USING (rule_id)
    GROUP BY ALL
)
ORDER BY CASE severity WHEN 'critical' THEN 0 WHEN 'major' THEN 1 ELSE 2 END, n_findings DESC, rule_id
