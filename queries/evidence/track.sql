-- The ways of egos, and of the other road users of findings and near misses, that are not kept yet.
INSERT INTO track BY NAME
WITH shown AS (
    SELECT drive_id, ego_id AS actor_id FROM clock
    UNION
    SELECT drive_id, object_id FROM finding WHERE object_id IS NOT NULL
    UNION
    SELECT drive_id, object_id FROM verdict WHERE near_miss AND object_id IS NOT NULL
),
sample AS (
    SELECT s.drive_id, s.actor_id, s.t_ns, s.x_m, s.y_m, s.t_ns - lag(s.t_ns) OVER w > c.max_gap_ns AS after_hole
    FROM state_dynamics s
    SEMI JOIN shown a ON a.drive_id = s.drive_id AND a.actor_id = s.actor_id
    ANTI JOIN track k ON k.drive_id = s.drive_id AND k.actor_id = s.actor_id
    JOIN (SELECT drive_id, max(max_gap_ns) AS max_gap_ns FROM _ego_clock GROUP BY drive_id) c ON c.drive_id = s.drive_id
    WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL
    WINDOW w AS (PARTITION BY s.drive_id, s.actor_id ORDER BY s.t_ns)
),
part_sample AS (
    SELECT *, sum(coalesce(after_hole, false)::INTEGER) OVER (PARTITION BY drive_id, actor_id ORDER BY t_ns ROWS UNBOUNDED PRECEDING)::INTEGER AS part
    FROM sample
),
kept_sample AS (
    SELECT *
    FROM part_sample
    QUALIFY row_number() OVER (PARTITION BY drive_id, actor_id, part, t_ns // $step_ns ORDER BY t_ns) = 1
        OR t_ns = max(t_ns) OVER (PARTITION BY drive_id, actor_id, part)
)
SELECT
    s.drive_id, s.actor_id, s.part, a.is_ego, a.actor_class,
    list(s.t_ns ORDER BY s.t_ns) AS t_ns, list(round(s.x_m, 2) ORDER BY s.t_ns) AS x_m, list(round(s.y_m, 2) ORDER BY s.t_ns) AS y_m
FROM kept_sample s
JOIN actor a ON a.drive_id = s.drive_id AND a.actor_id = s.actor_id
GROUP BY s.drive_id, s.actor_id, s.part, a.is_ego, a.actor_class
