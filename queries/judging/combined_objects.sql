, _combined_point AS (
    -- part of `judged_of_references.sql`: all objects at one point combined into one row, by three-valued AND (combine = all) or OR (any);
    -- `who` is the object that decides
    SELECT ref_id, drive_id, ego_id, profile, t_ns, seg, count(*) - count(DISTINCT coalesce(object_id, '')) + 1 AS n_same,
        {deciding_object} AS d
    FROM _expected GROUP BY ALL
), _point AS (
    SELECT ref_id, drive_id, ego_id, NULL::VARCHAR AS object_id, profile, t_ns, seg, d.observed AS observed,
        d.required AS required, d.gain AS gain, d.holds AS holds, d.code AS code, d.reason AS reason, d.who AS who, n_same
    FROM _combined_point)
