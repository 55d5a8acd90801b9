-- The steps within 5 s of the worst step of a near miss, for the 20 closest near misses of each ego, rule and profile.
INSERT INTO _course BY NAME
WITH _steps AS (
    SELECT j.*, CASE WHEN r.by_object THEN j.object_id ELSE '' END AS same_object_id, r.sense FROM _judged j JOIN _rule r USING (rule_no)
    WHERE j.applies IS DISTINCT FROM false
), _near_miss AS (
    SELECT o.rule_no, o.drive_id, o.ego_id, coalesce(o.object_id, '') AS object_id, coalesce(o.profile, '') AS profile, o.ref_id,
        coalesce(o.label, '') AS label, o.t_start_ns, o.t_end_ns, o.t_worst_ns, o.margin,
        CASE WHEN r.by_object THEN coalesce(o.object_id, '') ELSE '' END AS same_object_id
    FROM _outcome o JOIN _rule r USING (rule_no) WHERE o.verdict = 'pass' AND is_near_miss(o.margin, r.near_margin)
), _closest_near_miss AS (
    SELECT * FROM _near_miss
    QUALIFY row_number() OVER (PARTITION BY rule_no, drive_id, ego_id, profile ORDER BY margin, t_worst_ns, object_id, ref_id) <= 20
)
SELECT s.rule_no, s.drive_id, s.ego_id, s.object_id, s.profile, s.ref_id, s.t_start_ns, true AS near, j.t_ns,
    finite(j.observed) AS observed, finite(j.required) AS required, margin_of(j.sense, j.observed, j.required, j.holds) AS margin, j.holds
FROM _closest_near_miss s
JOIN _steps j ON j.rule_no = s.rule_no AND j.drive_id = s.drive_id AND j.ego_id = s.ego_id AND j.profile = s.profile
    AND j.ref_id IS NOT DISTINCT FROM s.ref_id AND j.same_object_id = s.same_object_id AND j.label = s.label
    AND j.t_ns BETWEEN s.t_worst_ns - 5_000_000_000 AND s.t_worst_ns + 5_000_000_000
QUALIFY row_number() OVER (
    PARTITION BY s.rule_no, s.drive_id, s.ego_id, s.object_id, s.profile, s.ref_id, s.t_start_ns, (j.t_ns - s.t_worst_ns) // 70_000_000
    ORDER BY coalesce(j.holds::INTEGER, 1), margin NULLS LAST, j.t_ns
) = 1
