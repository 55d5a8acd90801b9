-- The carriageway of each road, without its footways.
SELECT environment_id, road_id, ST_Union_Agg(geom) AS geom
FROM lanelet
WHERE drivable OR lane_type IN ('shoulder', 'stop', 'border', 'parking', 'restricted', 'biking')
GROUP BY environment_id, road_id
