-- part of `course_of_near_misses.sql`: near misses among the groups that the first pass settled, and their steps
{condition}, _steps AS (
    SELECT drive_id, ego_id, {object} AS object_id, '' AS profile, NULL::INTEGER AS ref_id, '' AS label, t_ns,
        observed, required, holds, gain
    FROM _state
), _near_miss AS (
    SELECT g.drive_id, g.ego_id, coalesce(g.object_id, '') AS object_id, '' AS profile, NULL::INTEGER AS ref_id, '' AS label,
        g.t_start_ns, g.t_end_ns, g.t_worst_ns, g.margin
    FROM _group g JOIN _rule r USING (rule_no) WHERE rule_no = $_no AND g.clean AND is_near_miss(g.margin, r.near_margin)
)
