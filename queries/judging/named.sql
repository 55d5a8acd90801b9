-- The verdicts of `_closed` with the columns of their rule and drive. `cause`: the rule's reason, or why what it
-- reads is not known.
CREATE OR REPLACE TEMP TABLE _named AS
WITH _verdict_with_rule AS (
    SELECT v.* REPLACE (nullif(v.profile, '') AS profile, nullif(v.object_id, '') AS object_id,
        nullif(v.label, '') AS label), r.* EXCLUDE (rule_no), coalesce(s.start_ns, 0) AS start_ns,
        s.t_start_ns AS ego_from_ns, s.t_end_ns AS ego_to_ns
    FROM _closed v JOIN _rule r USING (rule_no) LEFT JOIN _subject s ON s.drive_id = v.drive_id AND s.ego_id = v.ego_id
)
SELECT n.*, coalesce(n.reason, CASE WHEN n.verdict = 'unknown' AND tells_no_cause(n.code) THEN c.because END) AS cause
FROM _verdict_with_rule n LEFT JOIN _cause c ON c.key.drive_id = n.drive_id AND c.key.ego_id = n.ego_id AND c.key.t_ns = n.t_decides_ns
    AND c.key.object_id = coalesce(n.object_id, '') AND c.key.of_hidden = n.of_hidden AND c.key.of_lanes = n.of_lanes
