-- Made after `finding`: a failed verdict names its findings.
INSERT INTO verdict BY NAME
WITH _track_end_times AS (
    -- the first time at which the log loses an actor, and the last at which an actor comes into it
    SELECT drive_id, ego_id, min(t_ns) FILTER (lost) AS gone_ns, max(t_ns) FILTER (NOT lost) AS to_come_ns
    FROM _track_end GROUP BY ALL
), _numbered AS MATERIALIZED (
    SELECT *, row_number() OVER (PARTITION BY drive_id, ego_id, rule_id, profile, object_id
        ORDER BY coalesce(t_ref_ns, t_start_ns) NULLS LAST, t_start_ns NULLS LAST, t_end_ns NULLS LAST,
            ref_id NULLS LAST, code) - 1 AS occurrence
    FROM with_sentences('_named')
), _failing_part AS (
    -- the failing steps of a finding, by the label of the episode to which they belong
    SELECT f.finding_id, f.drive_id, f.ego_id, f.rule_id, f.profile, f.object_id, f.ref_id, f.t_start_ns,
        nullif(s.judged_object_id, '') AS judged_object_id, nullif(part.label, '') AS label, part.t_first_ns, part.t_last_ns
    FROM finding f
    JOIN _failed s ON s.drive_id = f.drive_id AND s.ego_id = f.ego_id AND s.rule_id = f.rule_id AND s.t_start_ns = f.t_start_ns
        AND s.profile IS NOT DISTINCT FROM f.profile AND s.object_id IS NOT DISTINCT FROM f.object_id
        AND s.ref_id IS NOT DISTINCT FROM f.ref_id
    CROSS JOIN LATERAL (SELECT unnest(s.failing, recursive := true)) part
), _findings_of_verdict AS (
    SELECT v.drive_id, v.ego_id, v.rule_id, v.profile, v.object_id, v.occurrence,
        list(f.finding_id ORDER BY f.t_start_ns, f.finding_id) AS finding_ids
    FROM _numbered v
    JOIN _failing_part f ON f.drive_id = v.drive_id AND f.ego_id = v.ego_id AND f.rule_id = v.rule_id
        AND f.profile IS NOT DISTINCT FROM v.profile AND f.ref_id IS NOT DISTINCT FROM v.ref_id
        -- objects that are combined have one verdict, which is about the worst of them: a finding may be about another
        AND CASE WHEN v.ref_id IS NULL THEN f.object_id IS NOT DISTINCT FROM v.object_id
            ELSE coalesce(f.judged_object_id = v.object_id, f.judged_object_id IS NULL) END
        -- an occasion has all failing steps of its reference point, an episode those that lie in it
        AND (v.ref_id IS NOT NULL
            OR f.label IS NOT DISTINCT FROM v.label AND f.t_first_ns <= v.t_end_ns AND f.t_last_ns >= v.t_start_ns)
    WHERE v.verdict = 'fail'
    GROUP BY ALL
)
SELECT v.drive_id, v.ego_id, v.rule_id, rule_version, kind, v.profile, severity, v.object_id,
    v.occurrence::INTEGER AS occurrence, ref_id, t_ref_ns, t_start_ns, t_end_ns,
    t_worst_ns, verdict, code AS reason_code, sentence AS reason, cause_code, cause_args, reason_measures, observed, required, margin, unit,
    coalesce(verdict = 'pass' AND is_near_miss(margin, near_margin), false) AS near_miss,
    coalesce(n_expected, 0) AS n_expected, coalesce(n_judged, 0) AS n_judged, p.x_m, p.y_m, p.lanelet_id,
    CASE WHEN of_others AND verdict IN ('pass', 'fail', 'not_applicable') AND code <> 'other_nation' AND NOT starts_with(code, 'unrecorded_')
        AND NOT (code = 'outside_conditions' AND t_start_ns IS NULL)
        AND (coalesce(g.gone_ns <= t_end_ns, g.gone_ns IS NOT NULL) OR coalesce(g.to_come_ns >= t_start_ns, g.to_come_ns IS NOT NULL))
        THEN 'line_of_sight' END AS assumes,
    (t_start_ns - start_ns) / 1e9 AS t_start_s, (t_worst_ns - start_ns) / 1e9 AS t_worst_s,
    coalesce(d.finding_ids, []) AS finding_ids
FROM _numbered v
LEFT JOIN ego_state p ON p.drive_id = v.drive_id AND p.ego_id = v.ego_id AND p.t_ns = v.t_worst_ns
LEFT JOIN _track_end_times g ON g.drive_id = v.drive_id AND g.ego_id = v.ego_id
LEFT JOIN _findings_of_verdict d ON d.drive_id = v.drive_id AND d.ego_id = v.ego_id AND d.rule_id = v.rule_id
    AND d.profile IS NOT DISTINCT FROM v.profile AND d.object_id IS NOT DISTINCT FROM v.object_id AND d.occurrence = v.occurrence
