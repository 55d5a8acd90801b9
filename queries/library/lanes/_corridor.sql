-- The running chain with the lane beside it on the overtaking side. Inside a junction, the lane beside is taken from before the junction,
-- else from after it.
-- lifetime: part
CREATE TABLE _corridor (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- the running chain
    seq INTEGER NOT NULL,             -- order along the chain
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    s_start_m DOUBLE NOT NULL,        -- see chain {position}
    length_m DOUBLE NOT NULL,         -- see chain {size}
    side INTEGER,                     -- the overtaking side: 1 left (right-hand traffic), -1 right; NULL: handedness unknown {position}
    over_width_m DOUBLE,              -- width of the lane beside the lanelet on the overtaking side (see lane_beside), plus the gap between the two, if that lane exists along more than half of the lanelet; inside a junction, the width before or after it; NULL: no such lane
    over_against BOOLEAN              -- that lane is driven in the opposite direction {position, heading, size}
);

INSERT INTO _corridor BY NAME
WITH overtaking_lane AS (
    SELECT e.environment_id, o.lanelet_id, o.against, from_picometres(sum(to_picometres(o.s_end_m - o.s_start_m))) AS along_m, max(o.gap_m + o.width_m) AS width_m
    FROM environment e
    JOIN lane_beside o ON o.environment_id = e.environment_id AND o.drivable AND o.side = overtaking_side(e.handedness)
    GROUP BY ALL
),
lanelet_with_overtaking_lane AS (
    SELECT
        c.drive_id, c.ego_id, c.chain_id, c.seq, c.lanelet_id, c.s_start_m, c.length_m, n.junction_id,
        -- A side that comes only from the default is a guess, and nothing may rely on it.
        CASE WHEN e.handedness_source <> 'default' THEN CASE e.handedness WHEN 'lht' THEN -1 ELSE 1 END END AS side,
        CASE WHEN o.width_m IS NOT NULL THEN {'width_m': o.width_m, 'against': o.against} END AS lane
    FROM chain c
    JOIN data_log l USING (drive_id)
    JOIN environment e USING (environment_id)
    JOIN lanelet n ON n.environment_id = e.environment_id AND n.lanelet_id = c.lanelet_id
    LEFT JOIN overtaking_lane o ON o.environment_id = e.environment_id AND o.lanelet_id = c.lanelet_id AND o.along_m > n.length_m / 2
),
corridor_lanelet AS (
    SELECT
        *,
        last_value(lane IGNORE NULLS) OVER (PARTITION BY drive_id, ego_id, chain_id ORDER BY seq ROWS UNBOUNDED PRECEDING) AS lane_before,
        first_value(lane IGNORE NULLS) OVER (PARTITION BY drive_id, ego_id, chain_id ORDER BY seq ROWS BETWEEN CURRENT ROW AND UNBOUNDED FOLLOWING) AS lane_after
    FROM lanelet_with_overtaking_lane
)
SELECT
    drive_id, ego_id, chain_id, seq, lanelet_id, s_start_m, length_m, side,
    CASE WHEN junction_id IS NULL THEN lane.width_m ELSE coalesce(lane, lane_before, lane_after).width_m END AS over_width_m,
    CASE WHEN junction_id IS NULL THEN lane.against ELSE coalesce(lane, lane_before, lane_after).against END AS over_against
FROM corridor_lanelet
UNION ALL
-- It is not known what is beside the ego's own recorded path.
SELECT c.drive_id, c.ego_id, c.chain_id, c.seq, c.lanelet_id, c.s_start_m, c.length_m, NULL, NULL, NULL
FROM chain c
SEMI JOIN (FROM data_log WHERE environment_id IS NULL) g ON g.drive_id = c.drive_id
