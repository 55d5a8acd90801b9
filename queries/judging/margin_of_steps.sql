-- Every expected step of `_judged`.
INSERT INTO _margin BY NAME
SELECT rule_no, drive_id, ego_id, profile, who AS object_id, ref_id, t_ns,
    finite(observed) AS observed, finite(required) AS required, margin_of(r.sense, observed, required, holds) AS margin, holds
FROM _judged JOIN _rule r USING (rule_no) WHERE t_ns IS NOT NULL AND applies IS DISTINCT FROM false
