-- One unknown row per hole of the log, for each invariant that applies at the last step before the hole or at the first step after it: what was
-- judged there may go on, or have begun, in the hole. A rule without a section @applies is about every object, however far away. If it applies
-- on one side only, its object must be seen on both: an object that is seen on one side is lost, and has a row of its own, or appears. Between
-- steps that are both there, of which one lies within a lost stretch, there is no hole: the segment of that step is unknown, if it does not fail.
INSERT INTO _outcome BY NAME
WITH _hole AS (
    SELECT p.drive_id, p.ego_id, p.seg, p.t_last_ns AS t_start_ns, q.t_first_ns AS t_end_ns, s.max_gap_ns, s.period_ns
    FROM _segment p JOIN _segment q ON q.drive_id = p.drive_id AND q.ego_id = p.ego_id AND q.seg = p.seg + 1
    JOIN _subject s ON s.drive_id = p.drive_id AND s.ego_id = p.ego_id
    WHERE NOT ((p.is_lost OR q.is_lost) AND q.t_first_ns - p.t_last_ns <= s.max_gap_ns)
), _applicable_part AS (
    SELECT j.rule_no, j.drive_id, j.ego_id, j.object_id, j.profile, j.seg, min(j.t_ns) AS t_first_ns, max(j.t_ns) AS t_last_ns
    FROM _judged j JOIN _rule r ON r.rule_no = j.rule_no AND r.kind = 'invariant' WHERE j.applies IS DISTINCT FROM false
    GROUP BY ALL
), _side AS (
    SELECT a.* EXCLUDE (seg, t_first_ns, t_last_ns), h.* EXCLUDE (drive_id, ego_id, max_gap_ns)
    FROM _applicable_part a JOIN _hole h ON h.drive_id = a.drive_id AND h.ego_id = a.ego_id AND h.seg = a.seg
    WHERE h.t_start_ns - a.t_last_ns <= h.max_gap_ns
    UNION ALL
    SELECT a.* EXCLUDE (seg, t_first_ns, t_last_ns), h.* EXCLUDE (drive_id, ego_id, max_gap_ns)
    FROM _applicable_part a JOIN _hole h ON h.drive_id = a.drive_id AND h.ego_id = a.ego_id AND h.seg = a.seg - 1
    WHERE a.t_first_ns - h.t_end_ns <= h.max_gap_ns
), _hole_of_key AS (
    SELECT *, count(*) AS n_sides FROM _side GROUP BY ALL
)
SELECT h.rule_no, h.drive_id, h.ego_id, h.object_id, h.profile, h.t_start_ns, h.t_end_ns, h.t_start_ns AS t_worst_ns,
    h.t_start_ns AS t_decides_ns, 'unknown' AS verdict, 'log_hole' AS code,
    greatest(1, (h.t_end_ns - h.t_start_ns) // greatest(h.period_ns, 1) - 1) AS n_expected, 0 AS n_judged
FROM _hole_of_key h
JOIN _rule r ON r.rule_no = h.rule_no
LEFT JOIN pair p ON p.drive_id = h.drive_id AND p.ego_id = h.ego_id AND p.t_ns = h.t_start_ns AND p.object_id::VARCHAR = h.object_id
LEFT JOIN pair q ON q.drive_id = h.drive_id AND q.ego_id = h.ego_id AND q.t_ns = h.t_end_ns AND q.object_id::VARCHAR = h.object_id
WHERE h.n_sides = 2 OR h.object_id = '' OR r.own_grid OR (p.t_ns IS NOT NULL AND q.t_ns IS NOT NULL)
