-- Per rule, profile and value of the tag: verdicts, findings and exposure, those of subjects (an ego in a drive) that were wholly judged
-- apart from those that were not. See `drivelint.fleet.rates` for what counts as what.
WITH {subject}, {profiled}, judged_subject AS (
    SELECT key, ego_id, rule_id, profile,
        count(*) FILTER (verdict = 'pass') AS n_pass, count(*) FILTER (verdict = 'fail') AS n_fail,
        count(*) FILTER (verdict = 'unknown') AS n_unknown, count(*) FILTER (verdict = 'not_applicable') AS n_not_applicable,
        count(*) FILTER (verdict = 'error') AS n_error,
        count(*) FILTER (verdict IN ('pass', 'fail') AND n_judged >= n_expected) AS n_whole,
        count(*) FILTER (verdict = 'fail' AND n_judged >= n_expected) AS n_whole_failed,
        -- A fail that was not judged at every step counts as not wholly judged, as a pass of that kind would be unknown: else the
        -- outcome would decide what is counted.
        CASE WHEN bool_or(verdict IN ('unknown', 'error') OR starts_with(reason_code, 'unrecorded_') OR verdict IN ('pass', 'fail') AND n_judged < n_expected) THEN 'unknown'
            WHEN bool_and(verdict = 'not_applicable' AND reason_code IN ('other_nation', 'not_engaged', 'outside_conditions'))
            THEN 'outside' ELSE 'judged' END AS extent
    FROM profiled GROUP BY ALL
), found AS (
    SELECT key, ego_id, rule_id, profile, count(*) AS n, count(*) FILTER (n_stays < {least_share} * n_copies) AS n_possible
    FROM {of}findings GROUP BY ALL
), sure AS (
    SELECT key, ego_id, rule_id, profile, count(*) AS n FROM ({event}) WHERE NOT is_possible GROUP BY ALL
), lost AS (
    SELECT {value} AS tag_value, count(*) AS n_lost
    FROM (SELECT *, NULL::STRUCT(km DOUBLE, hours DOUBLE) AS ego FROM {of}drives WHERE status <> 'judged') d {without} GROUP BY ALL
), counted AS (
    SELECT j.*, s.* EXCLUDE (key, ego_id), f.n AS n_found, f.n_possible, e.n AS n_sure
    FROM judged_subject j
    JOIN subject s ON s.key = j.key AND s.ego_id = j.ego_id
    LEFT JOIN found f ON f.key = j.key AND f.ego_id = j.ego_id AND f.rule_id = j.rule_id AND f.profile IS NOT DISTINCT FROM j.profile
    LEFT JOIN sure e ON e.key = j.key AND e.ego_id = j.ego_id AND e.rule_id = j.rule_id AND e.profile IS NOT DISTINCT FROM j.profile
    UNION ALL BY NAME
    -- Drives that could not be judged count for every rule, also at a value of the tag at which no other drive is.
    SELECT r.rule_id, r.profile, l.tag_value, l.n_lost FROM (SELECT DISTINCT rule_id, profile FROM judged_subject) r CROSS JOIN lost l
)
-- Way and time are summed as whole micrometres and microseconds, so that the order of summation does not change the result.
SELECT rule_id, profile, tag_value,
    count(*) FILTER (extent = 'judged') AS egos_judged, count(*) FILTER (extent = 'judged' AND n_fail > 0) AS egos_failed,
    count(*) FILTER (extent = 'unknown') AS egos_unknown, count(*) FILTER (extent = 'outside') AS egos_outside,
    coalesce(sum(n_lost), 0)::BIGINT AS drives_not_judged,
    coalesce(sum(round(1e9 * engaged_km)::BIGINT) FILTER (extent = 'judged'), 0) / 1e9 AS km,
    coalesce(sum(round(3.6e9 * engaged_hours)::BIGINT) FILTER (extent = 'judged'), 0) / 3.6e9 AS hours,
    coalesce(sum(round(1e9 * km)::BIGINT) FILTER (extent = 'unknown'), 0) / 1e9 AS km_unknown,
    coalesce(sum(round(3.6e9 * hours)::BIGINT) FILTER (extent = 'unknown'), 0) / 3.6e9 AS hours_unknown,
    coalesce(sum(n_found) FILTER (extent = 'judged'), 0)::BIGINT AS findings,
    coalesce(sum(n_found) FILTER (extent <> 'judged'), 0)::BIGINT AS findings_of_unknown,
    coalesce(sum(n_possible), 0)::BIGINT AS findings_possible, coalesce(sum(n_sure), 0)::BIGINT AS events_sure,
    coalesce(sum(n_whole), 0)::BIGINT AS occasions, coalesce(sum(n_whole_failed), 0)::BIGINT AS occasions_failed,
    coalesce(sum(n_pass + n_fail - n_whole), 0)::BIGINT AS occasions_partly,
    coalesce(sum(n_pass), 0)::BIGINT AS n_pass, coalesce(sum(n_fail), 0)::BIGINT AS n_fail, coalesce(sum(n_unknown), 0)::BIGINT AS n_unknown,
    coalesce(sum(n_not_applicable), 0)::BIGINT AS n_not_applicable, coalesce(sum(n_error), 0)::BIGINT AS n_error
FROM counted
GROUP BY rule_id, profile, tag_value
ORDER BY rule_id, profile NULLS FIRST, tag_value NULLS FIRST
