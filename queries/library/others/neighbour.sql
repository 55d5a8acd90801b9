-- The actors near the ego, with their positions along and across its corridor. The table pair is large, and few of its rows are near: every
-- query for neighbours reads this table instead.
-- lifetime: part
CREATE TABLE neighbour (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    k INTEGER NOT NULL,               -- see step
    seg INTEGER NOT NULL,             -- see step
    object_id VARCHAR NOT NULL,       -- an actor in the corridor's strip, at most 30 m from the ego, box to box
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    chain_id INTEGER NOT NULL,        -- the running chain of the ego
    ahead_m DOUBLE NOT NULL,          -- distance from the ego's front to the object's front, positive ahead {position}
    gap_ahead_m DOUBLE NOT NULL,      -- distance from the ego's front to the object's rear {position, heading, size}
    gap_behind_m DOUBLE NOT NULL,     -- distance from the object's front to the ego's rear {position, heading, size}
    d_m DOUBLE NOT NULL,              -- see pair {position}
    lat_half_m DOUBLE NOT NULL,       -- see pair {heading, size}
    half_width_m DOUBLE NOT NULL,     -- see pair
    heading_diff_rad DOUBLE NOT NULL, -- see pair {heading}
    side VARCHAR NOT NULL,            -- [side] the side of the ego on which the object is {position}
    gap_m DOUBLE NOT NULL,            -- see beside {position, heading, size}
    clearance_m DOUBLE,               -- see pair {position, heading, size}
    ego_speed_mps DOUBLE,             -- speed of the ego {velocity}
    speed_mps DOUBLE,                 -- speed of the object {velocity}
    ego_left_mps DOUBLE               -- the ego's speed across the corridor, left positive: from its velocity if known, else from speed and heading {velocity}
);

INSERT INTO neighbour BY NAME
SELECT
    p.drive_id, p.ego_id, p.t_ns, st.k, st.seg, p.object_id, p.actor_class, e.chain_id,
    p.front_s_m - e.front_s_m AS ahead_m, p.rear_s_m - e.front_s_m AS gap_ahead_m, e.rear_s_m - p.front_s_m AS gap_behind_m,
    p.d_m, p.lat_half_m, p.half_width_m, p.heading_diff_rad,
    -- If the ego heads against the corridor, left and right are exchanged.
    CASE WHEN (p.d_m > e.d_m) = (abs(e.heading_diff_rad) <= pi() / 2) THEN 'left' ELSE 'right' END AS side,
    abs(p.d_m - e.d_m) - p.lat_half_m - e.lat_half_m AS gap_m, p.clearance_m, e.speed_mps AS ego_speed_mps, p.speed_mps,
    coalesce(g.vy_mps * cos(e.yaw_rad - e.heading_diff_rad) - g.vx_mps * sin(e.yaw_rad - e.heading_diff_rad), e.speed_mps * sin(e.heading_diff_rad)) AS ego_left_mps
FROM pair p
JOIN ego_state e USING (drive_id, ego_id, t_ns)
JOIN step st USING (drive_id, ego_id, t_ns)
JOIN state_dynamics g ON g.drive_id = e.drive_id AND g.actor_id = e.ego_id AND g.t_ns = e.t_ns
WHERE NOT p.clearance_is_bound AND p.front_s_m IS NOT NULL AND e.front_s_m IS NOT NULL
