-- The boxes of actors whose paths may meet, in the cells where they may meet. Between two samples, a box moves straight on. Moments are
-- interpolated so that a box never moves by more than half its length between two of them.
-- lifetime: part
CREATE TABLE _swept_box (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- an actor of meeting, ego or not; only in the cells of its visits and the cells around them
    t_ns BIGINT NOT NULL,             -- a sample with position, heading and size, or an interpolated moment between two continuous samples
    t_sample_ns BIGINT NOT NULL,      -- time of the nearest sample {position}
    cell BIGINT NOT NULL,             -- visit of that sample, see _meeting: the grid cell {position}
    slot INTEGER NOT NULL,            -- visit of that sample: number of the 10 s slot {position}
    heading INTEGER NOT NULL,         -- visit of that sample: number of the 5-degree heading step {heading}
    ix INTEGER NOT NULL,              -- column of the drive's grid that contains the box centre {position}
    iy INTEGER NOT NULL,              -- row of the drive's grid that contains the box centre {position}
    cell_m DOUBLE NOT NULL,           -- width of the drive's grid cells {position}
    x_m DOUBLE NOT NULL,              -- box centre, x {position}
    y_m DOUBLE NOT NULL,              -- box centre, y {position}
    z_m DOUBLE,                       -- height of the box centre, see state_dynamics {position}
    travel_rad DOUBLE NOT NULL,       -- direction of travel, see state_dynamics {heading}
    half_length_m DOUBLE NOT NULL,    -- half the box's length {size}
    half_width_m DOUBLE NOT NULL,     -- half the box's width {size}
    cos_yaw DOUBLE NOT NULL,          -- cosine of the heading {heading}
    sin_yaw DOUBLE NOT NULL,          -- sine of the heading {heading}
    t_before_ns BIGINT,               -- the previous moment; NULL: the track begins, or there was a hole {position}
    t_after_ns BIGINT                 -- the next moment; NULL: the track ends, or there is a hole {position}
);

INSERT INTO _swept_box BY NAME
WITH
grid_scale AS (
    SELECT drive_id, max(max_gap_ns) AS max_gap_ns, any_value(cell_m) AS cell_m
    FROM (SELECT drive_id, any_value(cell_m) AS cell_m FROM _meeting GROUP BY drive_id) JOIN _ego_clock USING (drive_id)
    GROUP BY drive_id
),
-- The cells in which one of the two actors may be near the other.
meeting_place AS (
    SELECT DISTINCT m.drive_id, m.actor_id, m.cell + cell_key(x.i, y.i) AS cell
    FROM (
        SELECT drive_id, unnest([actor_id, object_id]) AS actor_id, cell FROM _meeting
        UNION
        SELECT drive_id, unnest([actor_id, object_id]), object_cell FROM _meeting
    ) m
    CROSS JOIN (VALUES (-1), (0), (1)) AS x(i) CROSS JOIN (VALUES (-1), (0), (1)) AS y(i)
),
placed_sample AS MATERIALIZED (
    SELECT
        s.drive_id, s.actor_id, s.t_ns, s.x_m, s.y_m, s.z_m, s.yaw_rad, s.travel_rad, s.length_m, s.width_m, g.cell_m, g.max_gap_ns,
        {'t_ns': s.t_ns, 'cell': meeting_cell(s.x_m, s.y_m, g.cell_m), 'slot': meeting_slot(s.t_ns), 'heading': heading_step(s.travel_rad)} AS visit_key,
        lead({'t_ns': s.t_ns, 'x_m': s.x_m, 'y_m': s.y_m, 'yaw_rad': s.yaw_rad, 'travel_rad': s.travel_rad, 'visit_key': visit_key}) OVER w AS next_sample
    FROM state_dynamics s
    JOIN grid_scale g USING (drive_id)
    SEMI JOIN meeting_place p ON p.drive_id = s.drive_id AND p.actor_id = s.actor_id AND p.cell = meeting_cell(s.x_m, s.y_m, g.cell_m)
    WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL AND s.yaw_rad IS NOT NULL AND s.length_m IS NOT NULL AND s.width_m IS NOT NULL
    WINDOW w AS (PARTITION BY s.drive_id, s.actor_id ORDER BY s.t_ns)
),
moment AS (
    SELECT drive_id, actor_id, length_m, width_m, cell_m, max_gap_ns, x_m, y_m, z_m, yaw_rad, travel_rad, t_ns, visit_key FROM placed_sample
    UNION ALL
    SELECT
        drive_id, actor_id, length_m, width_m, cell_m, max_gap_ns, x_m + u * (next_sample.x_m - x_m), y_m + u * (next_sample.y_m - y_m), z_m,
        yaw_rad + u * wrap_rad(next_sample.yaw_rad - yaw_rad), travel_rad + u * wrap_rad(next_sample.travel_rad - travel_rad),
        t_ns + round(u * (next_sample.t_ns - t_ns))::BIGINT, CASE WHEN u < 0.5 THEN visit_key ELSE next_sample.visit_key END
    FROM (
        SELECT *, unnest(range(1, n_parts)) / n_parts AS u
        FROM (
            SELECT *, sqrt((next_sample.x_m - x_m) ** 2 + (next_sample.y_m - y_m) ** 2) AS way_m, ceil(2 * way_m / length_m)::BIGINT AS n_parts
            FROM placed_sample
            WHERE next_sample.t_ns - t_ns <= max_gap_ns
        )
        WHERE n_parts > 1 AND way_m <= jump_mps() * (next_sample.t_ns - t_ns) / 1e9
    )
)
SELECT
    drive_id, actor_id, t_ns, visit_key.t_ns AS t_sample_ns, visit_key.cell AS cell, visit_key.slot AS slot, visit_key.heading AS heading,
    floor(x_m / cell_m)::INTEGER AS ix, floor(y_m / cell_m)::INTEGER AS iy, cell_m, x_m, y_m, z_m, travel_rad,
    length_m / 2 AS half_length_m, width_m / 2 AS half_width_m, cos(yaw_rad) AS cos_yaw, sin(yaw_rad) AS sin_yaw,
    CASE WHEN t_ns - lag(t_ns) OVER w <= max_gap_ns THEN lag(t_ns) OVER w END AS t_before_ns,
    CASE WHEN lead(t_ns) OVER w - t_ns <= max_gap_ns THEN lead(t_ns) OVER w END AS t_after_ns
FROM moment
WINDOW w AS (PARTITION BY drive_id, actor_id ORDER BY t_ns)
