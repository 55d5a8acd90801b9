-- part of `grid.sql`: the steps that the section @applies returns
_applies AS (
{author}
), _applies_by_step AS (
    SELECT drive_id, ego_id, t_ns, {author_object} AS object_id, {label} AS label,
        CASE WHEN bool_or(coalesce({applies}, false)) THEN true WHEN bool_or({applies} IS NULL) THEN NULL ELSE false END AS applies,
        {why} AS why
    FROM _applies GROUP BY ALL
), _base AS (
    SELECT a.drive_id, a.ego_id, a.t_ns, {object} AS object_id, a.label, b.k, b.seg, a.applies, a.why
    FROM _applies_by_step a LEFT JOIN step b ON a.drive_id = b.drive_id AND a.ego_id = b.ego_id AND a.t_ns = b.t_ns
    {objects})
