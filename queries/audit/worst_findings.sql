-- Findings in the order of reports: severity, contacts first, sure before possible, the least margin; then a total order.
SELECT f.*
FROM findings f
LEFT JOIN rules r USING (rule_id)
ORDER BY
    CASE f.severity WHEN 'critical' THEN 0 WHEN 'major' THEN 1 ELSE 2 END,
    coalesce(list_contains(r.tags, 'contact'), false) DESC,
    CASE WHEN f.n_copies IS NULL THEN 1 WHEN f.n_stays >= {least_share} * f.n_copies THEN 0 ELSE 2 END,
    coalesce(f.margin, 0),
    f.t_worst_ns NULLS FIRST, f.drive_id, f.key, f.ego_id, f.rule_id, f.profile NULLS FIRST, f.object_id NULLS FIRST, f.occurrence,
    f.ref_id NULLS FIRST, f.finding_id
LIMIT $most
