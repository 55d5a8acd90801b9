INSERT INTO verdict BY NAME
WITH _track_end_times AS (
    -- the first time at which the log loses somebody, and the last at which somebody comes into it
    SELECT drive_id, ego_id, min(t_ns) FILTER (lost) AS gone_ns, max(t_ns) FILTER (NOT lost) AS to_come_ns
    FROM track_end GROUP BY ALL
), _numbered AS (
    SELECT *, row_number() OVER (PARTITION BY drive_id, ego_id, rule_id, profile, object_id
        ORDER BY coalesce(t_ref_ns, t_start_ns) NULLS LAST, t_start_ns NULLS LAST, t_end_ns NULLS LAST,
            ref_id NULLS LAST, code) - 1 AS occurrence
    FROM with_sentences('_named')
)
SELECT v.drive_id, v.ego_id, rule_id, rule_version, kind, profile, severity, object_id,
    occurrence::INTEGER AS occurrence, ref_id, t_ref_ns, t_start_ns, t_end_ns,
    t_worst_ns, verdict, code AS reason_code, sentence AS reason, cause_code, cause_args, reason_measures, observed, required, margin, unit,
    coalesce(verdict = 'pass' AND is_near_miss(margin, near_margin), false) AS near_miss,
    coalesce(n_expected, 0) AS n_expected, coalesce(n_judged, 0) AS n_judged, p.x_m, p.y_m, p.lanelet_id,
    CASE WHEN of_others AND verdict IN ('pass', 'fail', 'not_applicable') AND code <> 'other_nation'
        AND (coalesce(g.gone_ns <= t_end_ns, g.gone_ns IS NOT NULL) OR coalesce(g.to_come_ns >= t_start_ns, g.to_come_ns IS NOT NULL))
        THEN 'line_of_sight' END AS assumes,
    (t_start_ns - start_ns) / 1e9 AS t_start_s, (t_worst_ns - start_ns) / 1e9 AS t_worst_s
FROM _numbered v
LEFT JOIN ego_state p ON p.drive_id = v.drive_id AND p.ego_id = v.ego_id AND p.t_ns = v.t_worst_ns
LEFT JOIN _track_end_times g ON g.drive_id = v.drive_id AND g.ego_id = v.ego_id
