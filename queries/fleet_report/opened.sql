-- Verdicts that are unknown or errors in drives of both audits and were not in the base, by reason: their number, the rules, an example.
WITH now AS (
    SELECT s.new_key, v.ego_id, v.rule_id, v.profile, v.reason_code, v.cause_code, count(*) AS n, min(v.reason) AS reason
    FROM {new}verdicts v JOIN same_drive s ON s.new_key = v.key WHERE v.verdict IN ('unknown', 'error') GROUP BY ALL
), was AS (
    SELECT s.new_key, v.ego_id, v.rule_id, v.profile, count(*) AS n
    FROM {base}verdicts v JOIN same_drive s ON s.base_key = v.key WHERE v.verdict IN ('unknown', 'error') GROUP BY ALL
), whole AS (
    -- the reason given most often stands for all of them
    SELECT new_key, ego_id, rule_id, profile, sum(n) AS n,
        unnest(first({'reason_code': reason_code, 'cause_code': cause_code, 'reason': reason} ORDER BY n DESC, reason_code, cause_code))
    FROM now GROUP BY new_key, ego_id, rule_id, profile
)
SELECT reason_code, cause_code, min(reason) AS reason, sum(w.n - coalesce(b.n, 0))::BIGINT AS n, list_sort(list(DISTINCT w.rule_id)) AS rules,
    count(DISTINCT w.new_key) AS n_drives
FROM whole w
LEFT JOIN was b ON b.new_key = w.new_key AND b.ego_id = w.ego_id AND b.rule_id = w.rule_id AND b.profile IS NOT DISTINCT FROM w.profile
WHERE w.n > coalesce(b.n, 0)
GROUP BY ALL
ORDER BY n DESC, reason_code, cause_code NULLS FIRST
