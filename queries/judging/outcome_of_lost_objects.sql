-- One unknown row per object whose track ends while it could still have been there.
INSERT INTO _outcome BY NAME
SELECT $_no AS rule_no, l.drive_id, l.ego_id, l.object_id, {profile} AS profile,
    l.t_from_ns AS t_start_ns, l.t_to_ns AS t_end_ns, t.t_ns AS t_worst_ns, t.t_ns AS t_decides_ns, 'unknown' AS verdict, l.code,
    why('recorded_too_short', {'object_id': l.object_id, 'to_ns': t.t_ns,
        'far_m': CASE WHEN q.clearance_is_bound THEN q.distance_m ELSE coalesce(q.clearance_m, q.distance_m) END,
        'ego_to_ns': s.t_end_ns}) AS reason,
    greatest(1, (l.t_to_ns - t.t_ns) // greatest(s.period_ns, 1)) AS n_expected, 0 AS n_judged
FROM lost_object l JOIN _subject s USING (drive_id, ego_id) {profiles}
CROSS JOIN LATERAL (SELECT l.t_from_ns - 1 AS t_ns) t
LEFT JOIN pair q ON q.drive_id = l.drive_id AND q.ego_id = l.ego_id AND q.object_id = l.object_id AND q.t_ns = t.t_ns
{condition_joins}
{todo}
WHERE ({in_force}) IS DISTINCT FROM false
