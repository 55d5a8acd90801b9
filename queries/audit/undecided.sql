-- Whether there are verdicts of rules that gate, and nothing at all was decided: every verdict is unknown, or lacks a signal of the log.
SELECT coalesce(bool_and(v.verdict = 'unknown' OR starts_with(v.reason_code, $unrecorded)) AND bool_or(r.status = 'stable'), false) AS is_undecided
FROM counted_verdicts v
JOIN rules r USING (rule_id)
