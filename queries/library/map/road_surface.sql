-- The carriageway of each road, without its footways.
-- lifetime: map
CREATE TABLE road_surface (
    environment_id VARCHAR NOT NULL,  -- the map
    road_id VARCHAR NOT NULL,         -- see lanelet
    geom GEOMETRY                     -- the carriageway: the area of the road's drivable lanelets and of the shoulder, stop, border, parking, restricted and biking lanes beside them
);

INSERT INTO road_surface BY NAME
SELECT environment_id, road_id, ST_Union_Agg(geom) AS geom
FROM lanelet
WHERE drivable OR lane_type IN ('shoulder', 'stop', 'border', 'parking', 'restricted', 'biking')
GROUP BY environment_id, road_id
