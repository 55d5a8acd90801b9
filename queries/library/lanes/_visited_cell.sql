-- The cells that an actor visited at some time: the corridor is searched only there.
-- lifetime: part
CREATE TABLE _visited_cell (
    drive_id VARCHAR NOT NULL,        -- the drive
    cell BIGINT NOT NULL              -- 4 m grid cell that at some time contained the centre of an actor or a corner of an ego
);

INSERT INTO _visited_cell BY NAME
SELECT drive_id, corridor_cell_of(x_m, y_m) AS cell
FROM state_dynamics
WHERE x_m IS NOT NULL AND y_m IS NOT NULL
UNION
SELECT
    s.drive_id,
    corridor_cell_of(
        s.x_m + c.l * s.length_m / 2 * cos(s.yaw_rad) - c.w * s.width_m / 2 * sin(s.yaw_rad),
        s.y_m + c.l * s.length_m / 2 * sin(s.yaw_rad) + c.w * s.width_m / 2 * cos(s.yaw_rad)
    ) AS cell
FROM step e
JOIN state_dynamics s ON s.drive_id = e.drive_id AND s.actor_id = e.ego_id AND s.t_ns = e.t_ns
CROSS JOIN (VALUES (1, 1), (1, -1), (-1, 1), (-1, -1)) AS c(l, w)
WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL AND s.yaw_rad IS NOT NULL AND s.length_m IS NOT NULL AND s.width_m IS NOT NULL
