-- New findings of stable rules by severity; those of drives that the base does not have; those of the base that are gone and not fixed; known ones that are worse; of the fixed ones those that pass now and those that do not apply.
SELECT
    count(*) FILTER (standing = 'new' AND stable AND severity = 'critical') AS critical,
    count(*) FILTER (standing = 'new' AND stable AND severity = 'major') AS major,
    count(*) FILTER (standing = 'new' AND stable AND severity = 'minor') AS minor,
    count(*) FILTER (standing IN ('unknown', 'lost', 'elsewhere') AND was_stable AND severity = 'critical') AS gone_critical,
    count(*) FILTER (standing IN ('unknown', 'lost', 'elsewhere') AND was_stable AND severity = 'major') AS gone_major,
    count(*) FILTER (standing IN ('unknown', 'lost', 'elsewhere') AND was_stable AND severity = 'minor') AS gone_minor,
    count(*) FILTER (worse) AS worse,
    count(*) FILTER (standing = 'new' AND why_code = 'drive_not_checked') AS of_new_drives,
    count(*) FILTER (standing = 'fixed' AND there = 'pass') AS passes,
    count(*) FILTER (standing = 'fixed' AND there = 'not_applicable') AS not_applicable
FROM (SELECT *, rule_id IN (SELECT rule_id FROM {new}rules WHERE status = 'stable') AS stable,
    rule_id IN (SELECT rule_id FROM {base}rules WHERE status = 'stable') AS was_stable FROM difference)
