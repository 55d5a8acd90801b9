-- Why verdicts of some drives with a page are unknown or errors: how often and of which rules, with the words of the first of these rules.
SELECT no, verdict, reason_code, cause_code, sum(n)::BIGINT AS n, list(rule_id ORDER BY rule_id) AS rules, arg_min(reason, rule_id) AS reason
FROM page_verdict
WHERE no BETWEEN $first AND $last AND reason_code IS NOT NULL
GROUP BY no, verdict, reason_code, cause_code
ORDER BY no, verdict, n DESC, reason_code, cause_code NULLS FIRST
