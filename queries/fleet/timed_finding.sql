-- The findings of one audit with their times in seconds since the log began, numbered in each drive, and the same drive in the other audit.
CREATE OR REPLACE TEMP TABLE {side}_finding AS
SELECT f.key, f.finding_id, f.drive_id, f.ego_id, f.rule_id, f.profile, f.object_id, f.severity, f.margin, f.required, f.x_m, f.y_m, f.unit,
    s.base_key, s.new_key, coalesce(s.same_log, false) AS same_log,
    (f.t_start_ns - coalesce(d.t_start_ns, 0)) / 1e9 AS from_s, (f.t_end_ns - coalesce(d.t_start_ns, 0)) / 1e9 AS to_s,
    (f.t_worst_ns - coalesce(d.t_start_ns, 0)) / 1e9 AS worst_s,
    row_number() OVER (PARTITION BY f.key ORDER BY f.drive_id, f.ego_id, f.rule_id, f.profile NULLS FIRST, f.object_id NULLS FIRST,
        f.occurrence, f.finding_id) AS no
FROM {of}findings f JOIN {of}drives d ON d.key = f.key LEFT JOIN same_drive s ON s.{side}_key = f.key
