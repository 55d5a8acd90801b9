-- The failing runs of `_judged`: close ones as one, but never across a hole. `failing`: the first and last failing step of each label,
-- which tell whose verdicts the run is part of.
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
    FROM _runs GROUP BY ALL
), _failing AS (
    SELECT drive_id, ego_id, object_id, profile, ref_id, seg, run,
        list({'label': label, 't_first_ns': t_first_ns, 't_last_ns': t_last_ns} ORDER BY label) AS failing
    FROM (
        SELECT drive_id, ego_id, object_id, profile, ref_id, seg, run, {label} AS label, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns
        FROM _runs GROUP BY ALL
    ) GROUP BY ALL
)
SELECT $_no AS rule_no, w.drive_id, w.ego_id, {worst_object} AS object_id, w.profile, w.ref_id,
    t_start_ns, t_end_ns, worst.t AS t_worst_ns, coalesce(worst.code, 'violated') AS code, worst.reason AS reason,
    finite(worst.observed) AS observed, finite(worst.required) AS required,
    margin_of($_sense, worst.observed, worst.required, worst.holds) AS margin,
    w.object_id AS judged_object_id, f.failing
FROM _worst w
JOIN _failing f ON f.drive_id = w.drive_id AND f.ego_id = w.ego_id AND f.object_id = w.object_id AND f.profile = w.profile
    AND f.ref_id IS NOT DISTINCT FROM w.ref_id AND f.seg IS NOT DISTINCT FROM w.seg AND f.run = w.run
