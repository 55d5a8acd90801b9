-- The findings of each drive with a page, the worst first, at most `$most` of each; `n_rows`: how many rows the drive has, `n_*`: how many
-- findings of a severity they are, as one of each event counts; `is_of_profiles`: a row that does not count is of a profile.
CREATE OR REPLACE TEMP TABLE page_finding AS
WITH paged_findings AS MATERIALIZED (SELECT f.*, p.no FROM findings f JOIN page_drive p ON p.key = f.key)
SELECT f.no, row_number() OVER (PARTITION BY f.no ORDER BY {gravest_first}) AS nth, count(*) OVER drive AS n_rows,
    count(CASE WHEN f.severity = 'critical' THEN e.finding_id END) OVER drive AS n_critical,
    count(CASE WHEN f.severity = 'major' THEN e.finding_id END) OVER drive AS n_major,
    count(CASE WHEN f.severity = 'minor' THEN e.finding_id END) OVER drive AS n_minor,
    bool_or(e.finding_id IS NULL AND f.profile IS NOT NULL) OVER drive AS is_of_profiles,
    f.finding_id, f.ego_id, f.rule_id, f.profile, f.severity, f.object_id, f.t_worst_ns, f.t_start_s, f.t_worst_s,
    f.t_start_s + (f.t_end_ns - f.t_start_ns) / 1e9 AS t_end_s, f.reason, f.reason_measures, f.observed, f.required, f.margin, f.unit, f.n_copies, f.n_stays
FROM paged_findings f
LEFT JOIN ({event}) e ON e.key = f.key AND e.finding_id = f.finding_id
LEFT JOIN rules r ON r.rule_id = f.rule_id
WINDOW drive AS (PARTITION BY f.no)
QUALIFY nth <= $most
ORDER BY f.no, nth
