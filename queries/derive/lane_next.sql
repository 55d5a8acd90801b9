-- Straight on and straight back: the link with the least change of heading, ties by id.
WITH link AS (
    SELECT l.environment_id, l.from_id, l.to_id, abs(l.turn_rad) AS turn
    FROM lane_link l
    JOIN lanelet a ON a.environment_id = l.environment_id AND a.lanelet_id = l.from_id AND a.drivable
    JOIN lanelet b ON b.environment_id = l.environment_id AND b.lanelet_id = l.to_id AND b.drivable
),
ahead AS (SELECT environment_id, from_id AS lanelet_id, min({'turn': turn, 'id': to_id}).id AS ahead_id FROM link GROUP BY ALL),
-- the turn is made on the connecting lanelet, so going back it is that of the lanelet come from
turning AS (SELECT environment_id, to_id AS from_id, min(turn) AS turn FROM link GROUP BY ALL),
behind AS (
    SELECT l.environment_id, l.to_id AS lanelet_id, min({'turn': coalesce(t.turn, 0.0), 'id': l.from_id}).id AS behind_id
    FROM link l LEFT JOIN turning t USING (environment_id, from_id)
    GROUP BY ALL
)
SELECT
    n.environment_id, n.lanelet_id, ahead_id, behind_id,
    -- a lane that ends or begins beside others that go on is no end of the map
    bool_and(ahead_id IS NULL) OVER beside AS map_ends, bool_and(behind_id IS NULL) OVER beside AS map_begins
FROM lanelet n
LEFT JOIN ahead USING (environment_id, lanelet_id)
LEFT JOIN behind USING (environment_id, lanelet_id)
WHERE n.drivable
WINDOW beside AS (PARTITION BY n.environment_id, n.road_id, n.section, n.along_road)
