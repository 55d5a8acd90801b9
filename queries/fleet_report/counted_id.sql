-- Part of `gating`: for each finding, the id of the one that stands for its event, by the conditions of `queries/fleet/event.sql`.
SELECT f.key, f.finding_id,
    min({'possible': o.is_possible, 'ego': o.ego_id, 'profile': coalesce(o.profile, ''), 'id': o.finding_id})['id'] AS counted_id
FROM {of}findings f
JOIN (SELECT *, coalesce(n_stays < {least_share} * n_copies, false) AS is_possible FROM {of}findings) o
    ON o.key = f.key AND o.rule_id = f.rule_id AND o.t_start_ns <= f.t_end_ns AND f.t_start_ns <= o.t_end_ns
    AND CASE
        WHEN o.finding_id = f.finding_id THEN true
        WHEN o.profile IS DISTINCT FROM f.profile THEN o.ego_id = f.ego_id AND o.object_id IS NOT DISTINCT FROM f.object_id
        ELSE o.ego_id = f.object_id AND o.object_id = f.ego_id
    END
GROUP BY f.key, f.finding_id
