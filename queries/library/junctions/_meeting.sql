-- Pairs of visits at which two paths may meet at an angle, found by grid alone. A visit groups the samples of one actor in one grid cell,
-- one 10 s slot and one 5-degree heading step. Its box contains the whole area that the actor covers in these samples.
-- lifetime: part
CREATE TABLE _meeting (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    actor_id VARCHAR NOT NULL,        -- the ego, or a trailer of the ego, whose box this visit belongs to
    cell_m DOUBLE NOT NULL,           -- width of the drive's grid cells: the greatest distance between the centres of two boxes that touch {position}
    cell BIGINT NOT NULL,             -- visit of that box: the grid cell of its centre {position}
    slot INTEGER NOT NULL,            -- visit of that box: number of the 10 s slot {position}
    heading INTEGER NOT NULL,         -- visit of that box: number of the 5-degree heading step {heading}
    object_id VARCHAR NOT NULL,       -- another actor, which moves at some time
    object_cell BIGINT NOT NULL,      -- visit of the object: the grid cell; the boxes around both visits overlap, and the headings may differ by more than 20 degrees {position}
    object_slot INTEGER NOT NULL,     -- visit of the object: number of the 10 s slot {position}
    object_heading INTEGER NOT NULL   -- visit of the object: number of the 5-degree heading step {heading}
);

INSERT INTO _meeting BY NAME
WITH
-- An actor that never moves has no path to meet. Another rule judges contact with it.
moving_actor AS (
    SELECT drive_id, actor_id, max(length_m) AS length_m, max(width_m) AS width_m, max(speed_mps) AS speed_mps
    FROM state_dynamics
    GROUP BY drive_id, actor_id
    HAVING bool_or(coalesce(speed_mps > standing_mps(), true))
),
grid AS (
    SELECT drive_id, max(max_gap_s) AS max_gap_s, 2 * max(sqrt(driven_half_m(length_m, speed_mps, max_gap_s) ** 2 + (width_m / 2) ** 2)) + 0.1 AS cell_m
    FROM moving_actor JOIN (SELECT drive_id, max(max_gap_ns) / 1e9 AS max_gap_s FROM _ego_clock GROUP BY drive_id) USING (drive_id)
    GROUP BY drive_id
    HAVING cell_m IS NOT NULL
),
box AS (
    SELECT
        s.drive_id, s.actor_id, s.x_m, s.y_m, g.cell_m, meeting_cell(s.x_m, s.y_m, g.cell_m) AS cell, meeting_slot(s.t_ns) AS slot,
        heading_step(s.travel_rad) AS heading,
        driven_half_m(s.length_m, s.speed_mps, g.max_gap_s) AS half_length_m, s.width_m / 2 AS half_width_m, abs(cos(s.yaw_rad)) AS c, abs(sin(s.yaw_rad)) AS s
    FROM state_dynamics s
    JOIN grid g USING (drive_id)
    SEMI JOIN moving_actor m USING (drive_id, actor_id)
    WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL AND s.yaw_rad IS NOT NULL AND s.length_m IS NOT NULL AND s.width_m IS NOT NULL
),
visit AS MATERIALIZED (
    SELECT
        drive_id, actor_id, cell, slot, heading, max(cell_m) AS cell_m,
        min(x_m - half_length_m * c - half_width_m * s) AS x_min_m, max(x_m + half_length_m * c + half_width_m * s) AS x_max_m, min(y_m - half_length_m * s - half_width_m * c) AS y_min_m, max(y_m + half_length_m * s + half_width_m * c) AS y_max_m
    FROM box
    GROUP BY drive_id, actor_id, cell, slot, heading
),
-- A trailer that the ego tows is part of the ego.
ego_visit AS (SELECT o.ego_id, v.* FROM visit v JOIN _ego_actor o USING (drive_id, actor_id)),
nearby_cell AS (
    SELECT v.*, v.cell + cell_key(x.i, y.i) AS near_cell, v.slot + t.i AS near_slot
    FROM ego_visit v
    CROSS JOIN (VALUES (-1), (0), (1)) AS x(i) CROSS JOIN (VALUES (-1), (0), (1)) AS y(i) CROSS JOIN (VALUES (-1), (0), (1)) AS t(i)
)
SELECT
    e.drive_id, e.ego_id, e.actor_id, e.cell_m, e.cell, e.slot, e.heading,
    o.actor_id AS object_id, o.cell AS object_cell, o.slot AS object_slot, o.heading AS object_heading
FROM nearby_cell e
JOIN visit o ON o.drive_id = e.drive_id AND o.cell = e.near_cell AND o.slot = e.near_slot AND o.actor_id <> e.ego_id
ANTI JOIN _ego_part p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.object_id = o.actor_id
WHERE heading_steps_apart(o.heading, e.heading) > 3 AND o.x_min_m <= e.x_max_m AND o.x_max_m >= e.x_min_m AND o.y_min_m <= e.y_max_m AND o.y_max_m >= e.y_min_m
