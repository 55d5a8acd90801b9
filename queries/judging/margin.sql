-- A failing step is of the finding whose stretch it lies in. A rule that combines objects has one finding at a time, whatever objects it is about.
INSERT INTO margin BY NAME
WITH _stretch_of_finding AS (
    SELECT f.finding_id, r.rule_no, f.drive_id, f.ego_id, coalesce(f.profile, '') AS profile, f.ref_id,
        CASE WHEN r.by_object THEN coalesce(f.object_id, '') ELSE '' END AS judged_object_id, f.t_start_ns, f.t_end_ns, false AS holds
    FROM finding f JOIN _rule r USING (rule_id)
), _with_rule AS (
    SELECT m.*, r.rule_id, r.unit, CASE WHEN r.by_object THEN m.object_id ELSE '' END AS judged_object_id
    FROM _margin m JOIN _rule r USING (rule_no)
)
SELECT m.* EXCLUDE (rule_no, judged_object_id) REPLACE (nullif(m.profile, '') AS profile, nullif(m.object_id, '') AS object_id),
    (m.t_ns - s.start_ns) / 1e9 AS t_s, f.finding_id
FROM _with_rule m
JOIN _subject s ON s.drive_id = m.drive_id AND s.ego_id = m.ego_id
ANTI JOIN _error e ON e.rule_no = m.rule_no AND e.drive_id = m.drive_id AND e.ego_id = m.ego_id
LEFT JOIN _stretch_of_finding f ON f.rule_no = m.rule_no AND f.drive_id = m.drive_id AND f.ego_id = m.ego_id AND f.profile = m.profile
    AND f.ref_id IS NOT DISTINCT FROM m.ref_id AND f.judged_object_id = m.judged_object_id AND f.holds = m.holds
    AND m.t_ns BETWEEN f.t_start_ns AND f.t_end_ns
