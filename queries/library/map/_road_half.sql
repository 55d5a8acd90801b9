-- Roads of one direction that are halves of one road: the other direction is a separate road beside it, along most of a lane. The id that
-- comes first stands for both roads.
-- lifetime: map
CREATE TABLE _road_half (
    environment_id VARCHAR NOT NULL,  -- the map
    road_id VARCHAR NOT NULL,         -- a road of one direction
    of_road_id VARCHAR NOT NULL,      -- the adjacent road of the opposite direction, whose id comes first: for a driver, the two are one road
    turned BOOLEAN NOT NULL           -- the reference lines of the two roads run in opposite directions
);

INSERT INTO _road_half BY NAME
WITH one_way_road AS (
    SELECT environment_id, road_id, min(along_road) AS along_road
    FROM lanelet
    WHERE drivable AND junction_id IS NULL
    GROUP BY ALL
    HAVING min(along_road) = max(along_road) AND NOT bool_or(bidirectional)
),
opposing_road_pair AS (
    SELECT b.environment_id, n.road_id, m.road_id AS of_road_id
    FROM lane_beside b
    JOIN lanelet n ON n.environment_id = b.environment_id AND n.lanelet_id = b.lanelet_id
    JOIN lanelet m ON m.environment_id = b.environment_id AND m.lanelet_id = b.beside_id
    WHERE b.against AND b.drivable AND m.road_id < n.road_id
    GROUP BY b.environment_id, n.lanelet_id, n.length_m, n.road_id, m.road_id
    HAVING sum(to_picometres(b.s_end_m - b.s_start_m)) > to_picometres(n.length_m / 2)
)
SELECT b.environment_id, b.road_id, min({'road': b.of_road_id, 'turned': a.along_road = o.along_road}).road AS of_road_id,
    min({'road': b.of_road_id, 'turned': a.along_road = o.along_road}).turned AS turned
FROM opposing_road_pair b
JOIN one_way_road a ON a.environment_id = b.environment_id AND a.road_id = b.road_id
JOIN one_way_road o ON o.environment_id = b.environment_id AND o.road_id = b.of_road_id
GROUP BY b.environment_id, b.road_id
