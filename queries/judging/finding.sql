INSERT INTO finding BY NAME
WITH _numbered AS (
    SELECT *, (row_number() OVER (PARTITION BY drive_id, ego_id, rule_id, profile, object_id
        ORDER BY t_start_ns, t_end_ns, ref_id NULLS LAST) - 1)::INTEGER AS occurrence
    FROM with_sentences('_failed')
), _moment AS (
    SELECT m.*, coalesce(p.clearance_m <= 0, false) AS touches
    FROM (
        SELECT DISTINCT drive_id, ego_id, object_id, of_contact, CASE WHEN of_contact THEN t_start_ns ELSE t_worst_ns END AS t_moment_ns
        FROM _failed WHERE object_id IS NOT NULL
    ) m
    LEFT JOIN pair p ON p.drive_id = m.drive_id AND p.ego_id = m.ego_id AND p.object_id = m.object_id AND p.t_ns = m.t_moment_ns
), _approach AS (
    SELECT drive_id, ego_id, object_id, of_contact, t_moment_ns, t_moment_ns AS t_ns FROM _moment WHERE NOT of_contact AND NOT touches
    UNION ALL
    -- A contact changes the speeds: the last step before it counts, and none that is long before it.
    SELECT m.drive_id, m.ego_id, m.object_id, m.of_contact, m.t_moment_ns, max(p.t_ns) AS t_ns
    FROM _moment m
    JOIN pair p ON p.drive_id = m.drive_id AND p.ego_id = m.ego_id AND p.object_id = m.object_id AND p.t_ns < m.t_moment_ns
    JOIN ego_state e ON e.drive_id = m.drive_id AND e.ego_id = m.ego_id AND e.t_ns = p.t_ns
    WHERE CASE WHEN m.of_contact THEN p.t_ns >= m.t_moment_ns - 1_000_000_000 AND p.speed_mps + e.speed_mps IS NOT NULL ELSE m.touches AND p.clearance_m > 0 END
    GROUP BY ALL
), _closing AS (
    -- pair has no place of an object whose last sample is too old
    SELECT a.drive_id, a.ego_id, a.object_id, a.of_contact, a.t_moment_ns,
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
    (v.t_start_ns - start_ns) / 1e9 AS t_start_s, (v.t_worst_ns - start_ns) / 1e9 AS t_worst_s,
    (v.t_end_ns - start_ns) / 1e9 AS t_end_s, c.closing_mps
FROM _numbered v
LEFT JOIN ego_state p ON p.drive_id = v.drive_id AND p.ego_id = v.ego_id AND p.t_ns = v.t_worst_ns
LEFT JOIN _closing c ON c.drive_id = v.drive_id AND c.ego_id = v.ego_id AND c.object_id = v.object_id
    AND c.of_contact = v.of_contact AND c.t_moment_ns = CASE WHEN v.of_contact THEN v.t_start_ns ELSE v.t_worst_ns END
