-- The findings of one audit that the other does not have, and what the other says there: see `drivelint.gate.diff.ResultLookup.verdict_at`.
CREATE OR REPLACE TEMP TABLE {side}_only AS
WITH lone AS (
    SELECT f.*, f.{other_side}_key AS there_key FROM {side}_finding f
    ANTI JOIN pair p ON p.drive = f.new_key AND p.{side}_no = f.no ANTI JOIN part t ON t.drive = f.new_key AND t.{side}_no = f.no
), rule_there AS (
    SELECT rule_id, flatten(list(profiles)) AS profiles FROM {of}rules GROUP BY rule_id
), said AS (
    -- without a signal of the log, a rule is not known to be kept
    SELECT v.* REPLACE (CASE WHEN starts_with(v.reason_code, 'unrecorded_') THEN 'unknown' ELSE v.verdict END AS verdict) FROM {of}verdicts v SEMI JOIN lone l ON l.there_key = v.key
), egos AS (
    SELECT DISTINCT key, ego_id FROM said
), objects AS (
    SELECT DISTINCT key, object_id FROM said
), stretch AS (
    -- where the ego or the object of a finding is recorded there, as in `drivelint.gate.match.is_recorded_during`
    SELECT l.key, l.no, r.actor_id, l.from_s, l.to_s, l.worst_s, (r.t_from_ns - coalesce(d.t_start_ns, 0)) / 1e9 AS seen_from_s,
        (r.t_to_ns - coalesce(d.t_start_ns, 0)) / 1e9 AS seen_to_s
    FROM lone l
    JOIN {of}drives d ON d.key = l.there_key
    JOIN (SELECT key, unnest(recorded, recursive := true) FROM {of}drives) r ON r.key = d.key AND r.actor_id IN (l.ego_id, l.object_id)
), gap AS (
    SELECT key, no, actor_id, from_s, to_s, worst_s BETWEEN seen_from_s AND seen_to_s AS at_worst, seen_to_s >= from_s AND seen_from_s <= to_s AS inside,
        seen_to_s, seen_from_s - lag(seen_to_s, 1, from_s) OVER (PARTITION BY key, no, actor_id, inside ORDER BY seen_from_s) AS missing_s
    FROM stretch
), actor_there AS (
    SELECT key, no, actor_id, coalesce(bool_or(at_worst) AND max(missing_s) FILTER (inside) <= {near_s}
        AND any_value(to_s) - max(seen_to_s) FILTER (inside) <= {near_s}, false) AS whole
    FROM gap GROUP BY key, no, actor_id
), placed AS (
    SELECT l.*, ea.actor_id IS NOT NULL AS ego_known, coalesce(ea.whole, false) AS ego_whole,
        l.object_id IS NULL OR oa.actor_id IS NOT NULL AS object_known, l.object_id IS NULL OR coalesce(oa.whole, false) AS object_whole, d.key IS NOT NULL AS checked, d.status, d.duration_s, coalesce(d.t_start_ns, 0) AS began_ns,
        r.rule_id IS NOT NULL AS has_rule, coalesce(l.profile IS NULL OR list_contains(r.profiles, l.profile), false) AS has_profile,
        e.key IS NOT NULL AS has_ego, o.key IS NOT NULL AS has_object
    FROM lone l
    LEFT JOIN {of}drives d ON d.key = l.there_key
    LEFT JOIN rule_there r ON r.rule_id = l.rule_id
    LEFT JOIN egos e ON e.key = l.there_key AND e.ego_id = l.ego_id
    LEFT JOIN actor_there ea ON ea.key = l.key AND ea.no = l.no AND ea.actor_id = l.ego_id
    LEFT JOIN actor_there oa ON oa.key = l.key AND oa.no = l.no AND oa.actor_id = l.object_id
    LEFT JOIN objects o ON o.key = l.there_key AND o.object_id IS NOT DISTINCT FROM l.object_id
), near AS (
    -- those where the other audit has such a finding close by, though it is taken or differs in place
    SELECT DISTINCT p.key, p.no FROM placed p
    JOIN {other_side}_finding f ON f.key = p.there_key AND f.ego_id = p.ego_id AND f.rule_id = p.rule_id
        AND f.profile IS NOT DISTINCT FROM p.profile AND f.object_id IS NOT DISTINCT FROM p.object_id
    WHERE greatest(f.from_s, p.from_s) - least(f.to_s, p.to_s) <= {near_s}
), row_there AS (
    SELECT p.key, p.no, v.verdict, v.n_judged, v.n_expected, n.key IS NOT NULL AS is_near,
        v.object_id IS NULL OR p.object_id IS NULL OR v.object_id = p.object_id OR v.verdict IN ('unknown', 'error') AND NOT p.has_object AS about,
        least(v.t_ref_ns, v.t_start_ns, v.t_end_ns, v.t_worst_ns) AS first_ns,
        greatest(v.t_ref_ns, v.t_start_ns, v.t_end_ns, v.t_worst_ns) AS last_ns,
        coalesce((first_ns - p.began_ns) / 1e9 - {near_s} <= p.to_s AND p.from_s <= (last_ns - p.began_ns) / 1e9 + {near_s}, true) AS at_that_time
    FROM placed p
    JOIN said v ON v.key = p.there_key AND v.ego_id = p.ego_id AND v.rule_id = p.rule_id AND (v.profile IS NULL OR v.profile = p.profile)
    LEFT JOIN near n ON n.key = p.key AND n.no = p.no
), weighed AS (
    SELECT key, no, min(CASE
        WHEN NOT about OR NOT at_that_time OR verdict = 'not_applicable' THEN NULL
        WHEN verdict = 'error' THEN 1 WHEN verdict = 'fail' AND is_near THEN 2 WHEN verdict = 'fail' AND n_judged = n_expected THEN 4
        WHEN verdict IN ('fail', 'unknown') THEN 3 ELSE 4 END) AS weight
    FROM row_there GROUP BY ALL
), answered AS (
    SELECT p.*, CASE WHEN NOT p.checked THEN ['none', 'drive_not_checked'] WHEN p.status = 'not_judged' THEN ['unknown', 'drive_not_judged']
        WHEN NOT p.has_rule THEN ['none', 'rule_not_run'] WHEN NOT p.has_profile THEN ['none', 'profile_not_run']
        WHEN NOT p.has_ego THEN ['none', 'ego_not_judged'] WHEN p.worst_s > p.duration_s + {near_s} THEN ['none', 'log_ends_before']
        WHEN w.key IS NULL THEN ['none', 'no_verdict'] WHEN w.weight < 4 THEN [['error', 'fail', 'unknown'][w.weight], 'judged']
        WHEN NOT p.ego_known THEN ['none', 'ego_not_there'] WHEN NOT p.ego_whole THEN ['unknown', 'ego_not_recorded']
        WHEN NOT p.object_known THEN ['none', 'object_not_there'] WHEN NOT p.object_whole THEN ['unknown', 'object_not_recorded']
        WHEN w.weight = 4 THEN ['pass', 'judged'] ELSE ['not_applicable', 'not_applicable'] END AS answer
    FROM placed p LEFT JOIN weighed w ON w.key = p.key AND w.no = p.no
)
SELECT * EXCLUDE (answer), answer[1] AS there, answer[2] AS why_code FROM answered
