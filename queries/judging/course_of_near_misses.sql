-- The steps within 5 s of the worst step of a near miss, for the 20 closest near misses of each ego, rule and profile.
INSERT INTO _course BY NAME
WITH {misses}, _closest_near_miss AS (
    SELECT * FROM _near_miss
    QUALIFY row_number() OVER (PARTITION BY drive_id, ego_id, profile ORDER BY margin, t_worst_ns, object_id, ref_id) <= 20
)
SELECT $_no AS rule_no, s.drive_id, s.ego_id, s.object_id, s.profile, s.ref_id, s.t_start_ns, true AS near, j.t_ns,
    finite(j.observed) AS observed, finite(j.required) AS required, margin_of($_sense, j.observed, j.required, j.holds) AS margin, j.holds
FROM _closest_near_miss s
JOIN _steps j ON j.drive_id = s.drive_id AND j.ego_id = s.ego_id AND j.profile = s.profile
    AND j.ref_id IS NOT DISTINCT FROM s.ref_id{same_key}
    AND j.t_ns BETWEEN s.t_worst_ns - 5_000_000_000 AND s.t_worst_ns + 5_000_000_000
QUALIFY row_number() OVER (
    PARTITION BY s.drive_id, s.ego_id, s.object_id, s.profile, s.ref_id, s.t_start_ns, (j.t_ns - s.t_worst_ns) // 70_000_000
    ORDER BY coalesce(j.holds::INTEGER, 1), margin NULLS LAST, j.t_ns
) = 1
