-- The failing runs of `_judged`: close ones as one, but never across a hole.
INSERT INTO _stretch BY NAME
WITH _fails AS (
    SELECT j.*, CASE WHEN {follows} OR t_ns - lag(t_ns) OVER w < $_merge_ns
        THEN 0 ELSE 1 END AS fresh
    FROM _judged j {failed} WHERE NOT holds
    WINDOW w AS (PARTITION BY drive_id, ego_id, object_id, profile, ref_id, seg ORDER BY {order})
), _runs AS (
    SELECT *, sum(fresh) OVER (PARTITION BY drive_id, ego_id, object_id, profile, ref_id, seg ORDER BY {order}
        ROWS UNBOUNDED PRECEDING) AS run FROM _fails
), _worst AS (
    SELECT drive_id, ego_id, object_id, profile, ref_id, seg, run, min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns,
        {deciding_step} AS worst
    FROM _runs GROUP BY ALL)
SELECT $_no AS rule_no, drive_id, ego_id, {worst_object} AS object_id, profile, ref_id,
    t_start_ns, t_end_ns, worst.t AS t_worst_ns, coalesce(worst.code, 'violated') AS code, worst.reason AS reason,
    finite(worst.observed) AS observed, finite(worst.required) AS required,
    margin_of($_sense, worst.observed, worst.required, worst.holds) AS margin
FROM _worst
