-- Per rule and profile: in how many drives it was decided, could not be decided, or did not apply, and why not.
WITH {subject}, {profiled}, drive_of_rule AS (
    SELECT s.content, p.rule_id, p.profile, bool_or(verdict IN ('pass', 'fail')) AS decided, bool_or(verdict IN ('unknown', 'error') OR starts_with(reason_code, 'unrecorded_')) AS unknown,
        bool_or(verdict = 'fail') AS failed, bool_or(verdict = 'not_applicable' AND reason_code = 'not_triggered') AS not_triggered,
        count(*) FILTER (verdict IN ('pass', 'fail')) AS n
    FROM profiled p JOIN subject s ON s.key = p.key AND s.ego_id = p.ego_id GROUP BY ALL
), asked AS (
    SELECT DISTINCT rule_id, profile
    FROM (SELECT rule_id, unnest(CASE WHEN len(profiles) > 0 THEN profiles ELSE [NULL] END) AS profile FROM {of}rules)
), counted AS (
    SELECT rule_id, profile, count(*) AS drives, count(*) FILTER (decided) AS drives_decided, count(*) FILTER (unknown) AS drives_unknown,
        count(*) FILTER (failed) AS drives_failed, count(*) FILTER (not_triggered AND NOT decided AND NOT unknown) AS drives_not_triggered,
        coalesce(sum(n), 0)::BIGINT AS occasions
    FROM drive_of_rule GROUP BY ALL
)
SELECT a.rule_id, a.profile,
    CASE WHEN coalesce(c.drives, 0) = 0 THEN 'not_run' WHEN c.drives_decided > 0 THEN 'decided' WHEN c.drives_unknown > 0 THEN 'never_decided'
        WHEN c.drives_not_triggered > 0 THEN 'never_triggered' ELSE 'never_in_force' END AS standing,
    coalesce(c.drives, 0) AS drives, coalesce(c.drives_decided, 0) AS drives_decided, coalesce(c.drives_failed, 0) AS drives_failed,
    coalesce(c.drives_unknown, 0) AS drives_unknown, coalesce(c.drives_not_triggered, 0) AS drives_not_triggered,
    coalesce(c.occasions, 0) AS occasions
FROM asked a
LEFT JOIN counted c ON c.rule_id = a.rule_id AND c.profile IS NOT DISTINCT FROM a.profile
ORDER BY a.rule_id, a.profile NULLS FIRST
