-- One drivable lanelet per ego step. If several lanelets overlap (in junctions), the lanelet that links the last certain lanelet to the
-- next one is taken. Of several such lanelets, it is the one that covers most steps between the two certain lanelets, then the one with the
-- best heading. If the ego is on no drivable lane, it may be on a lane beside one (aside_id).
-- lifetime: part
CREATE TABLE ego_lane (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    lanelet_id VARCHAR,               -- the drivable lanelet that the ego is on, one per step; in junctions, the lanelet on the ego's path; NULL: none
    s_m DOUBLE,                       -- station along the lanelet {position}
    d_m DOUBLE,                       -- offset from the lanelet's centre line, left of travel positive {position}
    half_width_m DOUBLE,              -- half the lanelet's width there
    with_direction BOOLEAN,           -- the heading is within 90 degrees of the lane's direction {heading}
    with_traffic BOOLEAN,             -- with_direction, or the lane is driven in both directions {position}
    aside_id VARCHAR,                 -- if the ego is on no drivable lane: the nearest lanelet under it that is a shoulder, lay-by, border, parking lane, restricted lane or cycle lane, which is part of the carriageway or kept free beside it; NULL: none {position}
    aside_type VARCHAR,               -- [lane_type] of that lanelet, see lanelet
    aside_road_type VARCHAR,          -- [road_type] of that lanelet, see lanelet
    aside_off_m DOUBLE,               -- distance of the ego from that lanelet's centre line {position}
    aside_with_direction BOOLEAN      -- the heading is within 90 degrees of that lanelet's direction {heading}
);

INSERT INTO ego_lane BY NAME
WITH lanelet_candidate AS (
    SELECT
        st.drive_id, st.ego_id, st.t_ns, st.k, l.environment_id, o.lanelet_id, o.s_m, o.d_m, o.half_width_m,
        abs(o.heading_diff_rad) AS heading_off_rad, o.heading_diff_rad,
        count(o.lanelet_id) OVER (PARTITION BY st.drive_id, st.ego_id, st.t_ns) AS n_candidates
    FROM step st
    JOIN data_log l USING (drive_id)
    LEFT JOIN lane_occupancy o ON o.drive_id = st.drive_id AND o.actor_id = st.ego_id AND o.t_ns = st.t_ns AND o.drivable
),
certain_lanelet AS (
    SELECT
        drive_id, ego_id, k,
        last_value(certain_id IGNORE NULLS) OVER (PARTITION BY drive_id, ego_id ORDER BY k ROWS UNBOUNDED PRECEDING) AS before_id,
        last_value(certain_k IGNORE NULLS) OVER (PARTITION BY drive_id, ego_id ORDER BY k ROWS UNBOUNDED PRECEDING) AS before_k,
        first_value(certain_id IGNORE NULLS) OVER (PARTITION BY drive_id, ego_id ORDER BY k ROWS BETWEEN CURRENT ROW AND UNBOUNDED FOLLOWING) AS after_id
    FROM (
        SELECT drive_id, ego_id, k, any_value(CASE WHEN n_candidates = 1 THEN lanelet_id END) AS certain_id, any_value(CASE WHEN n_candidates = 1 THEN k END) AS certain_k
        FROM lanelet_candidate
        GROUP BY ALL
    )
),
link AS (
    SELECT environment_id, lanelet_id AS from_id, lanelet_id AS to_id FROM lanelet WHERE drivable
    UNION ALL
    SELECT l.environment_id, l.from_id, l.to_id
    FROM lane_link l
    JOIN lanelet a ON a.environment_id = l.environment_id AND a.lanelet_id = l.from_id AND a.drivable
    JOIN lanelet b ON b.environment_id = l.environment_id AND b.lanelet_id = l.to_id AND b.drivable
),
-- The drivable lanelets that follow a lanelet of the ego within three links, and that lanelet itself. They show whether two positions can
-- belong to one path.
near_lanelet AS (
    SELECT DISTINCT a.environment_id, a.from_id, c.to_id
    FROM (FROM link l SEMI JOIN lanelet_candidate o ON o.environment_id = l.environment_id AND o.lanelet_id = l.from_id) a
    JOIN link b ON b.environment_id = a.environment_id AND b.from_id = a.to_id
    JOIN link c ON c.environment_id = b.environment_id AND c.from_id = b.to_id
),
scored_candidate AS (
    SELECT
        c.*,
        (b.to_id IS NOT NULL)::INTEGER + (a.to_id IS NOT NULL)::INTEGER AS n_links,
        count(*) OVER (PARTITION BY c.drive_id, c.ego_id, s.before_k, c.lanelet_id) AS n_covered
    FROM lanelet_candidate c
    JOIN certain_lanelet s USING (drive_id, ego_id, k)
    LEFT JOIN near_lanelet b ON b.environment_id = c.environment_id AND b.from_id = s.before_id AND b.to_id = c.lanelet_id
    LEFT JOIN near_lanelet a ON a.environment_id = c.environment_id AND a.from_id = c.lanelet_id AND a.to_id = s.after_id
    WHERE c.n_candidates > 1
),
best_candidate AS (
    SELECT
        drive_id, ego_id, t_ns,
        min({'n_links': -n_links, 'n_covered': -n_covered, 'heading_off_rad': heading_off_rad, 'off_m': abs(d_m), 'id': lanelet_id, 's_m': s_m}) AS best
    FROM scored_candidate
    GROUP BY ALL
),
lane_aside AS (
    SELECT
        c.drive_id, c.ego_id, c.t_ns,
        min({'off_m': abs(o.d_m), 'id': o.lanelet_id, 'lane_type': n.lane_type, 'road_type': n.road_type, 'with_direction': abs(o.heading_diff_rad) < pi() / 2}) AS nearest
    FROM lanelet_candidate c
    JOIN lane_occupancy o ON o.drive_id = c.drive_id AND o.actor_id = c.ego_id AND o.t_ns = c.t_ns
    JOIN lanelet n ON n.environment_id = c.environment_id AND n.lanelet_id = o.lanelet_id
    WHERE c.n_candidates = 0 AND n.lane_type IN ('shoulder', 'stop', 'border', 'parking', 'restricted', 'biking')
    GROUP BY c.drive_id, c.ego_id, c.t_ns
)
SELECT
    c.drive_id, c.ego_id, c.t_ns, c.lanelet_id, c.s_m, c.d_m, c.half_width_m, c.heading_off_rad < pi() / 2 AS with_direction,
    n.bidirectional OR c.heading_off_rad < pi() / 2 AS with_traffic,
    a.nearest.id AS aside_id, a.nearest.lane_type AS aside_type, a.nearest.road_type AS aside_road_type, a.nearest.off_m AS aside_off_m, a.nearest.with_direction AS aside_with_direction
FROM lanelet_candidate c
LEFT JOIN lanelet n ON n.environment_id = c.environment_id AND n.lanelet_id = c.lanelet_id
LEFT JOIN best_candidate b ON b.drive_id = c.drive_id AND b.ego_id = c.ego_id AND b.t_ns = c.t_ns
LEFT JOIN lane_aside a ON a.drive_id = c.drive_id AND a.ego_id = c.ego_id AND a.t_ns = c.t_ns
WHERE c.n_candidates <= 1 OR (c.lanelet_id = b.best.id AND c.s_m = b.best.s_m)
