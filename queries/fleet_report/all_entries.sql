-- Every finding of two audits.
SELECT * FROM difference
ORDER BY standing, drive_id, ego_id, rule_id, profile NULLS FIRST, object_id NULLS FIRST, t_s, finding_id, new_key NULLS FIRST, base_key NULLS FIRST
