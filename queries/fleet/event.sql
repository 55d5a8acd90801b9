-- Part of the statements of this folder and of others: one finding per event, with `is_possible`, as `one_finding_per_event` of a check.
-- A touch of two egos is a finding of each: of findings of one rule in which each of two egos is the object of the other at the same time, the
-- surest stands for both. So it does of findings of one rule, ego and object under several profiles at the same time.
-- The pairs are found by an inner join: DuckDB runs an anti join with other conditions than equalities as a loop over all pairs.
WITH all_findings AS (
    SELECT *, coalesce(n_stays < {least_share} * n_copies, false) AS is_possible FROM {of}findings
), same_event AS (
    SELECT DISTINCT f.key, f.finding_id
    FROM all_findings f
    JOIN all_findings o ON o.key = f.key AND o.rule_id = f.rule_id
    WHERE o.t_start_ns <= f.t_end_ns AND f.t_start_ns <= o.t_end_ns
        AND CASE
            WHEN o.profile IS DISTINCT FROM f.profile THEN o.ego_id = f.ego_id AND o.object_id IS NOT DISTINCT FROM f.object_id
            ELSE o.ego_id = f.object_id AND o.object_id = f.ego_id
        END
        AND (o.is_possible, o.ego_id, coalesce(o.profile, '')) < (f.is_possible, f.ego_id, coalesce(f.profile, ''))
)
FROM all_findings ANTI JOIN same_event USING (key, finding_id)
