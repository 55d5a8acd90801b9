-- The left and right points of the danger spaces at the steps of `_around`.
WITH step_with_map AS (
    SELECT DISTINCT a.drive_id, a.ego_id, a.t_ns, l.environment_id FROM _around a JOIN data_log l USING (drive_id)
),
extent AS (
    SELECT DISTINCT m.drive_id, m.ego_id, m.t_ns, m.environment_id, e.chain_id, m.ego_id AS actor_id, o.sd_av_m AS length_m,
        o.ds_av_s_m AS s0, o.ds_av_s_m + o.sd_av_m AS s1, o.ds_av_d_m AS d_m, o.ds_av_half_m AS half_m
    FROM step_with_map m
    JOIN overtake_step o USING (drive_id, ego_id, t_ns)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    UNION
    SELECT DISTINCT m.drive_id, m.ego_id, m.t_ns, m.environment_id, e.chain_id, o.ov_id, o.sd_ov_m,
        o.ds_ov_s_m - o.sd_ov_m, o.ds_ov_s_m, o.ds_ov_d_m, o.ds_ov_half_m
    FROM step_with_map m
    JOIN overtake_step o USING (drive_id, ego_id, t_ns)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    WHERE o.ov_id IS NOT NULL
),
piece AS (  -- the corridor's segments under a danger space, cut at its ends
    SELECT x.*, c.s_start_m + g.s0_m AS at_m, g.len_m, g.x0_m, g.y0_m, g.x1_m, g.y1_m, g.tx0, g.ty0, g.tx1, g.ty1,
        greatest(0.0, (x.s0 - c.s_start_m - g.s0_m) / g.len_m) AS u0, least(1.0, (x.s1 - c.s_start_m - g.s0_m) / g.len_m) AS u1
    FROM extent x
    JOIN chain c ON c.drive_id = x.drive_id AND c.ego_id = x.ego_id AND c.chain_id = x.chain_id
    JOIN _lane_segment g ON g.environment_id = x.environment_id AND g.lanelet_id = c.lanelet_id
    WHERE x.length_m > 0 AND g.len_m > 0 AND x.half_m IS NOT NULL
        AND c.s_start_m + g.s0_m < x.s1 AND c.s_start_m + g.s0_m + g.len_m > x.s0
),
edge AS (
    SELECT DISTINCT drive_id, ego_id, t_ns, actor_id, length_m, d_m, half_m, round(at_m + u * len_m, 2) AS s_m,
        first(x0_m + u * (x1_m - x0_m) ORDER BY at_m) AS x_m, first(y0_m + u * (y1_m - y0_m) ORDER BY at_m) AS y_m,
        first(tx0 + u * (tx1 - tx0) ORDER BY at_m) AS tx, first(ty0 + u * (ty1 - ty0) ORDER BY at_m) AS ty
    FROM (SELECT *, unnest([u0, u1]) AS u FROM piece)
    GROUP BY ALL
)
SELECT drive_id, ego_id, actor_id, t_ns, round(length_m, 3) AS length_m,
    x_m - ty * (d_m + half_m) AS lx_m, y_m + tx * (d_m + half_m) AS ly_m,
    x_m - ty * (d_m - half_m) AS rx_m, y_m + tx * (d_m - half_m) AS ry_m,
    dense_rank() OVER (ORDER BY drive_id, ego_id, t_ns, actor_id) AS ring
FROM edge
QUALIFY count(*) OVER (PARTITION BY drive_id, ego_id, t_ns, actor_id) > 1
ORDER BY ring, s_m
