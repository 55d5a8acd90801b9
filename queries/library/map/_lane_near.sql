-- The drivable lanelets that follow a drivable lanelet within three links. They show whether two positions can belong to one path.
-- lifetime: map
CREATE TABLE _lane_near (
    environment_id VARCHAR NOT NULL,  -- the map
    from_id VARCHAR NOT NULL,         -- a drivable lanelet
    to_id VARCHAR NOT NULL,           -- the same lanelet, or a lanelet that continues it within three links
    hops INTEGER NOT NULL             -- least number of links from from_id to to_id, 0 to 3
);

INSERT INTO _lane_near BY NAME
WITH link AS (
    SELECT l.environment_id, l.from_id, l.to_id
    FROM lane_link l
    JOIN lanelet a ON a.environment_id = l.environment_id AND a.lanelet_id = l.from_id AND a.drivable
    JOIN lanelet b ON b.environment_id = l.environment_id AND b.lanelet_id = l.to_id AND b.drivable
),
hop AS (
    SELECT environment_id, lanelet_id AS from_id, lanelet_id AS to_id, 0 AS hops FROM lanelet WHERE drivable
    UNION ALL
    SELECT environment_id, from_id, to_id, 1 FROM link
    UNION ALL
    SELECT a.environment_id, a.from_id, b.to_id, 2
    FROM link a JOIN link b ON b.environment_id = a.environment_id AND b.from_id = a.to_id
    UNION ALL
    SELECT a.environment_id, a.from_id, c.to_id, 3
    FROM link a
    JOIN link b ON b.environment_id = a.environment_id AND b.from_id = a.to_id
    JOIN link c ON c.environment_id = b.environment_id AND c.from_id = b.to_id
)
SELECT environment_id, from_id, to_id, min(hops) AS hops FROM hop GROUP BY ALL
