-- The line across the lane, from its left to its right bound.
UPDATE stop_line SET geom = line.geom
FROM (
    SELECT l.rowid AS line_no, (l.lane_s_m - p.s_m) / (p.s_next_m - p.s_m) AS u, ST_MakeLine(
            ST_Point(p.left_x_m + u * (p.left_next_x_m - p.left_x_m), p.left_y_m + u * (p.left_next_y_m - p.left_y_m)),
            ST_Point(p.right_x_m + u * (p.right_next_x_m - p.right_x_m), p.right_y_m + u * (p.right_next_y_m - p.right_y_m))
        ) AS geom
    FROM stop_line l
    JOIN (
        SELECT
            *, lead(s_m) OVER w AS s_next_m,
            lead(left_x_m) OVER w AS left_next_x_m, lead(left_y_m) OVER w AS left_next_y_m, lead(right_x_m) OVER w AS right_next_x_m, lead(right_y_m) OVER w AS right_next_y_m
        FROM lane_point
        WINDOW w AS (PARTITION BY environment_id, lanelet_id ORDER BY k)
    ) p USING (environment_id, lanelet_id)
    WHERE p.s_next_m > p.s_m
    -- A line at the very end of the lane lies on its last piece, one between two pieces on the first.
    QUALIFY row_number() OVER (PARTITION BY l.rowid ORDER BY abs(u - greatest(0.0, least(1.0, u))), p.k) = 1
) line
WHERE line.line_no = stop_line.rowid
