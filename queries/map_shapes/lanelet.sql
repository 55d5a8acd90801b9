-- The lane between its bounds.
UPDATE lanelet SET geom = area.geom
FROM (
    SELECT environment_id, lanelet_id, valid_area(area_between(list(ST_Point(left_x_m, left_y_m) ORDER BY k), list(ST_Point(right_x_m, right_y_m) ORDER BY k DESC))) AS geom
    FROM lane_point
    GROUP BY environment_id, lanelet_id
) area
WHERE area.environment_id = lanelet.environment_id AND area.lanelet_id = lanelet.lanelet_id
