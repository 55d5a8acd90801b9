-- The worst step of findings and near misses: per ego, rule and profile only the $per_rule with the smallest margins.
CREATE OR REPLACE TEMP TABLE _every_moment AS
WITH finding_or_near_miss AS (
    SELECT drive_id, ego_id, rule_id, profile, object_id, t_worst_ns AS t_ns, margin, 0 AS weight FROM finding
    UNION ALL
    SELECT drive_id, ego_id, rule_id, profile, object_id, t_worst_ns, margin, 1 FROM verdict WHERE near_miss
),
worst AS (
    SELECT t.drive_id, t.ego_id, t.t_ns, t.object_id
    FROM finding_or_near_miss t
    SEMI JOIN ego_state e ON e.drive_id = t.drive_id AND e.ego_id = t.ego_id AND e.t_ns = t.t_ns AND e.x_m IS NOT NULL AND e.y_m IS NOT NULL
    QUALIFY row_number() OVER (
        PARTITION BY t.drive_id, t.ego_id, t.rule_id, t.profile, t.weight ORDER BY t.margin NULLS FIRST, t.t_ns, t.object_id
    ) <= $per_rule
),
worst_with_distance AS (
    SELECT w.drive_id, w.ego_id, w.t_ns, max(p.distance_m) AS far_m FROM worst w
    LEFT JOIN pair p ON p.drive_id = w.drive_id AND p.ego_id = w.ego_id AND p.t_ns = w.t_ns AND p.object_id = w.object_id
    GROUP BY ALL
)
SELECT s.drive_id, s.ego_id, s.t_ns, l.environment_id, e.x_m, e.y_m,
    least(greatest(coalesce(s.far_m, 0.0) + 30.0, $least_m), $most_m) AS reach_m,
    dense_rank() OVER (ORDER BY s.drive_id, s.ego_id) AS ego_no
FROM worst_with_distance s
JOIN ego_state e USING (drive_id, ego_id, t_ns)
JOIN data_log l USING (drive_id)
