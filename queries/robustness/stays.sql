-- The copies in which a finding is one too (`keeps`), with its margin there, and those in which the worst step of a stretch passes.
WITH asked_of_copy AS (
    SELECT q.*, c.copy_id, c.copy_no FROM _question q JOIN _copy c ON q.window_id = c.window_id
),
-- A stretch of an invariant stays where any step of it fails.
stretch AS (
    SELECT a.finding_no, a.copy_no, min(f.margin) AS margin
    FROM asked_of_copy a
    JOIN finding f ON f.drive_id = a.copy_id AND f.ego_id = a.ego_id AND f.rule_id = a.rule_id AND f.profile IS NOT DISTINCT FROM a.profile
        AND (a.any_object OR f.object_id IS NOT DISTINCT FROM a.object_id) AND f.t_start_ns <= a.t_to_ns AND f.t_end_ns >= a.t_from_ns
    WHERE a.t_ref_ns IS NULL
    GROUP BY ALL
),
-- A finding at a reference point stays where the nearest one fails; one that is far away is another one.
at_reference AS (
    SELECT
        a.finding_no, a.copy_no, v.verdict, v.margin,
        rank() OVER (PARTITION BY a.finding_no, a.copy_no ORDER BY abs(v.t_ref_ns - a.t_ref_ns)) AS nearest
    FROM asked_of_copy a
    JOIN verdict v ON v.drive_id = a.copy_id AND v.ego_id = a.ego_id AND v.rule_id = a.rule_id AND v.profile IS NOT DISTINCT FROM a.profile
        AND (a.any_object OR v.object_id IS NOT DISTINCT FROM a.object_id) AND abs(v.t_ref_ns - a.t_ref_ns) <= $same_reference_ns
)
SELECT finding_no, copy_no, true AS keeps, margin FROM stretch
UNION ALL
SELECT finding_no, copy_no, true, min(margin) AS margin FROM at_reference WHERE nearest = 1 AND verdict = 'fail' GROUP BY ALL
UNION ALL
SELECT DISTINCT a.finding_no, a.copy_no, false, NULL
FROM asked_of_copy a
JOIN verdict v ON v.drive_id = a.copy_id AND v.ego_id = a.ego_id AND v.rule_id = a.rule_id AND v.profile IS NOT DISTINCT FROM a.profile
    AND (a.any_object OR v.object_id IS NOT DISTINCT FROM a.object_id) AND v.t_start_ns <= a.t_worst_ns AND v.t_end_ns >= a.t_worst_ns
WHERE a.t_ref_ns IS NULL AND v.verdict = 'pass'
