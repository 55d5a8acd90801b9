-- The area of each junction: the union of its lanes, which overlap.
SELECT environment_id, junction_id, ST_Union_Agg(geom) AS geom
FROM lanelet
WHERE junction_id IS NOT NULL AND drivable
GROUP BY environment_id, junction_id
