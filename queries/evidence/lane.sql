-- The columns of `lane_shape`, except the points of the bounds, for the lanes of `_near`.
WITH marking_length AS (
    SELECT environment_id, lanelet_id, side, marking, sum(to_picometres(s_end_m - s_start_m)) AS m
    FROM lane_boundary SEMI JOIN _near USING (environment_id, lanelet_id) GROUP BY ALL
),
longest_marking AS (
    SELECT environment_id, lanelet_id, first(marking ORDER BY m DESC, marking) FILTER (side = 'left') AS left_marking,
        first(marking ORDER BY m DESC, marking) FILTER (side = 'right') AS right_marking
    FROM marking_length GROUP BY ALL
)
SELECT n.environment_id, n.lanelet_id, n.lane_type, n.drivable, n.junction_id IS NOT NULL AS in_junction, m.left_marking, m.right_marking
FROM lanelet n SEMI JOIN _near USING (environment_id, lanelet_id)
LEFT JOIN longest_marking m USING (environment_id, lanelet_id)
ORDER BY n.environment_id, n.lanelet_id
