-- The ground of each junction. The lanes of one junction overlap, so that their union is taken.
SELECT environment_id, junction_id, ST_Union_Agg(geom) AS geom
FROM lanelet
WHERE junction_id IS NOT NULL AND drivable
GROUP BY environment_id, junction_id
