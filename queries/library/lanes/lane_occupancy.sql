-- Every lanelet that contains the centre of an actor's box: the grid cell gives the candidates, arithmetic decides. The lateral tolerance
-- is 2 cm, because the bounds of neighbouring lanes are chords of different curves. If lanes are over each other, an actor is on the lane
-- at its height, if the log and the map have heights.
-- lifetime: part
CREATE TABLE lane_occupancy (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor
    t_ns BIGINT NOT NULL,             -- time stamp
    lanelet_id VARCHAR,               -- a lanelet that contains the box centre, one row per lanelet; NULL: on none, or no position
    s_m DOUBLE,                       -- station of the centre along the lanelet {position}
    d_m DOUBLE,                       -- offset from the lanelet's centre line, left of travel positive {position}
    half_width_m DOUBLE,              -- half the lanelet's width there
    heading_diff_rad DOUBLE,          -- the actor's heading relative to the lane's direction, -pi..pi {heading}
    drivable BOOLEAN                  -- see lanelet {position}
);

INSERT INTO lane_occupancy BY NAME
WITH lane_candidate AS (
    SELECT
        a.drive_id, a.actor_id, a.t_ns, a.x_m, a.y_m, a.yaw_rad, c.* EXCLUDE (environment_id, cell, footway),
        along0(a.x_m, a.y_m, c.x0_m, c.y0_m, c.tx0, c.ty0) AS a0,
        along1(a.x_m, a.y_m, c.x1_m, c.y1_m, c.tx1, c.ty1) AS a1
    FROM state_dynamics a
    JOIN data_log l USING (drive_id)
    JOIN _lane_cell c ON c.environment_id = l.environment_id AND c.cell = lane_cell_of(a.x_m, a.y_m)
),
lane_place AS (
    SELECT *, a0 / (a0 + a1) AS u, offset_left(x_m, y_m, a0 / (a0 + a1), x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1) AS d_m
    FROM lane_candidate
    WHERE a0 >= -slack0_m AND a1 > -slack1_m AND a0 + a1 > 0
),
lane_match AS (
    SELECT
        drive_id, actor_id, t_ns, lanelet_id, s0_m + u * len_m AS s_m, d_m, hw0_m + u * (hw1_m - hw0_m) AS half_width_m,
        wrap_rad(yaw_rad - atan2(ty0 + u * (ty1 - ty0), tx0 + u * (tx1 - tx0))) AS heading_diff_rad, drivable
    FROM lane_place
    WHERE abs(d_m) <= hw0_m + u * (hw1_m - hw0_m) + 0.02
),
-- Lanes over or under another lane, below an actor with a height: whether the lane has the actor's height there.
lane_height AS (
    SELECT p.environment_id, p.lanelet_id, p.s_m, p.z_m, lead(p.s_m) OVER w AS s_next_m, lead(p.z_m) OVER w AS z_next_m
    FROM lane_point p
    SEMI JOIN _lane_apart a ON a.environment_id = p.environment_id AND a.lanelet_id = p.lanelet_id
    WINDOW w AS (PARTITION BY p.environment_id, p.lanelet_id ORDER BY p.k)
),
match_height AS (
    SELECT
        m.drive_id, m.actor_id, m.t_ns, h.environment_id, m.lanelet_id,
        same_level(s.z_m, h.z_m + coalesce((m.s_m - h.s_m) / (h.s_next_m - h.s_m) * (h.z_next_m - h.z_m), 0.0)) AS is_same
    FROM state_dynamics s
    JOIN lane_match m USING (drive_id, actor_id, t_ns)
    JOIN data_log g ON g.drive_id = m.drive_id
    ASOF JOIN lane_height h ON h.environment_id = g.environment_id AND h.lanelet_id = m.lanelet_id AND h.s_m <= m.s_m + 0.1
    WHERE s.z_m IS NOT NULL
),
match_off_level AS (
    SELECT DISTINCT m.drive_id, m.actor_id, m.t_ns, m.lanelet_id
    FROM (FROM match_height WHERE NOT is_same) m
    JOIN _lane_apart a ON a.environment_id = m.environment_id AND a.lanelet_id = m.lanelet_id
    JOIN (FROM match_height WHERE is_same) o ON o.drive_id = m.drive_id AND o.actor_id = m.actor_id AND o.t_ns = m.t_ns AND o.lanelet_id = a.other_id
)
-- Lanes over each other are rare. Without such lanes, all matches are returned directly: the anti join below would hash all of them.
SELECT * FROM lane_match WHERE (SELECT count(*) FROM match_off_level) = 0
UNION ALL BY NAME
SELECT * FROM lane_match ANTI JOIN match_off_level USING (drive_id, actor_id, t_ns, lanelet_id) WHERE (SELECT count(*) FROM match_off_level) > 0
UNION ALL BY NAME
SELECT drive_id, actor_id, t_ns FROM state_dynamics s ANTI JOIN lane_match f USING (drive_id, actor_id, t_ns)
