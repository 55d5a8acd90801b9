-- Lanelets cut into straight pieces between consecutive points, with the tangents at both ends.
SELECT
    environment_id, lanelet_id, k, s_m AS s0_m, next.s_m - s_m AS len_m,
    x_m AS x0_m, y_m AS y0_m, tx AS tx0, ty AS ty0, half_width_m AS hw0_m,
    next.x_m AS x1_m, next.y_m AS y1_m, next.tx AS tx1, next.ty AS ty1, next.half_width_m AS hw1_m,
    CASE WHEN k = 0 THEN 0.05 ELSE 0.0 END AS slack0_m,
    CASE WHEN next.is_last THEN 0.05 ELSE 0.0 END AS slack1_m
FROM (
    SELECT
        *,
        lead({
            's_m': s_m, 'x_m': x_m, 'y_m': y_m, 'tx': tx, 'ty': ty, 'half_width_m': half_width_m,
            'is_last': k = n_points - 1
        }) OVER (PARTITION BY environment_id, lanelet_id ORDER BY k) AS next
    FROM (SELECT *, count(*) OVER (PARTITION BY environment_id, lanelet_id) AS n_points FROM lane_point)
)
WHERE next IS NOT NULL AND next.s_m > s_m
