-- Why verdicts of rules that gate are unknown, most first; `reason`: what one of them says.
SELECT reason_code, count(*) AS n, count(DISTINCT rule_id) AS n_rules, count(DISTINCT key) AS n_drives, min(reason) AS reason
FROM counted_verdicts
SEMI JOIN (FROM rules WHERE status = 'stable') USING (rule_id)
WHERE verdict = 'unknown'
GROUP BY ALL
ORDER BY n DESC, reason_code
