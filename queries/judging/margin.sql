INSERT INTO margin BY NAME
SELECT m.* EXCLUDE (rule_no) REPLACE (nullif(m.profile, '') AS profile, nullif(m.object_id, '') AS object_id),
    r.rule_id FROM _margin m JOIN _rule r USING (rule_no)
ANTI JOIN _error e ON e.rule_no = m.rule_no AND e.drive_id = m.drive_id AND e.ego_id = m.ego_id
