-- The bounds of the lanes of `_near`, which are numbered in the order of `lane.sql`.
SELECT dense_rank() OVER (ORDER BY environment_id, lanelet_id) - 1 AS lane, left_x_m, left_y_m, right_x_m, right_y_m
FROM lane_point SEMI JOIN _near USING (environment_id, lanelet_id)
ORDER BY environment_id, lanelet_id, k
