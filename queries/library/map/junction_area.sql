-- The area of each junction: the union of its lanes, which overlap.
-- lifetime: map
CREATE TABLE junction_area (
    environment_id VARCHAR NOT NULL,  -- the map
    junction_id VARCHAR NOT NULL,     -- see lanelet
    geom GEOMETRY                     -- the area of the junction's drivable lanelets
);

INSERT INTO junction_area BY NAME
SELECT environment_id, junction_id, ST_Union_Agg(geom) AS geom
FROM lanelet
WHERE junction_id IS NOT NULL AND drivable
GROUP BY environment_id, junction_id
