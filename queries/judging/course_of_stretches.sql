-- The measure's values around the failing stretches of `_judged`: from 2 s before to 2 s after a stretch and 5 s around its worst step, but
-- at most 30 s from that; thinned to some 150 steps, of which each is the worst of its share.
INSERT INTO _course BY NAME
WITH _stretch_with_range AS (
    SELECT s.*, greatest(t_worst_ns - 30_000_000_000, least(t_worst_ns - 5_000_000_000, t_start_ns - 2_000_000_000)) AS t_from_ns,
        least(t_worst_ns + 30_000_000_000, greatest(t_worst_ns + 5_000_000_000, t_end_ns + 2_000_000_000)) AS t_to_ns,
        CASE WHEN r.by_object THEN s.object_id ELSE '' END AS same_object_id, r.sense
    FROM _stretch s JOIN _rule r USING (rule_no)
)
SELECT s.rule_no, s.drive_id, s.ego_id, s.object_id, s.profile, s.ref_id, s.t_start_ns, false AS near, j.t_ns,
    finite(j.observed) AS observed, finite(j.required) AS required, margin_of(s.sense, j.observed, j.required, j.holds) AS margin, j.holds
FROM _stretch_with_range s
JOIN (
    SELECT j.*, CASE WHEN r.by_object THEN j.object_id ELSE '' END AS same_object_id FROM _judged j JOIN _rule r USING (rule_no)
    WHERE j.applies IS DISTINCT FROM false
) j ON j.rule_no = s.rule_no AND j.drive_id = s.drive_id AND j.ego_id = s.ego_id AND j.profile IS NOT DISTINCT FROM s.profile
    AND j.ref_id IS NOT DISTINCT FROM s.ref_id AND j.same_object_id = s.same_object_id AND j.t_ns BETWEEN s.t_from_ns AND s.t_to_ns
QUALIFY row_number() OVER (
    PARTITION BY s.rule_no, s.drive_id, s.ego_id, s.object_id, s.profile, s.ref_id, s.t_start_ns,
        (j.t_ns - s.t_from_ns) * 150 // (s.t_to_ns - s.t_from_ns)
    ORDER BY coalesce(j.holds::INTEGER, 1), margin NULLS LAST, j.t_ns
) = 1
