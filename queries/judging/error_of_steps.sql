-- The subjects for which a condition returned more than one row for a key, or for which an invariant has a step that the ego has not.
INSERT INTO _error
SELECT s.rule_no, drive_id, ego_id, 'rule_error', CASE WHEN max(n_rows) > 1
    THEN format('the condition returned {} rows for one step (first at {:.3f} s): it must return one', max(n_rows),
        min(t_ns) FILTER (n_rows > 1) / 1e9)
    ELSE format('@applies returned the time {:.3f} s, which is no step of the ego', min(t_ns) / 1e9) END
FROM (
    SELECT rule_no, ref_id, drive_id, ego_id, object_id, profile, label, t_ns, greatest(count(*), max(n_same)) AS n_rows, min(k) AS k
    FROM _judged GROUP BY ALL
) s JOIN _rule r USING (rule_no)
WHERE n_rows > 1 OR r.kind = 'invariant' AND k IS NULL
GROUP BY s.rule_no, drive_id, ego_id
