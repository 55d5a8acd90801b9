-- The outline of an object: a line where it has no area, as that of a stop line in Town10HD, and a point where the map has none.
UPDATE road_object SET geom = CASE
    WHEN len(outline_x_m) < 3 THEN ST_Point(x_m, y_m)
    WHEN ST_IsEmpty(valid_area(area_between(outline_points(outline_x_m, outline_y_m), []))) THEN ST_MakeLine(outline_points(outline_x_m, outline_y_m))
    ELSE valid_area(area_between(outline_points(outline_x_m, outline_y_m), []))
END
