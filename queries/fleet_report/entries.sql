-- The gravest findings of one standing, and the logs that they are in. `common_first`: those of drives that both audits have come first.
SELECT e.*, coalesce(n.log, b.log) AS log
FROM (
    SELECT d.*, CASE WHEN d.standing IN ('fixed', 'elsewhere', 'unknown', 'lost') THEN d.rule_id IN (SELECT rule_id FROM {base}rules WHERE status = 'stable')
        ELSE d.rule_id IN (SELECT rule_id FROM {new}rules WHERE status = 'stable') END AS stable
    FROM difference d WHERE d.standing = $standing
    ORDER BY $common_first AND d.why_code IS NOT DISTINCT FROM 'drive_not_checked', list_position(['critical', 'major', 'minor'], d.severity), d.drive_id, d.t_s, d.rule_id, d.profile NULLS FIRST,
        d.object_id NULLS FIRST, d.finding_id, d.new_key, d.base_key LIMIT $most
) e
LEFT JOIN {new}drives n ON n.key = e.new_key
LEFT JOIN {base}drives b ON b.key = e.base_key
ORDER BY $common_first AND e.why_code IS NOT DISTINCT FROM 'drive_not_checked', list_position(['critical', 'major', 'minor'], e.severity), e.drive_id, e.t_s, e.rule_id, e.profile NULLS FIRST,
    e.object_id NULLS FIRST, e.finding_id, e.new_key, e.base_key
