-- The findings of these drives that copies are judged for, with the times of their reference points.
SELECT
    f.finding_id, f.drive_id, f.ego_id, f.rule_id, f.profile, f.object_id, f.t_start_ns, f.t_end_ns, f.t_worst_ns, f.margin,
    min(v.t_ref_ns) AS t_ref_ns
FROM finding f
LEFT JOIN verdict v ON v.drive_id = f.drive_id AND v.ego_id = f.ego_id AND v.rule_id = f.rule_id AND v.ref_id = f.ref_id
WHERE list_contains($drives, f.drive_id) AND f.severity IN ('critical', 'major')
GROUP BY ALL
ORDER BY f.drive_id, f.ego_id, f.rule_id, f.profile, f.object_id, f.t_start_ns, f.finding_id
