-- Sets longitude and latitude of rows of the drives $ids, by the projection of each drive. A projection may have no place for some.
UPDATE {table} SET lon = g.lon, lat = g.lat
FROM (
    SELECT p.key, ST_X(place) AS lon, ST_Y(place) AS lat FROM (
        -- the drive's coordinates in the projection, then in degrees
        SELECT p.key, ST_Transform(ST_Point(
            p.x_m * cos(l.geo_yaw_rad) - p.y_m * sin(l.geo_yaw_rad) + l.geo_x_m,
            p.x_m * sin(l.geo_yaw_rad) + p.y_m * cos(l.geo_yaw_rad) + l.geo_y_m
        ), l.geo_reference, 'EPSG:4326', always_xy := true) AS place
        FROM ({places}) p JOIN data_log l USING (drive_id)
        WHERE l.geo_reference IS NOT NULL AND list_contains($ids, l.drive_id)
    ) p WHERE isfinite(ST_X(place)) AND isfinite(ST_Y(place))
) g
WHERE g.key = {table}.{key}
