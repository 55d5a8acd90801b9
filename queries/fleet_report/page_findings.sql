-- The findings of each drive with a page, the worst first, at most `$most` of each; `n_*`: how many the drive has.
CREATE OR REPLACE TEMP TABLE page_finding AS
SELECT p.no, row_number() OVER (PARTITION BY p.no ORDER BY {gravest_first}) AS nth, count(*) OVER drive AS n_all,
    count(CASE WHEN f.severity = 'critical' THEN 1 END) OVER drive AS n_critical, count(CASE WHEN f.severity = 'major' THEN 1 END) OVER drive AS n_major,
    count(CASE WHEN f.severity = 'minor' THEN 1 END) OVER drive AS n_minor,
    f.finding_id, f.ego_id, f.rule_id, f.profile, f.severity, f.object_id, f.t_worst_ns, f.t_start_s, f.t_worst_s,
    f.t_start_s + (f.t_end_ns - f.t_start_ns) / 1e9 AS t_end_s, f.reason, f.reason_measures, f.observed, f.required, f.margin, f.unit, f.n_copies, f.n_stays
FROM findings f
JOIN page_drive p ON p.key = f.key
LEFT JOIN rules r ON r.rule_id = f.rule_id
WINDOW drive AS (PARTITION BY p.no)
QUALIFY nth <= $most
ORDER BY p.no, nth
