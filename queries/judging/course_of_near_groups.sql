-- The steps within 5 s of the worst step of a near miss, for the 20 closest near misses of each ego among the groups of a rule that the
-- first pass settled.
INSERT INTO _course BY NAME
WITH {condition}, _steps AS (
    SELECT drive_id, ego_id, {object} AS object_id, '' AS profile, NULL::INTEGER AS ref_id, '' AS label, t_ns,
        observed, required, holds, gain
    FROM _state
), _near_miss AS (
    SELECT g.drive_id, g.ego_id, coalesce(g.object_id, '') AS object_id, '' AS profile, NULL::INTEGER AS ref_id, '' AS label,
        g.t_start_ns, g.t_end_ns, g.t_worst_ns, g.margin
    FROM _group g JOIN _rule r USING (rule_no) WHERE rule_no = $_no AND g.clean AND is_near_miss(g.margin, r.near_margin)
), _closest_near_miss AS (
    SELECT * FROM _near_miss
    QUALIFY row_number() OVER (PARTITION BY drive_id, ego_id, profile ORDER BY margin, t_worst_ns, object_id, ref_id) <= 20
)
SELECT $_no AS rule_no, s.drive_id, s.ego_id, s.object_id, s.profile, s.ref_id, s.t_start_ns, true AS near, j.t_ns,
    finite(j.observed) AS observed, finite(j.required) AS required, margin_of($_sense, j.observed, j.required, j.holds) AS margin, j.holds
FROM _closest_near_miss s
JOIN _steps j ON j.drive_id = s.drive_id AND j.ego_id = s.ego_id AND j.profile = s.profile
    AND j.ref_id IS NOT DISTINCT FROM s.ref_id AND j.object_id = s.object_id
    AND j.t_ns BETWEEN s.t_worst_ns - 5_000_000_000 AND s.t_worst_ns + 5_000_000_000
QUALIFY row_number() OVER (
    PARTITION BY s.drive_id, s.ego_id, s.object_id, s.profile, s.ref_id, s.t_start_ns, (j.t_ns - s.t_worst_ns) // 70_000_000
    ORDER BY coalesce(j.holds::INTEGER, 1), margin NULLS LAST, j.t_ns
) = 1
