-- Number of drives with a finding of a contact that is sure or was not examined, and of drives with only possible ones.
SELECT count(*) FILTER (NOT only_possible) AS contacts, count(*) FILTER (only_possible) AS contacts_possible
FROM (
    SELECT f.key, bool_and(f.is_possible) AS only_possible
    FROM ({event}) f
    JOIN rules r USING (rule_id)
    WHERE list_contains(r.tags, 'contact')
    GROUP BY f.key
)
