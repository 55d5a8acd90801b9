-- Every step of an invariant's grid, judged or not.
-- The conditions are left-joined to the grid on keys alone: a row that the author's join lost is an unknown step.
INSERT INTO _judged BY NAME
WITH {condition}, {grid}, _joined AS (
    SELECT $_no AS rule_no, g.drive_id, g.ego_id, coalesce(g.object_id, '') AS object_id, coalesce(g.object_id, '') AS who, {profile} AS profile,
        coalesce(g.label, '') AS label, NULL::INTEGER AS ref_id, g.t_ns, g.k, g.seg,
        g.applies AND (v.t_ns IS NULL OR v.applies) AS applies, v.holds, v.gain, v.observed, v.required,
        CASE WHEN g.applies IS NULL THEN g.doubt WHEN v.t_ns IS NULL THEN 'missing_step'
            WHEN v.applies IS NULL THEN coalesce(v.code, 'applies_unknown') ELSE v.code END AS code,
        CASE WHEN g.applies THEN v.reason WHEN g.applies IS NULL AND g.doubt = 'applies_unknown' THEN g.why END AS reason
    FROM _step_to_judge g {profiles}
    LEFT JOIN _state v ON g.drive_id = v.drive_id AND g.ego_id = v.ego_id AND g.t_ns = v.t_ns{same_key}
), _steps AS (SELECT * REPLACE (CASE WHEN applies THEN holds END AS holds) FROM _joined
{kept}
