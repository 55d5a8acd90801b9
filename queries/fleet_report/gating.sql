-- One of each event counts. New findings of stable rules by severity; those of drives that only one audit has (`alone_`: rows; `added_`: those that gate); those of the base that are gone and not fixed; known ones that are worse; of the fixed ones those that pass now and those that do not apply. Then how many there are of each standing, and whether several profiles found one event.
WITH new_counted AS ({new_counted}), base_counted AS ({base_counted}), sided AS (
    SELECT *, standing NOT IN ('fixed', 'elsewhere', 'unknown', 'lost') AS is_new, CASE WHEN is_new THEN new_key ELSE base_key END AS key
    FROM difference
), told AS (
    SELECT d.*, d.rule_id IN (SELECT rule_id FROM {new}rules WHERE status = 'stable') AS stable,
        d.rule_id IN (SELECT rule_id FROM {base}rules WHERE status = 'stable') AS was_stable, coalesce(c.counted_id, d.finding_id) AS counted,
        {'key': d.key, 'id': counted} AS event
    FROM sided d
    LEFT JOIN (SELECT *, true AS is_new FROM new_counted UNION ALL SELECT *, false FROM base_counted) c
        ON c.is_new = d.is_new AND c.key = d.key AND c.finding_id = d.finding_id
), altered AS (
    SELECT DISTINCT event FROM told WHERE standing = 'changed'
)
SELECT
    count(DISTINCT event) FILTER (standing = 'new' AND stable AND severity = 'critical') AS critical,
    count(DISTINCT event) FILTER (standing = 'new' AND stable AND severity = 'major') AS major,
    count(DISTINCT event) FILTER (standing = 'new' AND stable AND severity = 'minor') AS minor,
    count(DISTINCT event) FILTER (standing IN ('unknown', 'lost', 'elsewhere') AND was_stable AND severity = 'critical') AS gone_critical,
    count(DISTINCT event) FILTER (standing IN ('unknown', 'lost', 'elsewhere') AND was_stable AND severity = 'major') AS gone_major,
    count(DISTINCT event) FILTER (standing IN ('unknown', 'lost', 'elsewhere') AND was_stable AND severity = 'minor') AS gone_minor,
    count(DISTINCT event) FILTER (worse) AS worse,
    count(DISTINCT event) FILTER (standing = 'new' AND why_code = 'drive_not_checked') AS of_new_drives,
    count(DISTINCT event) FILTER (standing = 'lost' AND why_code = 'drive_not_checked') AS of_base_drives,
    count(*) FILTER (standing = 'new' AND why_code = 'drive_not_checked') AS alone_new,
    count(*) FILTER (standing = 'lost' AND why_code = 'drive_not_checked') AS alone_lost,
    count(DISTINCT event) FILTER (standing = 'new' AND why_code = 'drive_not_checked' AND stable AND severity = 'critical') AS added_critical,
    count(DISTINCT event) FILTER (standing = 'new' AND why_code = 'drive_not_checked' AND stable AND severity = 'major') AS added_major,
    count(DISTINCT event) FILTER (standing = 'new' AND why_code = 'drive_not_checked' AND stable AND severity = 'minor') AS added_minor,
    count(DISTINCT event) FILTER (standing = 'fixed' AND there = 'pass') AS passes,
    count(DISTINCT event) FILTER (standing = 'fixed') - count(DISTINCT event) FILTER (standing = 'fixed' AND there = 'pass') AS not_applicable,
    count(DISTINCT event) FILTER (standing = 'new') AS "new",
    count(DISTINCT event) FILTER (standing = 'changed') AS changed,
    count(DISTINCT event) FILTER (standing = 'unchanged' AND event NOT IN (SELECT event FROM altered)) AS unchanged,
    count(DISTINCT event) FILTER (standing = 'elsewhere') AS elsewhere,
    count(DISTINCT event) FILTER (standing = 'unknown') AS "unknown",
    count(DISTINCT event) FILTER (standing = 'lost') AS lost,
    count(DISTINCT event) FILTER (standing = 'fixed') AS fixed,
    coalesce(bool_or(profile IS NOT NULL) FILTER (counted <> finding_id), false) AS of_profiles
FROM told
