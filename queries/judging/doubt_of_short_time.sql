-- A step of an invariant that is in doubt between two that are not counts as one that was not recorded: a sample may be missing now and then.
DELETE FROM _judged
USING (
    SELECT d.rule_no, d.drive_id, d.ego_id, d.actor_id, d.t_ns
    FROM _doubted d
    JOIN _segment s ON s.drive_id = d.drive_id AND s.ego_id = d.ego_id AND d.t_ns > s.t_first_ns AND d.t_ns < s.t_last_ns
    JOIN _rule r ON r.rule_no = d.rule_no AND r.kind = 'invariant'
    WHERE d.is_short
) x
WHERE x.rule_no = _judged.rule_no AND x.drive_id = _judged.drive_id AND x.ego_id = _judged.ego_id AND x.t_ns = _judged.t_ns
    AND (x.actor_id = _judged.ego_id OR x.actor_id = _judged.object_id)
