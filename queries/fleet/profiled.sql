-- Part of the statements of this folder: `profiled` has the verdicts with their profile. A verdict without one, of a rule that has
-- profiles, stands for all of them: the rule could not be judged at all.
profile_of_rule AS (
    SELECT DISTINCT rule_id, unnest(profiles) AS profile FROM {of}rules
), profiled AS (
    SELECT v.* REPLACE (coalesce(v.profile, p.profile) AS profile)
    FROM {of}verdicts v
    -- one equality, so that DuckDB hashes: a condition on one side alone makes a left join a loop over all pairs
    LEFT JOIN (SELECT * FROM profile_of_rule) p ON p.rule_id = CASE WHEN v.profile IS NULL THEN v.rule_id END
)
