-- The judged steps around the findings and near misses of the drives $ids. Where a rule and profile has several at one step (other egos,
-- other objects), the one that fails or else has the least margin.
SELECT drive_id, rule_id, profile, t_ns, ego_id, object_id, observed, required, margin, holds
FROM (
    SELECT drive_id, rule_id, profile, ego_id, object_id, occurrence, unnest(t_ns) AS t_ns, unnest(observed) AS observed,
        unnest(required) AS required, unnest(margin) AS margin, unnest(holds) AS holds
    FROM course
    WHERE list_contains($ids, drive_id)
)
QUALIFY row_number() OVER (
    PARTITION BY drive_id, rule_id, profile, t_ns
    ORDER BY coalesce(holds, true), margin NULLS LAST, ego_id, object_id NULLS FIRST, occurrence
) = 1
ORDER BY drive_id, rule_id, profile NULLS FIRST, t_ns
