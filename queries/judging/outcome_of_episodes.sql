-- One row per episode of the invariants of `_judged`: only keys with a gap are numbered by episode, the others have one.
INSERT INTO _outcome BY NAME
WITH _applicable_step AS (
    SELECT j.*, r.eventually, r.sense FROM _judged j JOIN _rule r ON r.rule_no = j.rule_no AND r.kind = 'invariant'
    WHERE j.applies IS DISTINCT FROM false
), _key_summary AS (
    SELECT rule_no, drive_id, ego_id, object_id, profile, label, count(*) <> max(k) - min(k) + 1 OR min(seg) <> max(seg) AS broken
    FROM _applicable_step GROUP BY ALL
), _step_with_previous AS (
    SELECT l.*, lag(t_ns) OVER w AS t_last_ns, lag(seg) OVER w AS seg_last
    FROM _applicable_step l SEMI JOIN (FROM _key_summary WHERE broken) f USING (rule_no, drive_id, ego_id, object_id, profile, label)
    WINDOW w AS (PARTITION BY rule_no, drive_id, ego_id, object_id, profile, label ORDER BY t_ns)
), _step_of_any_episode AS (
    SELECT l.* EXCLUDE (t_last_ns, seg_last), sum(CASE WHEN seg_last = seg AND t_ns - t_last_ns <= s.max_gap_ns THEN 0 ELSE 1 END)
        OVER (PARTITION BY l.rule_no, l.drive_id, l.ego_id, l.object_id, l.profile, l.label ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS episode
    FROM _step_with_previous l JOIN _subject s ON s.drive_id = l.drive_id AND s.ego_id = l.ego_id
    UNION ALL BY NAME
    SELECT l.*, 0 AS episode
    FROM _applicable_step l SEMI JOIN (FROM _key_summary WHERE NOT broken) f USING (rule_no, drive_id, ego_id, object_id, profile, label)
), _episode AS (
    SELECT rule_no, drive_id, ego_id, object_id, profile, label, episode, any_value(sense) AS sense, count(*) AS n_expected,
        count(holds) AS n_judged, count(*) FILTER (NOT holds) AS n_fail, min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns,
        deciding_step(eventually, sense, holds, gain, t_ns, who, observed, required, code, reason) AS worst, first_unknown_step(holds, t_ns, who, observed, required, code, reason) AS unknown
    FROM _step_of_any_episode GROUP BY rule_no, drive_id, ego_id, object_id, profile, label, episode
), _decided AS (SELECT *, CASE WHEN n_fail > 0 THEN 'fail' WHEN n_judged < n_expected THEN 'unknown'
    ELSE 'pass' END AS verdict FROM _episode)
SELECT rule_no, drive_id, ego_id, object_id, profile, label, t_start_ns, t_end_ns, worst.t AS t_worst_ns, verdict,
    CASE verdict WHEN 'unknown' THEN unknown.t ELSE worst.t END AS t_decides_ns,
    CASE verdict WHEN 'unknown' THEN unknown.code WHEN 'fail' THEN coalesce(worst.code, 'violated')
        ELSE coalesce(worst.code, 'kept') END AS code,
    CASE verdict WHEN 'unknown' THEN unknown.reason ELSE worst.reason END AS reason,
    finite(worst.observed) AS observed, finite(worst.required) AS required,
    margin_of(sense, worst.observed, worst.required, worst.holds) AS margin,
    finite(unknown.observed) AS bound, unknown.required AS asked, n_expected, n_judged
FROM _decided
