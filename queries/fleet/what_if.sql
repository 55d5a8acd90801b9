-- The verdict of each row of a rule if a parameter that is the required value were $value; NULL: a new check is needed.
CREATE OR REPLACE TEMP TABLE what_if AS
WITH {subject}, row_of_rule AS (
    SELECT v.key, v.ego_id, v.profile, v.object_id, v.occurrence, s.tag_value, v.verdict AS was, v.observed, v.n_judged, v.n_expected,
        v.rule_version = $rule_version AS same_rule, v.observed {sense} $value AS holds
    FROM {of}verdicts v JOIN subject s ON s.key = v.key AND s.ego_id = v.ego_id
    WHERE v.rule_id = $rule_id
)
SELECT key, ego_id, profile, object_id, occurrence, tag_value, was, CASE
    WHEN NOT same_rule THEN NULL
    WHEN was IN ('not_applicable', 'error') THEN was
    -- An observed value without limit is stored as NULL: it is so for every finite parameter.
    WHEN was IN ('pass', 'fail') AND observed IS NULL THEN was
    -- The observed value of an unknown verdict is that of the worst step that was judged.
    WHEN was = 'unknown' AND n_judged = 0 THEN CASE WHEN NOT $is_bound OR observed IS NULL THEN was END
    WHEN was = 'unknown' THEN CASE WHEN holds THEN was WHEN NOT $is_bound THEN 'fail' END
    -- Where the observed value may be a lower bound, it proves one of the two verdicts only, and the rows do not say whether it is one.
    WHEN $is_bound AND was = $proven AND holds <> (was = 'pass') THEN NULL
    WHEN NOT holds THEN 'fail' WHEN n_judged = n_expected THEN 'pass' ELSE 'unknown' END AS becomes
FROM row_of_rule
