SELECT
    drive_id, ego_id, t_ns,
    (row_number() OVER w - 1)::INTEGER AS k,
    dt_ns,
    (sum(CASE WHEN dt_ns > max_gap_ns THEN 1 ELSE 0 END) OVER (w ROWS UNBOUNDED PRECEDING))::INTEGER AS seg
FROM (
    SELECT c.drive_id, c.ego_id, a.t_ns, c.max_gap_ns, a.t_ns - lag(a.t_ns) OVER (PARTITION BY c.drive_id, c.ego_id ORDER BY a.t_ns) AS dt_ns
    FROM clock c JOIN actor_state a ON a.drive_id = c.drive_id AND a.actor_id = c.ego_id
)
WINDOW w AS (PARTITION BY drive_id, ego_id ORDER BY t_ns)
