-- How many verdicts of each kind each drive with a page has, by rule; of those that are unknown or errors also by reason, with the words of one.
CREATE OR REPLACE TEMP TABLE page_verdict AS
WITH told AS (
    SELECT p.no, v.rule_id, v.verdict, v.verdict IN ('unknown', 'error') AS is_open, v.reason_code, v.cause_code, v.reason
    FROM verdicts v JOIN page_drive p ON p.key = v.key
)
SELECT no, rule_id, verdict, CASE WHEN is_open THEN reason_code END AS reason_code, CASE WHEN is_open THEN cause_code END AS cause_code,
    count(*) AS n, min(reason) FILTER (is_open) AS reason
FROM told
GROUP BY ALL
ORDER BY no, verdict, reason_code NULLS FIRST, cause_code NULLS FIRST, rule_id
