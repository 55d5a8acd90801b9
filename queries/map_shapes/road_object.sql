-- The outline of an object: a line where it has no area, as that of a stop line in Town10HD, and a point where the map has none.
UPDATE road_object SET geom = CASE
    WHEN shape.area IS NULL THEN ST_Point(x_m, y_m)
    WHEN ST_IsEmpty(shape.area) THEN ST_MakeLine(outline_points(outline_x_m, outline_y_m))
    ELSE shape.area
END
FROM (
    SELECT o.rowid AS row_no, a.area
    FROM road_object o
    -- The area is made of whole outlines only: DuckDB 1.5.5 evaluates an expression that two branches of a CASE share for every row.
    LEFT JOIN (SELECT rowid AS row_no, valid_area(area_between(outline_points(outline_x_m, outline_y_m), [])) AS area FROM road_object WHERE len(outline_x_m) >= 3) a
        ON a.row_no = o.rowid
) shape
WHERE shape.row_no = road_object.rowid
