-- Per value of one situation: the drives in it with their exposure, and the verdicts and findings of all rules there.
WITH {subject}, said AS (
    SELECT key, ego_id, count(*) FILTER (verdict IN ('pass', 'fail')) AS n_decided, count(*) FILTER (verdict = 'fail') AS n_failed,
        count(*) FILTER (verdict IN ('unknown', 'error')) AS n_unknown
    FROM {of}verdicts GROUP BY ALL
), found AS (
    SELECT key, ego_id, count(*) AS n FROM {of}findings GROUP BY ALL
)
SELECT s.tag_value, count(*) AS egos, coalesce(sum(round(1e9 * s.km)::BIGINT), 0) / 1e9 AS km,
    coalesce(sum(round(3.6e9 * s.hours)::BIGINT), 0) / 3.6e9 AS hours,
    coalesce(sum(n_decided), 0)::BIGINT AS occasions, coalesce(sum(n_failed), 0)::BIGINT AS occasions_failed,
    coalesce(sum(n_unknown), 0)::BIGINT AS occasions_unknown, coalesce(sum(f.n), 0)::BIGINT AS findings
FROM subject s
LEFT JOIN said v ON v.key = s.key AND v.ego_id = s.ego_id
LEFT JOIN found f ON f.key = s.key AND f.ego_id = s.ego_id
GROUP BY s.tag_value
ORDER BY s.tag_value NULLS LAST
