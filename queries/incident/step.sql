-- The steps of one ego with one other actor: where both were and how they moved. Without that actor, or where it is not placed, its columns
-- are NULL. So are the offsets from the lane where there is no map: the lane is then the ego's own way.
SELECT
    e.t_ns, e.x_m, e.y_m, e.yaw_rad, e.length_m, e.width_m, e.speed_mps, v.vx_mps, v.vy_mps, CASE WHEN g.environment_id IS NOT NULL THEN e.d_m END AS lane_offset_m, e.lanelet_id, e.with_traffic,
    p.x_m AS object_x_m, p.y_m AS object_y_m, p.yaw_rad AS object_yaw_rad, p.length_m AS object_length_m, p.width_m AS object_width_m,
    CASE WHEN p.x_m IS NOT NULL THEN p.speed_mps END AS object_speed_mps,
    CASE WHEN p.x_m IS NOT NULL THEN o.vx_mps END AS object_vx_mps, CASE WHEN p.x_m IS NOT NULL THEN o.vy_mps END AS object_vy_mps,
    CASE WHEN g.environment_id IS NOT NULL THEN p.d_m END AS object_lane_offset_m, p.heading_diff_rad, CASE WHEN NOT p.clearance_is_bound THEN p.clearance_m END AS clearance_m,
    x.t0_ns AS out_since_ns
FROM ego_state e
JOIN data_log g USING (drive_id)
JOIN state_dynamics v ON v.drive_id = e.drive_id AND v.actor_id = e.ego_id AND v.t_ns = e.t_ns
LEFT JOIN (FROM pair WHERE object_id = $object_id) p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.t_ns = e.t_ns
-- The other actor may have samples at other times.
ASOF LEFT JOIN (FROM state_dynamics WHERE actor_id = $object_id) o ON o.drive_id = e.drive_id AND o.t_ns <= e.t_ns
-- How long the ego has been out of its lane. No rule may have asked for it: the table is empty then.
LEFT JOIN (FROM excursion WHERE ego_id = $ego_id) x ON x.drive_id = e.drive_id AND e.t_ns >= x.t0_ns AND e.t_ns <= coalesce(x.t_back_ns, x.t_end_ns)
WHERE e.ego_id = $ego_id
QUALIFY row_number() OVER (PARTITION BY e.t_ns ORDER BY x.t0_ns NULLS LAST) = 1
ORDER BY e.t_ns
