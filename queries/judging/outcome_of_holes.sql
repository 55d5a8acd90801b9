-- One unknown row per hole between two steps of `_judged` at which an invariant applies, if the rule applied at the last step before the hole or at the
-- first step after it. Between steps that are both there, of which one lies within a lost stretch, there is no hole: the segment of that step
-- is unknown, if it does not fail.
INSERT INTO _outcome BY NAME
WITH _step_with_previous AS (
    SELECT j.rule_no, drive_id, ego_id, object_id, profile, t_ns, seg, lag(t_ns) OVER w AS t_prev_ns, lag(seg) OVER w AS seg_prev
    FROM _judged j JOIN _rule r ON r.rule_no = j.rule_no AND r.kind = 'invariant' WHERE applies IS DISTINCT FROM false
    WINDOW w AS (PARTITION BY j.rule_no, drive_id, ego_id, object_id, profile ORDER BY t_ns)
), _step_pair_over_hole AS (
    SELECT j.rule_no, j.drive_id, j.ego_id, j.object_id, j.profile, j.seg_prev, j.seg,
        p.t_last_ns - j.t_prev_ns <= s.max_gap_ns AS from_edge, j.t_ns - q.t_first_ns <= s.max_gap_ns AS to_edge,
        s.period_ns
    FROM _step_with_previous j JOIN _subject s USING (drive_id, ego_id)
    JOIN _segment p ON p.drive_id = j.drive_id AND p.ego_id = j.ego_id AND p.seg = j.seg_prev
    JOIN _segment q ON q.drive_id = j.drive_id AND q.ego_id = j.ego_id AND q.seg = j.seg
    WHERE j.seg_prev <> j.seg AND NOT ((p.is_lost OR q.is_lost) AND j.t_ns - j.t_prev_ns <= s.max_gap_ns)
), _holes AS (
    SELECT e.*, p.t_last_ns AS t_start_ns, q.t_first_ns AS t_end_ns FROM _step_pair_over_hole e
    JOIN _segment p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.seg = CASE WHEN from_edge THEN seg_prev
        ELSE e.seg - 1 END
    JOIN _segment q ON q.drive_id = e.drive_id AND q.ego_id = e.ego_id AND q.seg = CASE WHEN to_edge THEN e.seg
        ELSE seg_prev + 1 END
    WHERE from_edge OR to_edge)
SELECT rule_no, drive_id, ego_id, object_id, profile, t_start_ns, t_end_ns, t_start_ns AS t_worst_ns,
    t_start_ns AS t_decides_ns, 'unknown' AS verdict, 'log_hole' AS code,
    greatest(1, (t_end_ns - t_start_ns) // greatest(period_ns, 1) - 1) AS n_expected, 0 AS n_judged
FROM _holes
