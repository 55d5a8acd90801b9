-- The points of the chains on which the danger spaces of overtake_space.sql lie.
SELECT c.drive_id, c.ego_id, c.chain_id, c.s_start_m + p.s_m AS s_m, p.x_m, p.y_m, p.z_m, p.tx, p.ty
FROM _corridor c
SEMI JOIN (
    SELECT e.drive_id, e.ego_id, e.chain_id
    FROM overtake_step o JOIN ego_state e USING (drive_id, ego_id, t_ns)
) u ON u.drive_id = c.drive_id AND u.ego_id = c.ego_id AND u.chain_id = c.chain_id
JOIN data_log l ON l.drive_id = c.drive_id
JOIN lane_point p ON p.environment_id = l.environment_id AND p.lanelet_id = c.lanelet_id
WHERE list_contains($ids, c.drive_id)
ORDER BY c.drive_id, c.ego_id, c.chain_id, c.seq, p.k
