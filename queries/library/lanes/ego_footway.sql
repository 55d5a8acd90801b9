-- How far the outline of the ego (corners and middles of the sides), or of a trailer that it tows, is inside footways. A point that is also
-- on a drivable lanelet is on the carriageway: in junctions the footways of connecting roads lie across other roads.
-- lifetime: part
CREATE TABLE ego_footway (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    depth_m DOUBLE                    -- how deep a corner or the middle of a side is inside a footway and outside every carriageway; 0: not inside; NULL: the box is not known, or part of it is outside every lane of the map {position, heading, size}
);

INSERT INTO ego_footway BY NAME
WITH ego_box AS (
    SELECT st.drive_id, st.ego_id, st.t_ns, o.actor_id, s.x_m, s.y_m, s.yaw_rad, s.length_m / 2 AS half_box_length_m, s.width_m / 2 AS half_box_width_m, g.environment_id
    FROM step st
    JOIN _ego_actor o USING (drive_id, ego_id)
    LEFT JOIN state_dynamics s ON s.drive_id = st.drive_id AND s.actor_id = o.actor_id AND s.t_ns = st.t_ns
    JOIN data_log g ON g.drive_id = st.drive_id
),
outline_point AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, e.actor_id, c.p, e.environment_id,
        x_m + c.l * half_box_length_m * cos(yaw_rad) - c.w * half_box_width_m * sin(yaw_rad) AS x_m,
        y_m + c.l * half_box_length_m * sin(yaw_rad) + c.w * half_box_width_m * cos(yaw_rad) AS y_m
    FROM ego_box e CROSS JOIN (VALUES (1, 1, 1), (2, 1, -1), (3, -1, 1), (4, -1, -1), (5, 0, 1), (6, 0, -1), (7, 1, 0), (8, -1, 0)) AS c(p, l, w)
    WHERE x_m IS NOT NULL AND y_m IS NOT NULL AND yaw_rad IS NOT NULL AND half_box_length_m IS NOT NULL AND half_box_width_m IS NOT NULL
),
point_candidate AS (
    SELECT
        a.drive_id, a.ego_id, a.t_ns, a.actor_id, a.p, a.x_m, a.y_m, c.* EXCLUDE (environment_id, cell),
        along0(a.x_m, a.y_m, c.x0_m, c.y0_m, c.tx0, c.ty0) AS a0,
        along1(a.x_m, a.y_m, c.x1_m, c.y1_m, c.tx1, c.ty1) AS a1
    FROM outline_point a
    JOIN _lane_cell c ON c.environment_id = a.environment_id AND c.cell = lane_cell_of(a.x_m, a.y_m)
),
point_depth AS (
    SELECT
        drive_id, ego_id, t_ns, actor_id, p, bool_or(drivable) AS on_carriageway, max(depth_m) FILTER (footway) AS depth_m
    FROM (
        SELECT
            *,
            hw0_m + a0 / (a0 + a1) * (hw1_m - hw0_m)
            - abs(offset_left(x_m, y_m, a0 / (a0 + a1), x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1)) AS depth_m
        FROM point_candidate
        WHERE a0 >= -slack0_m AND a1 > -slack1_m AND a0 + a1 > 0 AND footway IS NOT NULL
    )
    WHERE depth_m > -0.02
    GROUP BY ALL
),
outline_depth AS (
    SELECT drive_id, ego_id, t_ns, actor_id, count(*) AS n_points, max(depth_m) FILTER (NOT on_carriageway) AS depth_m FROM point_depth GROUP BY ALL
)
SELECT
    e.drive_id, e.ego_id, e.t_ns,
    -- A point on no lanelet of the map may be on a footway that the map lacks.
    CASE WHEN max(d.depth_m) > 0 OR bool_and(coalesce(d.n_points = 8, false)) THEN greatest(coalesce(max(d.depth_m), 0.0), 0.0) END AS depth_m
FROM ego_box e
LEFT JOIN outline_depth d USING (drive_id, ego_id, t_ns, actor_id)
GROUP BY ALL
