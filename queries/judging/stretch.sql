-- The failing runs of `_judged`: close ones as one, but never across a hole. `failing`: the first and last failing step of each label,
-- which show the verdicts that the run belongs to.
INSERT INTO _stretch BY NAME
WITH _failing_step AS (
    SELECT j.*, r.kind, r.eventually, r.sense, r.merge_ns FROM _judged j JOIN _rule r USING (rule_no)
    -- a window that passes, or is unknown, may have steps that fail: these are no findings
    LEFT JOIN (
        SELECT DISTINCT o.rule_no, drive_id, ego_id, ref_id, profile, CASE WHEN r.by_object THEN object_id ELSE '' END AS judged_object_id
        FROM _outcome o JOIN _rule r ON r.rule_no = o.rule_no AND r.eventually WHERE verdict = 'fail'
    ) o ON o.rule_no = j.rule_no AND o.drive_id = j.drive_id AND o.ego_id = j.ego_id AND o.ref_id = j.ref_id AND o.profile = j.profile
        AND o.judged_object_id = CASE WHEN r.by_object THEN j.object_id ELSE '' END
    WHERE NOT j.holds AND (NOT r.eventually OR o.rule_no IS NOT NULL)
), _fails AS (
    SELECT *, CASE WHEN CASE WHEN kind = 'invariant' THEN k - lag(k) OVER w <= 1 ELSE n - lag(n) OVER w = 1 END
        OR t_ns - lag(t_ns) OVER w < merge_ns THEN 0 ELSE 1 END AS fresh
    FROM _failing_step
    WINDOW w AS (PARTITION BY rule_no, drive_id, ego_id, object_id, profile, ref_id, seg ORDER BY t_ns, label)
), _runs AS (
    SELECT *, sum(fresh) OVER (PARTITION BY rule_no, drive_id, ego_id, object_id, profile, ref_id, seg ORDER BY t_ns, label
        ROWS UNBOUNDED PRECEDING) AS run FROM _fails
), _worst AS (
    SELECT rule_no, drive_id, ego_id, object_id, profile, ref_id, seg, run, any_value(sense) AS sense, min(t_ns) AS t_start_ns,
        max(t_ns) AS t_end_ns, deciding_step(eventually, sense, holds, gain, t_ns, who, observed, required, code, reason) AS worst
    FROM _runs GROUP BY rule_no, drive_id, ego_id, object_id, profile, ref_id, seg, run
), _failing AS (
    SELECT rule_no, drive_id, ego_id, object_id, profile, ref_id, seg, run,
        list({'label': label, 't_first_ns': t_first_ns, 't_last_ns': t_last_ns} ORDER BY label) AS failing
    FROM (
        SELECT rule_no, drive_id, ego_id, object_id, profile, ref_id, seg, run, label, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns
        FROM _runs GROUP BY ALL
    ) GROUP BY ALL
)
SELECT w.rule_no, w.drive_id, w.ego_id, worst.who AS object_id, w.profile, w.ref_id,
    t_start_ns, t_end_ns, worst.t AS t_worst_ns, coalesce(worst.code, 'violated') AS code, worst.reason AS reason,
    finite(worst.observed) AS observed, finite(worst.required) AS required,
    margin_of(sense, worst.observed, worst.required, worst.holds) AS margin,
    w.object_id AS judged_object_id, f.failing
FROM _worst w
JOIN _failing f ON f.rule_no = w.rule_no AND f.drive_id = w.drive_id AND f.ego_id = w.ego_id AND f.object_id = w.object_id
    AND f.profile = w.profile AND f.ref_id IS NOT DISTINCT FROM w.ref_id AND f.seg IS NOT DISTINCT FROM w.seg AND f.run = w.run
