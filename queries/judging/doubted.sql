-- The steps at which something of the ego, or of another actor, is doubted. `rule_no`: a rule that uses the quantity.
CREATE OR REPLACE TEMP TABLE _doubted AS
SELECT q.rule_no, s.drive_id, s.ego_id, d.actor_id::VARCHAR AS actor_id, s.t_ns, min({'code': d.code, 'quantity': d.quantity}) AS doubt
FROM doubt d
JOIN step s ON s.drive_id = d.drive_id AND s.t_ns BETWEEN d.t_from_ns AND d.t_to_ns
JOIN _rule_quantity q ON q.quantity = d.quantity
GROUP BY ALL
