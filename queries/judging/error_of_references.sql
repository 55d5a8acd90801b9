-- The subjects for which the condition returned more than one row for a key.
INSERT INTO _error
SELECT $_no, drive_id, ego_id, 'rule_error',
    format('the condition returned {} rows for one step (first at {:.3f} s): it must return one', max(n_rows),
        min(t_ns) / 1e9)
FROM (
    SELECT ref_id, drive_id, ego_id, object_id, profile, t_ns, greatest(count(*), max(n_same)) AS n_rows
    FROM _judged GROUP BY ALL)
WHERE n_rows > 1
GROUP BY drive_id, ego_id
