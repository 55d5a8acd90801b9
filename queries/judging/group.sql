-- First pass of an invariant: the groups that pass on all their steps without a gap are `clean`.
--
-- A group counts only if the rule returned exactly the steps of its grid: the same number of rows and the same sum of the time stamps'
-- 64-bit hashes, which changes if a row is lost or doubled. Complete groups in which the rule applies at no step are left out. All other
-- groups wait for the second pass.
INSERT INTO _group BY NAME
WITH {condition}, _returned_group AS (
    SELECT drive_id, ego_id, object_id, count(*) AS n, sum(hash(t_ns)::HUGEINT) AS signature,
        count(*) FILTER (applies AND holds) AS n_kept, count(*) FILTER (NOT applies) AS n_out,
        min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns, {deciding_step} AS worst
    FROM _state GROUP BY ALL)
SELECT $_no AS rule_no, g.drive_id, g.ego_id, g.object_id, coalesce(g.whole AND s.n_kept = s.n, false) AS clean,
    s.t_start_ns, s.t_end_ns, g.n, s.worst.t AS t_worst_ns,
    finite(s.worst.observed) AS observed, finite(s.worst.required) AS required,
    margin_of($_sense, s.worst.observed, s.worst.required, s.worst.holds) AS margin,
    coalesce(s.worst.code, 'kept') AS code, s.worst.reason AS reason
FROM _grid_group g
LEFT JOIN _returned_group s ON g.drive_id = s.drive_id AND g.ego_id = s.ego_id{same_object} AND g.n = s.n AND g.signature = s.signature
{todo}
WHERE g.grid = '{grid}' AND s.n_out IS DISTINCT FROM g.n
