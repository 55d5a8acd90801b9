-- part of `course_of_near_misses.sql`: near misses among `_outcome`, and their steps
_steps AS (
    SELECT * FROM _judged WHERE {expected}
), _near_miss AS (
    SELECT o.drive_id, o.ego_id, coalesce(o.object_id, '') AS object_id, coalesce(o.profile, '') AS profile, o.ref_id,
        coalesce(o.label, '') AS label, o.t_start_ns, o.t_end_ns, o.t_worst_ns, o.margin
    FROM _outcome o JOIN _rule r USING (rule_no) WHERE rule_no = $_no AND o.verdict = 'pass' AND is_near_miss(o.margin, r.near_margin)
)
