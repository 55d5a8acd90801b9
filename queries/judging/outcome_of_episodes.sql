-- One row per episode of an invariant's `_judged`.
INSERT INTO _outcome BY NAME
WITH _applicable_step AS (SELECT * FROM _judged WHERE applies IS DISTINCT FROM false
), _key_summary AS (
    SELECT drive_id, ego_id, object_id, profile, label, count(*) <> max(k) - min(k) + 1 OR min(seg) <> max(seg) AS broken
    FROM _applicable_step GROUP BY ALL
{steps_with_episode}
), _step_of_any_episode AS (
    SELECT * FROM _step_with_episode UNION ALL BY NAME
    SELECT l.*, 0 AS episode
    FROM _applicable_step l SEMI JOIN (SELECT * FROM _key_summary WHERE NOT broken) f USING (drive_id, ego_id, object_id, profile, label)
), _episode AS (
    SELECT drive_id, ego_id, object_id, profile, label, episode, count(*) AS n_expected, count(holds) AS n_judged,
        count(*) FILTER (NOT holds) AS n_fail, min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns,
        {deciding_step} AS worst, {first_unknown_step} AS unknown
    FROM _step_of_any_episode GROUP BY ALL
), _decided AS (SELECT *, CASE WHEN n_fail > 0 THEN 'fail' WHEN n_judged < n_expected THEN 'unknown'
    ELSE 'pass' END AS verdict FROM _episode)
SELECT $_no AS rule_no, drive_id, ego_id, object_id, profile, label, t_start_ns, t_end_ns, worst.t AS t_worst_ns, verdict,
    CASE verdict WHEN 'unknown' THEN unknown.t ELSE worst.t END AS t_decides_ns,
    CASE verdict WHEN 'unknown' THEN unknown.code WHEN 'fail' THEN coalesce(worst.code, 'violated')
        ELSE coalesce(worst.code, 'kept') END AS code,
    CASE verdict WHEN 'unknown' THEN unknown.reason ELSE worst.reason END AS reason,
    finite(worst.observed) AS observed, finite(worst.required) AS required,
    margin_of($_sense, worst.observed, worst.required, worst.holds) AS margin,
    finite(unknown.observed) AS bound, unknown.required AS asked, n_expected, n_judged
FROM _decided
