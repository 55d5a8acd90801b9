-- The steps at which something of the ego, or of another actor, is doubted. `rule_no`: a rule that uses the quantity. `is_short`: the doubt
-- lasts no longer than a sample may be missing.
CREATE OR REPLACE TEMP TABLE _doubted AS
SELECT q.rule_no, s.drive_id, s.ego_id, d.actor_id::VARCHAR AS actor_id, s.t_ns, min({'code': d.code, 'quantity': d.quantity}) AS doubt,
    bool_and(d.t_to_ns - d.t_from_ns <= u.max_gap_ns) AS is_short
FROM doubt d
JOIN step s ON s.drive_id = d.drive_id AND s.t_ns BETWEEN d.t_from_ns AND d.t_to_ns
JOIN _subject u ON u.drive_id = s.drive_id AND u.ego_id = s.ego_id
JOIN _rule_quantity q ON q.quantity = d.quantity
GROUP BY ALL
