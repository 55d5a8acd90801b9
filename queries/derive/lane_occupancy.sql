-- Every lanelet that holds a box centre, found by grid cell and settled by arithmetic. 2 cm of tolerance sideways: the bounds of
-- neighbouring lanes are chords of different curves.
WITH candidate AS (
    SELECT
        a.drive_id, a.actor_id, a.t_ns, a.x_m, a.y_m, a.yaw_rad, c.* EXCLUDE (environment_id, cell, footway),
        along0(a.x_m, a.y_m, c.x0_m, c.y0_m, c.tx0, c.ty0) AS a0,
        along1(a.x_m, a.y_m, c.x1_m, c.y1_m, c.tx1, c.ty1) AS a1
    FROM state_dynamics a
    JOIN data_log l USING (drive_id)
    JOIN lane_cell c ON c.environment_id = l.environment_id AND c.cell = lane_cell_of(a.x_m, a.y_m)
),
placed AS (
    SELECT *, a0 / (a0 + a1) AS u, offset_left(x_m, y_m, a0 / (a0 + a1), x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1) AS d_m
    FROM candidate
    WHERE a0 >= -slack0_m AND a1 > -slack1_m AND a0 + a1 > 0
),
found AS (
    SELECT
        drive_id, actor_id, t_ns, lanelet_id, s0_m + u * len_m AS s_m, d_m, hw0_m + u * (hw1_m - hw0_m) AS half_width_m,
        wrap_rad(yaw_rad - atan2(ty0 + u * (ty1 - ty0), tx0 + u * (tx1 - tx0))) AS heading_diff_rad, drivable
    FROM placed
    WHERE abs(d_m) <= hw0_m + u * (hw1_m - hw0_m) + 0.02
)
SELECT * FROM found
UNION ALL BY NAME
SELECT drive_id, actor_id, t_ns FROM state_dynamics s ANTI JOIN found f USING (drive_id, actor_id, t_ns)
