-- Steps at which the ego is on no drivable lane, with the nearest non-drivable lanelet under the ego: a shoulder, lay-by, border, parking
-- lane, restricted lane or cycle lane. In the map, such a lanelet is part of the carriageway, or is kept free beside it.
-- lifetime: part
CREATE TABLE ego_aside (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which the ego is on no drivable lane, but on a lane beside one
    lanelet_id VARCHAR NOT NULL,      -- the nearest lane of this kind: a shoulder, border, parking or cycle lane
    lane_type VARCHAR NOT NULL,       -- [lane_type] see lanelet
    road_type VARCHAR,                -- [road_type] see lanelet
    off_m DOUBLE NOT NULL,            -- distance of the ego from the lane's centre line {position}
    with_direction BOOLEAN            -- the heading is within 90 degrees of the lane's direction; NULL: heading not known {heading}
);

INSERT INTO ego_aside BY NAME
SELECT e.drive_id, e.ego_id, e.t_ns, o.lanelet_id, n.lane_type, n.road_type, abs(o.d_m) AS off_m, abs(o.heading_diff_rad) < pi() / 2 AS with_direction
FROM ego_lane e
JOIN data_log g USING (drive_id)
JOIN lane_occupancy o ON o.drive_id = e.drive_id AND o.actor_id = e.ego_id AND o.t_ns = e.t_ns
JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
WHERE e.lanelet_id IS NULL AND n.lane_type IN ('shoulder', 'stop', 'border', 'parking', 'restricted', 'biking')
QUALIFY row_number() OVER (PARTITION BY e.drive_id, e.ego_id, e.t_ns ORDER BY off_m, o.lanelet_id) = 1
