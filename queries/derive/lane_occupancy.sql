-- Every lanelet that holds a box centre, found by grid cell and settled by arithmetic. 2 cm of tolerance sideways: the bounds of
-- neighbouring lanes are chords of different curves.
WITH candidate AS (
    SELECT
        a.drive_id, a.actor_id, a.t_ns, a.x_m, a.y_m, a.yaw_rad, l.environment_id, g.*,
        along0(a.x_m, a.y_m, g.x0_m, g.y0_m, g.tx0, g.ty0) AS a0,
        along1(a.x_m, a.y_m, g.x1_m, g.y1_m, g.tx1, g.ty1) AS a1
    FROM state_dynamics a
    JOIN data_log l USING (drive_id)
    JOIN lane_cell c ON c.environment_id = l.environment_id AND c.cell = lane_cell_of(a.x_m, a.y_m)
    JOIN lane_segment g ON g.environment_id = c.environment_id AND g.lanelet_id = c.lanelet_id AND g.k = c.k
),
placed AS (
    SELECT
        *, a0 / (a0 + a1) AS u,
        offset_left(x_m, y_m, a0 / (a0 + a1), x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1) AS d_m
    FROM candidate
    WHERE a0 >= -slack0_m AND a1 > -slack1_m AND a0 + a1 > 0
),
inside AS (
    SELECT
        drive_id, actor_id, t_ns, environment_id, lanelet_id, s0_m + u * len_m AS s_m, d_m, hw0_m + u * (hw1_m - hw0_m) AS half_width_m,
        wrap_rad(yaw_rad - atan2(ty0 + u * (ty1 - ty0), tx0 + u * (tx1 - tx0))) AS heading_diff_rad
    FROM placed
    WHERE abs(d_m) <= hw0_m + u * (hw1_m - hw0_m) + 0.02
),
found AS (
    SELECT i.* EXCLUDE (environment_id), n.drivable
    FROM inside i JOIN lanelet n USING (environment_id, lanelet_id)
)
SELECT * FROM found
UNION ALL BY NAME
SELECT drive_id, actor_id, t_ns FROM state_dynamics s ANTI JOIN found f USING (drive_id, actor_id, t_ns)
