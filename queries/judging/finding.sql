INSERT INTO finding BY NAME
WITH _numbered AS (
    SELECT *, (row_number() OVER (PARTITION BY drive_id, ego_id, rule_id, profile, object_id
        ORDER BY t_start_ns, t_end_ns, ref_id NULLS LAST) - 1)::INTEGER AS occurrence
    FROM with_sentences('_failed')
), _worst_step AS (
    SELECT f.drive_id, f.ego_id, f.object_id, f.t_worst_ns, coalesce(p.clearance_m <= 0, false) AS touches
    FROM (SELECT DISTINCT drive_id, ego_id, object_id, t_worst_ns FROM _failed WHERE object_id IS NOT NULL) f
    JOIN pair p ON p.drive_id = f.drive_id AND p.ego_id = f.ego_id AND p.object_id = f.object_id AND p.t_ns = f.t_worst_ns
), _approach AS (
    -- a contact changes the speeds: of an object that touches the ego, the last step before the contact counts
    SELECT drive_id, ego_id, object_id, t_worst_ns, t_worst_ns AS t_ns FROM _worst_step WHERE NOT touches
    UNION ALL
    SELECT w.drive_id, w.ego_id, w.object_id, w.t_worst_ns, max(p.t_ns) AS t_ns
    FROM _worst_step w
    JOIN pair p ON p.drive_id = w.drive_id AND p.ego_id = w.ego_id AND p.object_id = w.object_id AND p.t_ns < w.t_worst_ns
    WHERE w.touches AND p.clearance_m > 0
    GROUP BY ALL
), _closing AS (
    -- pair has no place of an object whose last sample is too old
    SELECT a.drive_id, a.ego_id, a.object_id, a.t_worst_ns,
        ((p.x_m - e.x_m) * (s.vx_mps - o.vx_mps) + (p.y_m - e.y_m) * (s.vy_mps - o.vy_mps)) / nullif(p.distance_m, 0) AS closing_mps
    FROM _approach a
    JOIN pair p ON p.drive_id = a.drive_id AND p.ego_id = a.ego_id AND p.object_id = a.object_id AND p.t_ns = a.t_ns
    JOIN ego_state e ON e.drive_id = a.drive_id AND e.ego_id = a.ego_id AND e.t_ns = a.t_ns
    JOIN state_dynamics s ON s.drive_id = a.drive_id AND s.actor_id = a.ego_id AND s.t_ns = a.t_ns
    -- only the tracks that are asked for are sorted
    ASOF JOIN (
        SELECT d.* FROM state_dynamics d SEMI JOIN _approach a ON a.drive_id = d.drive_id AND a.object_id = d.actor_id
    ) o ON o.drive_id = a.drive_id AND o.actor_id = a.object_id AND o.t_ns <= a.t_ns
)
SELECT sha256(to_json([v.sha256, v.ego_id, rule_id, profile, v.object_id,
    v.occurrence::VARCHAR])::VARCHAR)[:16] AS finding_id,
    v.drive_id, v.ego_id, rule_id, rule_version, kind, profile, severity, v.object_id, v.occurrence, ref_id,
    v.t_start_ns, v.t_end_ns, v.t_worst_ns, sentence AS reason, cause_code, cause_args, reason_measures, observed, required, margin, unit,
    p.x_m, p.y_m, p.lanelet_id,
    (v.t_start_ns - start_ns) / 1e9 AS t_start_s, (v.t_worst_ns - start_ns) / 1e9 AS t_worst_s, c.closing_mps
FROM _numbered v
LEFT JOIN ego_state p ON p.drive_id = v.drive_id AND p.ego_id = v.ego_id AND p.t_ns = v.t_worst_ns
LEFT JOIN _closing c ON c.drive_id = v.drive_id AND c.ego_id = v.ego_id AND c.object_id = v.object_id AND c.t_worst_ns = v.t_worst_ns
