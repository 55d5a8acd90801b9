-- The outline of an object; a point where the map has none.
UPDATE road_object SET geom = CASE
    WHEN len(outline_x_m) >= 3 THEN valid_area(area_between(list_transform(list_zip(outline_x_m, outline_y_m), lambda p: ST_Point(p[1], p[2])), []))
    ELSE ST_Point(x_m, y_m)
END
