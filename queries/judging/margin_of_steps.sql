-- Every expected step of `_judged`.
INSERT INTO _margin BY NAME
SELECT $_no AS rule_no, drive_id, ego_id, profile, {object} AS object_id, ref_id, t_ns,
    finite(observed) AS observed, finite(required) AS required, margin_of($_sense, observed, required, holds) AS margin, holds
FROM _judged WHERE t_ns IS NOT NULL AND {expected}
