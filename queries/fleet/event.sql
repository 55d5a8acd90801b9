-- Part of the statements of this folder and of others: the findings, with `is_possible`. A touch of two egos is a finding of each: of findings of
-- one rule in which each of two egos is the object of the other at the same time, the surest stands for both.
SELECT f.*
FROM (SELECT *, coalesce(n_stays < {least_share} * n_copies, false) AS is_possible FROM {of}findings) f
ANTI JOIN (SELECT *, coalesce(n_stays < {least_share} * n_copies, false) AS is_possible FROM {of}findings) o
    ON o.key = f.key AND o.rule_id = f.rule_id AND o.profile IS NOT DISTINCT FROM f.profile AND o.ego_id = f.object_id
    AND o.object_id = f.ego_id AND o.t_start_ns <= f.t_end_ns AND f.t_start_ns <= o.t_end_ns
    AND (o.is_possible, o.ego_id) < (f.is_possible, f.ego_id)
