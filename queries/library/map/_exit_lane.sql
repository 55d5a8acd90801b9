-- Lanes that leave the main carriageway: by their type, or because they run beside a through lane until both continue, with gentle bends,
-- on different roads. (At an ordinary junction, one of the two lanes bends sharply. An exit bends by less than 45 degrees, the through lane
-- by less than 20.) Of the two roads, the one with fewer lanes is the exit. If both have the same number, the exit is the road on the side
-- that is driven on.
-- lifetime: map
CREATE TABLE _exit_lane (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a lanelet of a lane that leaves the main carriageway (of a lane whose type does not say so: one of the last eleven before the fork)
    from_id VARCHAR,                  -- the through lanelet beside the exit lane; NULL: the exit branches off without one
    side VARCHAR NOT NULL             -- [side] the side on which the exit lane leaves
);

INSERT INTO _exit_lane BY NAME
WITH RECURSIVE carriageway AS (
    SELECT environment_id, road_id, section, along_road, count(*) AS n FROM lanelet WHERE drivable GROUP BY ALL
),
lane_pair AS (
    SELECT n.environment_id, n.lanelet_id AS exit_id, m.lanelet_id AS through_id, n.side
    FROM (
        SELECT *, unnest([{'side': 'left', 'beside_id': right_id, 'against': right_against}, {'side': 'right', 'beside_id': left_id, 'against': left_against}], recursive := true)
        FROM lanelet
        WHERE drivable AND junction_id IS NULL
    ) n
    JOIN lanelet m ON m.environment_id = n.environment_id AND m.lanelet_id = n.beside_id AND m.drivable AND m.junction_id IS NULL
    WHERE NOT n.against
),
-- Both lanes are followed straight on, through the junction if there is one, until they are beside each other again or on different roads.
-- e is the lanelet reached from the exit lane, m the one reached from the through lane.
walk AS (
    SELECT environment_id, exit_id, through_id, side, exit_id AS e, through_id AS m, 0 AS hop, 0.0::DOUBLE AS exit_turn_rad, 0.0::DOUBLE AS through_turn_rad FROM lane_pair
    UNION ALL
    SELECT
        w.environment_id, w.exit_id, w.through_id, w.side, ne.ahead_id, nm.ahead_id, w.hop + 1,
        w.exit_turn_rad + abs(le.turn_rad), w.through_turn_rad + abs(lm.turn_rad)
    FROM walk w
    JOIN lane_next ne ON ne.environment_id = w.environment_id AND ne.lanelet_id = w.e AND ne.ahead_id IS NOT NULL
    JOIN lane_next nm ON nm.environment_id = w.environment_id AND nm.lanelet_id = w.m AND nm.ahead_id IS NOT NULL
    JOIN lane_link le ON le.environment_id = w.environment_id AND le.from_id = w.e AND le.to_id = ne.ahead_id
    JOIN lane_link lm ON lm.environment_id = w.environment_id AND lm.from_id = w.m AND lm.to_id = nm.ahead_id
    JOIN lanelet ae ON ae.environment_id = w.environment_id AND ae.lanelet_id = w.e
    WHERE w.hop = 0 OR (ae.junction_id IS NOT NULL AND w.hop < 3)
),
exit_pair AS (
    SELECT DISTINCT w.environment_id, w.exit_id, w.through_id, w.side
    FROM walk w
    JOIN lanelet e ON e.environment_id = w.environment_id AND e.lanelet_id = w.e
    JOIN lanelet m ON m.environment_id = w.environment_id AND m.lanelet_id = w.m
    JOIN carriageway ce ON ce.environment_id = e.environment_id AND ce.road_id = e.road_id AND ce.section = e.section AND ce.along_road = e.along_road
    JOIN carriageway cm ON cm.environment_id = m.environment_id AND cm.road_id = m.road_id AND cm.section = m.section AND cm.along_road = m.along_road
    JOIN environment v ON v.environment_id = w.environment_id
    WHERE w.hop > 0 AND e.junction_id IS NULL AND m.junction_id IS NULL AND e.road_id <> m.road_id
        AND w.exit_turn_rad < pi() / 4 AND w.through_turn_rad < pi() / 9
        AND (ce.n < cm.n OR (ce.n = cm.n AND w.side = CASE v.handedness WHEN 'lht' THEN 'left' ELSE 'right' END))
),
-- The whole lane before the fork is the exit lane, as far back as the through lane is beside it on the same road.
upstream AS (
    SELECT environment_id, exit_id, through_id, side, 0 AS hop FROM exit_pair
    UNION ALL
    SELECT u.environment_id, b.lanelet_id, t.lanelet_id, u.side, u.hop + 1
    FROM upstream u
    JOIN lane_link le ON le.environment_id = u.environment_id AND le.to_id = u.exit_id
    JOIN lane_link lt ON lt.environment_id = u.environment_id AND lt.to_id = u.through_id
    JOIN lanelet b ON b.environment_id = u.environment_id AND b.lanelet_id = le.from_id
    JOIN lanelet t ON t.environment_id = u.environment_id AND t.lanelet_id = lt.from_id
        AND t.lanelet_id = CASE u.side WHEN 'right' THEN b.left_id ELSE b.right_id END
    WHERE u.hop < 10 AND b.road_id = t.road_id
)
SELECT environment_id, lanelet_id, min(from_id) AS from_id, min(side) AS side
FROM (
    SELECT environment_id, exit_id AS lanelet_id, through_id AS from_id, side FROM upstream
    UNION ALL
    SELECT n.environment_id, n.lanelet_id,
        CASE e.handedness WHEN 'lht' THEN n.right_id ELSE n.left_id END, CASE e.handedness WHEN 'lht' THEN 'left' ELSE 'right' END
    FROM lanelet n JOIN environment e USING (environment_id)
    WHERE n.lane_type IN ('exit', 'offRamp')
)
GROUP BY ALL
