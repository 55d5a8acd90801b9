-- The part of the lane between the crossing's stations.
UPDATE crossing SET geom = area.geom
FROM (
    WITH lane_edge AS (
        SELECT
            environment_id, lanelet_id, s_m, left_x_m, left_y_m, right_x_m, right_y_m, lead(s_m) OVER w AS s_next_m,
            lead(left_x_m) OVER w AS left_next_x_m, lead(left_y_m) OVER w AS left_next_y_m, lead(right_x_m) OVER w AS right_next_x_m, lead(right_y_m) OVER w AS right_next_y_m
        FROM lane_point
        WINDOW w AS (PARTITION BY environment_id, lanelet_id ORDER BY k)
    ),
    -- Each piece of the lane under the crossing, from u = 0 to 1 along the piece, cut at the crossing's ends.
    piece AS (
        SELECT
            c.rowid AS crossing_no, e.*,
            unnest([greatest(0.0, (c.s_start_m - e.s_m) / (e.s_next_m - e.s_m)), least(1.0, (c.s_end_m - e.s_m) / (e.s_next_m - e.s_m))]) AS u
        FROM crossing c
        JOIN lane_edge e USING (environment_id, lanelet_id)
        WHERE e.s_next_m > e.s_m AND e.s_m < c.s_end_m AND e.s_next_m > c.s_start_m
    ),
    bound AS (
        SELECT
            crossing_no, s_m + u * (s_next_m - s_m) AS along_m,
            ST_Point(left_x_m + u * (left_next_x_m - left_x_m), left_y_m + u * (left_next_y_m - left_y_m)) AS left_point,
            ST_Point(right_x_m + u * (right_next_x_m - right_x_m), right_y_m + u * (right_next_y_m - right_y_m)) AS right_point
        FROM piece
    )
    SELECT crossing_no, valid_area(area_between(list(left_point ORDER BY along_m), list(right_point ORDER BY along_m DESC))) AS geom
    FROM bound
    GROUP BY crossing_no
) area
WHERE area.crossing_no = crossing.rowid
