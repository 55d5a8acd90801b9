INSERT INTO finding BY NAME
WITH _numbered AS (
    SELECT *, (row_number() OVER (PARTITION BY drive_id, ego_id, rule_id, profile, object_id
        ORDER BY t_start_ns, t_end_ns, ref_id NULLS LAST) - 1)::INTEGER AS occurrence
    FROM with_sentences('_failed')
)
SELECT sha256(to_json([v.sha256, v.ego_id, rule_id, profile, object_id,
    v.occurrence::VARCHAR])::VARCHAR)[:16] AS finding_id,
    v.drive_id, v.ego_id, rule_id, rule_version, kind, profile, severity, object_id, v.occurrence, ref_id,
    v.t_start_ns, v.t_end_ns, t_worst_ns, sentence AS reason, cause_code, cause_args, reason_measures, observed, required, margin, unit,
    p.x_m, p.y_m, p.lanelet_id
FROM _numbered v
LEFT JOIN ego_state p ON p.drive_id = v.drive_id AND p.ego_id = v.ego_id AND p.t_ns = v.t_worst_ns
