-- The failing stretches of all rules, with the columns of `_named`.
CREATE OR REPLACE TEMP TABLE _failed AS
SELECT f.* REPLACE (nullif(f.profile, '') AS profile, nullif(f.object_id, '') AS object_id), r.* EXCLUDE (rule_no),
    f.t_worst_ns AS t_decides_ns, 'fail' AS verdict, s.start_ns, s.sha256, s.t_start_ns AS ego_from_ns, s.t_end_ns AS ego_to_ns,
    NULL::DOUBLE AS bound, NULL::DOUBLE AS asked, NULL::VARCHAR AS label, f.reason AS cause
FROM _stretch f JOIN _rule r USING (rule_no) JOIN _subject s ON s.drive_id = f.drive_id AND s.ego_id = f.ego_id
ANTI JOIN _error e ON e.rule_no = f.rule_no AND e.drive_id = f.drive_id AND e.ego_id = f.ego_id
