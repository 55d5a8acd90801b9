-- Number of findings per rule, standing and what else differs.
SELECT rule_id, profile, standing, causes, causes_not_known, count(*) AS n FROM difference GROUP BY ALL ORDER BY ALL NULLS FIRST
