-- One row per finding of either audit: new, fixed, changed, unchanged, elsewhere, unknown or lost, and what else differs between
-- the two audits there.
CREATE OR REPLACE TEMP TABLE difference AS
WITH known AS (
    SELECT drive, new_no, base_no, false AS is_part FROM pair UNION ALL SELECT drive, new_no, base_no, true FROM part
), both_sides AS (
    SELECT n.finding_id, b.finding_id AS base_id, n.key AS new_key, b.key AS base_key, n.drive_id, n.ego_id, n.rule_id, n.profile, n.object_id,
        n.severity, n.worst_s AS t_s, n.margin, b.margin AS base_margin, n.unit, 'fail' AS there, NULL AS why_code, b.severity AS base_severity,
        n.from_s, n.to_s, b.from_s AS base_from_s, b.to_s AS base_to_s, k.is_part,
        CASE WHEN n.margin IS NULL OR b.margin IS NULL THEN n.margin IS DISTINCT FROM b.margin WHEN n.margin = b.margin THEN false
            ELSE coalesce(abs(n.margin - b.margin) > greatest({margin_tolerance},
                {margin_tolerance} * greatest(abs(coalesce(n.required, 0)), abs(coalesce(b.required, 0)))), true) END AS margin_differs
    FROM known k
    JOIN new_finding n ON n.new_key = k.drive AND n.no = k.new_no
    JOIN base_finding b ON b.new_key = k.drive AND b.no = k.base_no
), told AS (
    SELECT CASE WHEN is_part OR severity <> base_severity OR margin_differs
            OR greatest(abs(from_s - base_from_s), abs(to_s - base_to_s)) > {interval_tolerance_s} THEN 'changed' ELSE 'unchanged' END AS standing,
        * EXCLUDE (margin_differs), coalesce(margin_differs AND margin < base_margin, false) AS worse
    FROM both_sides
    UNION ALL BY NAME
    SELECT 'new' AS standing, finding_id, key AS new_key, base_key, drive_id, ego_id, rule_id, profile, object_id, severity, worst_s AS t_s,
        margin, unit, there, why_code, false AS worse
    FROM new_only
    UNION ALL BY NAME
    SELECT CASE WHEN there IN ('pass', 'not_applicable') THEN 'fixed' WHEN there = 'none' THEN 'lost'
            WHEN there = 'fail' THEN 'elsewhere' ELSE 'unknown' END AS standing,
        finding_id, finding_id AS base_id, new_key, key AS base_key, drive_id, ego_id, rule_id, profile, object_id, severity, worst_s AS t_s,
        margin, margin AS base_margin, unit, there, why_code, false AS worse
    FROM base_only
), base_rule AS (
    -- a rule that an audit has in several versions, or with several parameters, has no known one
    SELECT rule_id, CASE WHEN count(DISTINCT rule_version) = 1 THEN min(rule_version) END AS version,
        CASE WHEN count(DISTINCT params::VARCHAR) = 1 THEN min([p."name" || '=' || p."value" FOR p IN params]::VARCHAR) END AS params
    FROM {base}rules GROUP BY rule_id
), new_rule AS (
    SELECT rule_id, CASE WHEN count(DISTINCT rule_version) = 1 THEN min(rule_version) END AS version,
        CASE WHEN count(DISTINCT params::VARCHAR) = 1 THEN min([p."name" || '=' || p."value" FOR p IN params]::VARCHAR) END AS params
    FROM {new}rules GROUP BY rule_id
), base_release AS (
    -- the software of a drive that the other audit does not have, where all drives of its audit have the same
    SELECT CASE WHEN count(DISTINCT tags['release']) = 1 AND count(tags['release']) = count(*) THEN min(tags['release']) END AS was FROM {base}drives
), new_release AS (
    SELECT CASE WHEN count(DISTINCT tags['release']) = 1 AND count(tags['release']) = count(*) THEN min(tags['release']) END AS now FROM {new}drives
), compared AS (
    SELECT t.*, {'drive': t.new_key IS NULL OR t.base_key IS NULL, 'software': coalesce(s.software, now <> was), 'rule': n.version <> b.version, 'parameters': n.params <> b.params, 'data': s.data, 'map': s.map,
        'tool': $new_tool::VARCHAR <> $base_tool::VARCHAR} AS differs
    FROM told t CROSS JOIN base_release CROSS JOIN new_release
    LEFT JOIN same_drive s ON s.new_key = t.new_key AND s.base_key = t.base_key
    LEFT JOIN base_rule b ON b.rule_id = t.rule_id
    LEFT JOIN new_rule n ON n.rule_id = t.rule_id
)
SELECT * EXCLUDE (differs),
    list_filter([CASE WHEN differs.drive THEN 'drive' END, CASE WHEN differs.software THEN 'software' END, CASE WHEN differs.rule THEN 'rule' END,
        CASE WHEN differs.parameters THEN 'parameters' END, CASE WHEN differs.data THEN 'data' END, CASE WHEN differs.map THEN 'map' END,
        CASE WHEN differs.tool THEN 'tool' END], lambda cause: cause IS NOT NULL) AS causes,
    list_filter([CASE WHEN differs.software IS NULL THEN 'software' END, CASE WHEN differs.rule IS NULL THEN 'rule' END,
        CASE WHEN differs.parameters IS NULL THEN 'parameters' END, CASE WHEN differs.data IS NULL AND NOT differs.drive THEN 'data' END,
        CASE WHEN differs.map IS NULL AND NOT differs.drive THEN 'map' END, CASE WHEN differs.tool IS NULL THEN 'tool' END],
        lambda cause: cause IS NOT NULL) AS causes_not_known
FROM compared
