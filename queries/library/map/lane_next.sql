-- The lanelet straight ahead and the lanelet straight behind: the link with the least change of heading. If two links are equal, the lower
-- id counts.
-- lifetime: map
CREATE TABLE lane_next (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet
    ahead_id VARCHAR,                 -- the straightest lanelet that continues this one; NULL: none
    behind_id VARCHAR,                -- the straightest lanelet that this one continues; NULL: none
    map_ends BOOLEAN NOT NULL,        -- neither this lanelet nor a lane beside it of the same direction has a continuation: the map ends here
    map_begins BOOLEAN NOT NULL       -- neither this lanelet nor a lane beside it of the same direction continues another lanelet: the map begins here
);

INSERT INTO lane_next BY NAME
WITH link AS (
    SELECT l.environment_id, l.from_id, l.to_id, abs(l.turn_rad) AS turn_abs_rad
    FROM lane_link l
    JOIN lanelet a ON a.environment_id = l.environment_id AND a.lanelet_id = l.from_id AND a.drivable
    JOIN lanelet b ON b.environment_id = l.environment_id AND b.lanelet_id = l.to_id AND b.drivable
),
lanelet_ahead AS (SELECT environment_id, from_id AS lanelet_id, min({'turn_abs_rad': turn_abs_rad, 'id': to_id}).id AS ahead_id FROM link GROUP BY ALL),
-- turn_rad of a link is the change of heading over the lanelet to which the link leads. The turn of a lanelet behind is therefore not in
-- its link to this lanelet, but in the links that lead into the lanelet behind: the least of their turn_rad counts.
least_turn AS (SELECT environment_id, to_id AS from_id, min(turn_abs_rad) AS turn_abs_rad FROM link GROUP BY ALL),
lanelet_behind AS (
    SELECT l.environment_id, l.to_id AS lanelet_id, min({'turn_abs_rad': coalesce(t.turn_abs_rad, 0.0), 'id': l.from_id}).id AS behind_id
    FROM link l LEFT JOIN least_turn t USING (environment_id, from_id)
    GROUP BY ALL
)
SELECT
    n.environment_id, n.lanelet_id, ahead_id, behind_id,
    -- A lane that ends or begins beside lanes that continue is no end of the map.
    bool_and(ahead_id IS NULL) OVER beside AS map_ends, bool_and(behind_id IS NULL) OVER beside AS map_begins
FROM lanelet n
LEFT JOIN lanelet_ahead USING (environment_id, lanelet_id)
LEFT JOIN lanelet_behind USING (environment_id, lanelet_id)
WHERE n.drivable
WINDOW beside AS (PARTITION BY n.environment_id, n.road_id, n.section, n.along_road)
