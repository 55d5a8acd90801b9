INSERT INTO course BY NAME
WITH _course_with_rule AS (SELECT c.* REPLACE (nullif(c.profile, '') AS profile, nullif(c.object_id, '') AS object_id), r.rule_id
    FROM _course c JOIN _rule r USING (rule_no)), _finding_or_near_miss AS (
    SELECT finding_id, drive_id, ego_id, rule_id, profile, object_id, occurrence, ref_id, t_start_ns, false AS near FROM finding
    UNION ALL
    SELECT NULL, drive_id, ego_id, rule_id, profile, object_id, occurrence, ref_id, t_start_ns, true
    FROM verdict WHERE near_miss)
SELECT f.finding_id, f.drive_id, f.ego_id, f.rule_id, f.profile, f.object_id, f.occurrence,
    list(c.t_ns ORDER BY c.t_ns) AS t_ns, list(c.observed ORDER BY c.t_ns) AS observed,
    list(c.required ORDER BY c.t_ns) AS required, list(c.margin ORDER BY c.t_ns) AS margin, list(c.holds ORDER BY c.t_ns) AS holds,
    list(round(e.x_m, 3) ORDER BY c.t_ns) AS x_m, list(round(e.y_m, 3) ORDER BY c.t_ns) AS y_m
FROM _course_with_rule c
LEFT JOIN ego_state e ON e.drive_id = c.drive_id AND e.ego_id = c.ego_id AND e.t_ns = c.t_ns
JOIN _finding_or_near_miss f ON f.near = c.near AND f.drive_id = c.drive_id AND f.ego_id = c.ego_id AND f.rule_id = c.rule_id
    AND f.profile IS NOT DISTINCT FROM c.profile
    AND f.object_id IS NOT DISTINCT FROM c.object_id AND f.ref_id IS NOT DISTINCT FROM c.ref_id AND f.t_start_ns = c.t_start_ns
GROUP BY f.finding_id, f.drive_id, f.ego_id, f.rule_id, f.profile, f.object_id, f.occurrence
