-- Lanelets near a scene whose shape is not yet kept.
CREATE OR REPLACE TEMP TABLE _near AS
SELECT DISTINCT s.environment_id, s.lanelet_id
FROM (SELECT environment_id, unnest(lanelets) AS lanelet_id FROM scene WHERE environment_id IS NOT NULL) s
ANTI JOIN lane_shape k USING (environment_id, lanelet_id)
