-- The subjects for which an invariant's rows are not one per step of the ego.
INSERT INTO _error
SELECT $_no, drive_id, ego_id, 'rule_error', CASE WHEN max(n_rows) > 1
    THEN format('the condition returned {} rows for one step (first at {:.3f} s): it must return one', max(n_rows),
        min(t_ns) FILTER (n_rows > 1) / 1e9)
    ELSE format('@applies returned the time {:.3f} s, which is no step of the ego', min(t_ns) / 1e9) END
FROM (SELECT drive_id, ego_id, object_id, profile, label, t_ns, count(*) AS n_rows, min(k) AS k
    FROM _judged GROUP BY ALL)
WHERE n_rows > 1 OR k IS NULL
GROUP BY drive_id, ego_id
