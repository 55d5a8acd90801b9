-- Per reason of verdicts that are unknown or in error, and that is not a missing signal: how many rules, drives and verdicts it is about; a rule
-- of these, and the reason of one of its verdicts in words.
WITH {subject}
SELECT v.reason_code, v.cause_code, count(DISTINCT v.rule_id) AS rules, count(DISTINCT s.content) AS drives, count(*) AS verdicts,
    min(v.rule_id) AS rule_id, arg_min(v.reason, [v.rule_id, v.reason]) AS reason
FROM {of}verdicts v JOIN subject s ON s.key = v.key AND s.ego_id = v.ego_id
WHERE v.verdict IN ('unknown', 'error') AND NOT starts_with(v.reason_code, 'missing_')
GROUP BY ALL
ORDER BY verdicts DESC, v.reason_code, v.cause_code NULLS FIRST
