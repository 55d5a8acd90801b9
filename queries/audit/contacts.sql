-- How many drives have a finding of a rule about contacts.
SELECT count(DISTINCT f.key)
FROM findings f
JOIN rules r USING (rule_id)
WHERE list_contains(r.tags, 'contact')
