-- Every step of the ego with all known values. Its running chain is that of the last lanelet that it drove in the lane's direction. During
-- an overtake in the next lane, this is the chain that the ego left. Before the first such lanelet, it is the ego's first chain.
-- lifetime: part
CREATE TABLE ego_state (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    x_m DOUBLE,                       -- box centre, x {position}
    y_m DOUBLE,                       -- box centre, y {position}
    z_m DOUBLE,                       -- see state_dynamics {position}
    yaw_rad DOUBLE,                   -- heading {heading}
    speed_mps DOUBLE,                 -- speed of the ego {velocity}
    accel_mps2 DOUBLE,                -- see state_dynamics {velocity}
    fastest_3s_mps DOUBLE,            -- highest speed at this step and in the 3 s before it; NULL: the ego stands in the recorded part, and not all 3 s are recorded {velocity}
    travel_m DOUBLE,                  -- distance driven since the first step {position}
    length_m DOUBLE,                  -- box length {size}
    width_m DOUBLE,                   -- box width {size}
    combination_m DOUBLE,             -- length including the trailer that the ego tows; NULL: the trailer's position is not known {size}
    indicator VARCHAR,                -- [indicator] NULL: not known
    lanelet_id VARCHAR,               -- see ego_lane
    with_direction BOOLEAN,           -- see ego_lane {heading}
    with_traffic BOOLEAN,             -- see ego_lane {position}
    in_junction BOOLEAN,              -- on a junction's lanelet; NULL: on no lanelet {position}
    road_type VARCHAR,                -- [road_type] of the lanelet; NULL: the map does not state it
    limit_mps DOUBLE,                 -- speed limit at the ego's position; NULL: see limit_source
    limit_source VARCHAR,             -- [limit_source + none] none: the map states that there is no limit; NULL: it states nothing
    chain_id INTEGER,                 -- the running chain of the ego at this step; NULL: none
    s_m DOUBLE,                       -- chain station of the centre {position}
    d_m DOUBLE,                       -- offset of the centre from the running lane's centre line, left positive {position}
    front_s_m DOUBLE,                 -- chain station of the front bumper {position, heading, size}
    rear_s_m DOUBLE,                  -- chain station of the rear bumper, or of the trailer's rear {position, heading, size}
    lat_half_m DOUBLE,                -- half the extent of the box across the corridor {heading, size}
    heading_diff_rad DOUBLE           -- heading relative to the corridor {heading}
);

INSERT INTO ego_state BY NAME
WITH
-- The rear of the trailer is the rear of the combination. reach_m is its distance from the ego's centre; NULL: the trailer's position is
-- not known.
trailer_reach AS (
    SELECT p.drive_id, p.ego_id, e.t_ns, max(sqrt((s.x_m - e.x_m) ** 2 + (s.y_m - e.y_m) ** 2) + s.length_m / 2) AS reach_m
    FROM _ego_part p
    JOIN state_dynamics e ON e.drive_id = p.drive_id AND e.actor_id = p.ego_id
    LEFT JOIN state_dynamics s ON s.drive_id = p.drive_id AND s.actor_id = p.object_id AND s.t_ns = e.t_ns
    WHERE p.part = 'trailer'
    GROUP BY ALL
),
running_chain AS (
    SELECT st.drive_id, st.ego_id, st.t_ns, st.seg, st.travel_m, coalesce(c.chain_id, f.chain_id) AS chain_id
    FROM step st
    ASOF LEFT JOIN (SELECT * FROM chain WHERE t_first_ns IS NOT NULL) c
        ON c.drive_id = st.drive_id AND c.ego_id = st.ego_id AND c.t_first_ns <= st.t_ns
    LEFT JOIN (SELECT drive_id, ego_id, min(chain_id) AS chain_id FROM chain GROUP BY ALL) f
        ON f.drive_id = st.drive_id AND f.ego_id = st.ego_id
),
step_limit AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, min(v.limit_mps) AS limit_mps,
        coalesce(arg_min(v.source, {'m': v.limit_mps, 'by': v.source}) FILTER (v.limit_mps IS NOT NULL), CASE WHEN bool_or(v.source = 'unread') THEN 'unread' ELSE 'none' END) AS limit_source
    FROM ego_lane e
    JOIN data_log l USING (drive_id)
    JOIN lanelet n ON n.environment_id = l.environment_id AND n.lanelet_id = e.lanelet_id
    JOIN speed_limit v ON v.environment_id = l.environment_id AND v.lanelet_id = e.lanelet_id
    -- A lanelet contains points slightly beyond its ends. Where two limits meet, the lower one counts.
    WHERE greatest(0.0, least(e.s_m, n.length_m)) BETWEEN v.s_start_m AND v.s_end_m
    GROUP BY ALL
)
SELECT
    r.drive_id, r.ego_id, r.t_ns, s.x_m, s.y_m, s.z_m, s.yaw_rad, s.speed_mps, s.accel_mps2,
    -- If part of the 3 s is not recorded, the ego may have moved in that part.
    CASE
        WHEN max(s.speed_mps) OVER last_3s >= standing_mps()
            OR count(s.speed_mps) OVER last_3s = count(*) OVER last_3s AND min(r.seg) OVER last_3s = r.seg AND min(r.t_ns) OVER last_3s <= r.t_ns - 3_000_000_000 + k.max_gap_ns
            THEN max(s.speed_mps) OVER last_3s
    END AS fastest_3s_mps,
    r.travel_m, s.length_m, s.width_m, CASE WHEN t.t_ns IS NULL THEN s.length_m ELSE s.length_m / 2 + t.reach_m END AS combination_m, s.indicator,
    e.lanelet_id, e.with_direction, e.with_traffic,
    CASE WHEN n.lanelet_id IS NOT NULL THEN n.junction_id IS NOT NULL END AS in_junction,
    n.road_type, v.limit_mps, v.limit_source,
    r.chain_id, c.s_m, c.d_m,
    -- If the ego heads against the corridor, the rear of its trailer has the furthest station.
    CASE WHEN t.t_ns IS NULL OR abs(c.heading_diff_rad) <= pi() / 2 THEN c.front_s_m ELSE c.s_m + t.reach_m END AS front_s_m,
    CASE WHEN t.t_ns IS NULL OR abs(c.heading_diff_rad) > pi() / 2 THEN c.rear_s_m ELSE c.s_m - t.reach_m END AS rear_s_m,
    c.lat_half_m, c.heading_diff_rad
FROM running_chain r
JOIN data_log l USING (drive_id)
JOIN clock k USING (drive_id, ego_id)
JOIN state_dynamics s ON s.drive_id = r.drive_id AND s.actor_id = r.ego_id AND s.t_ns = r.t_ns
LEFT JOIN trailer_reach t ON t.drive_id = r.drive_id AND t.ego_id = r.ego_id AND t.t_ns = r.t_ns
LEFT JOIN ego_lane e ON e.drive_id = r.drive_id AND e.ego_id = r.ego_id AND e.t_ns = r.t_ns
LEFT JOIN lanelet n ON n.environment_id = l.environment_id AND n.lanelet_id = e.lanelet_id
LEFT JOIN step_limit v ON v.drive_id = r.drive_id AND v.ego_id = r.ego_id AND v.t_ns = r.t_ns
LEFT JOIN ego_corridor c ON c.drive_id = r.drive_id AND c.ego_id = r.ego_id AND c.chain_id = r.chain_id AND c.t_ns = r.t_ns
WINDOW last_3s AS (PARTITION BY r.drive_id, r.ego_id ORDER BY r.t_ns RANGE BETWEEN 3_000_000_000 PRECEDING AND CURRENT ROW)
