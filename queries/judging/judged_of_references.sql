-- Every expected point, judged or not; combined over objects where the rule says so.
-- A point of a window at which the automated driver does not drive is not judged: what happens there is not its doing.
INSERT INTO _judged BY NAME
WITH {condition}, _point_to_judge AS ({points}
), _joined AS (
    SELECT g.ref_no AS ref_id, g.drive_id, g.ego_id, g.object_id, {profile} AS profile,
        g.t_ns, g.seg, v.t_ns IS NULL OR v.applies AS applies, v.observed, v.required,
        -- without any object there, "all" holds with an infinite margin, and "any" fails by an infinite margin
        CASE WHEN g.nobody THEN CASE WHEN $_all THEN 'inf'::DOUBLE ELSE '-inf'::DOUBLE END ELSE v.gain END AS gain,
        CASE WHEN {human} THEN NULL WHEN g.nobody THEN CASE WHEN g.sensor_range_m IS NULL THEN $_all END
            WHEN v.applies AND g.lost IS NULL THEN v.holds END AS holds,
        CASE WHEN g.lost IS NOT NULL THEN g.lost WHEN g.t_ns IS NULL THEN 'anchor_unknown'
            WHEN {human} THEN {why_human}
            WHEN g.nobody AND g.sensor_range_m IS NULL THEN 'nobody_there'
            WHEN g.nobody THEN 'beyond_sensor_range' WHEN v.t_ns IS NULL THEN 'missing_step'
            WHEN v.applies IS NULL THEN coalesce(v.code, 'applies_unknown') ELSE v.code END AS code,
        CASE WHEN NOT ({human}) THEN v.reason END AS reason
    FROM _point_to_judge g {profiles}
    LEFT JOIN _state v ON g.drive_id = v.drive_id AND g.ego_id = v.ego_id AND g.t_ns = v.t_ns{same_key}
    {condition_joins}
), _expected AS (SELECT * FROM _joined WHERE applies IS DISTINCT FROM false
){series}
SELECT $_no AS rule_no, '' AS label, * REPLACE (coalesce(object_id, '') AS object_id, coalesce(who, '') AS who), row_number()
    OVER (PARTITION BY ref_id, drive_id, ego_id, object_id, profile ORDER BY t_ns) AS n FROM _point
