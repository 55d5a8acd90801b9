-- A rule that failed is an error for every subject that it had to judge. `told`: the problem, NULL if the code states it; `again`: it
-- went beyond a limit earlier in this run, and was not tried here.
INSERT INTO _error
SELECT rule_no, drive_id, ego_id, $code,
    coalesce($told::VARCHAR, why(CASE $code
        WHEN 'rule_timeout' THEN CASE WHEN $again THEN 'rule_timeout_before' ELSE 'rule_timeout' END
        ELSE CASE WHEN $again THEN 'out_of_memory_before' ELSE 'out_of_memory' END END,
        {'rule_id': $rule::VARCHAR, 'limit_s': $limit_s::DOUBLE}))
FROM _todo WHERE rule_no = $no
