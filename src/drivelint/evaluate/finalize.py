"""Writes the results of all rules: a verdict for every ego, each row with number, position, sentence and id."""

from __future__ import annotations

from drivelint.evaluate import causes, coverage_gaps, findings
from drivelint.reasons.sentences import HAS_MEASURE_SQL, SENTENCE_SQL

# clean groups of the first pass are outcomes too; a subject for which a rule erred has no other row of that rule
_ALL = f"""
CREATE OR REPLACE TEMP TABLE _closed AS
WITH _rows AS (
    SELECT * FROM _outcome UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, '' AS profile, object_id, t_start_ns, t_end_ns, t_worst_ns,
        t_worst_ns AS t_decides_ns,
        'pass' AS verdict, code, reason, observed, required, margin, n AS n_expected, n AS n_judged
    FROM _group WHERE clean
), _kept AS (
    SELECT r.* FROM _rows r ANTI JOIN _error e ON e.rule_no = r.rule_no AND e.drive_id = r.drive_id
        AND e.ego_id = r.ego_id
    UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, 'error' AS verdict, min(code) AS code, min(reason) AS reason
        FROM _error GROUP BY ALL
    UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, 'unknown' AS verdict, 'missing_' || signal AS code, reason FROM _gated
    UNION ALL BY NAME
    SELECT rule_no, drive_id, ego_id, 'not_applicable' AS verdict, 'other_nation' AS code FROM _foreign
), _seen AS (
    SELECT * FROM _kept UNION ALL BY NAME
    ({coverage_gaps.GAP_OUTCOMES})
)
SELECT * FROM _seen UNION ALL BY NAME
SELECT r.rule_no, s.drive_id, s.ego_id, 'not_applicable' AS verdict,
    CASE WHEN w.never THEN 'not_engaged' ELSE 'not_triggered' END AS code
    FROM _rule r CROSS JOIN _subject s LEFT JOIN _watched w ON w.drive_id = s.drive_id AND w.ego_id = s.ego_id
ANTI JOIN _seen k ON k.rule_no = r.rule_no AND k.drive_id = s.drive_id AND k.ego_id = s.ego_id
"""

_PLACE = "LEFT JOIN ego_state p ON p.drive_id = v.drive_id AND p.ego_id = v.ego_id AND p.t_ns = v.t_worst_ns"

# the first time at which the log loses somebody, and the last at which somebody comes into it
_SIGHT = """
SELECT drive_id, ego_id, min(t_ns) FILTER (lost) AS gone_ns, max(t_ns) FILTER (NOT lost) AS to_come_ns
FROM track_end GROUP BY ALL
"""

_NAMED = f"""
CREATE OR REPLACE TEMP TABLE _named AS
WITH _closed_rule AS (
    SELECT v.* REPLACE (nullif(v.profile, '') AS profile, nullif(v.object_id, '') AS object_id,
        nullif(v.label, '') AS label), r.* EXCLUDE (rule_no), coalesce(s.start_ns, 0) AS start_ns,
        s.t_start_ns AS ego_from_ns, s.t_end_ns AS ego_to_ns
    FROM _closed v JOIN _rule r USING (rule_no) LEFT JOIN _subject s ON s.drive_id = v.drive_id AND s.ego_id = v.ego_id),
_cause AS ({causes.SELECT_CAUSES})
SELECT n.*, coalesce(n.reason, c.because) AS cause
FROM _closed_rule n LEFT JOIN _cause c ON c.key.drive_id = n.drive_id AND c.key.ego_id = n.ego_id AND c.key.t_ns = n.t_decides_ns
    AND c.key.object_id = coalesce(n.object_id, '') AND c.key.of_hidden = n.of_hidden AND c.key.of_lanes = n.of_lanes
    AND n.verdict = 'unknown' AND n.reason IS NULL AND n.code IN {causes.CODES_WITHOUT_CAUSE}
"""

_FAILED = """
CREATE OR REPLACE TEMP TABLE _failed AS
SELECT f.* REPLACE (nullif(f.profile, '') AS profile, nullif(f.object_id, '') AS object_id), r.* EXCLUDE (rule_no),
    f.t_worst_ns AS t_decides_ns, 'fail' AS verdict, s.start_ns, s.sha256, s.t_start_ns AS ego_from_ns, s.t_end_ns AS ego_to_ns,
    NULL::DOUBLE AS bound, NULL::DOUBLE AS asked, f.reason AS cause
FROM _stretch f JOIN _rule r USING (rule_no) JOIN _subject s ON s.drive_id = f.drive_id AND s.ego_id = f.ego_id
ANTI JOIN _error e ON e.rule_no = f.rule_no AND e.drive_id = f.drive_id AND e.ego_id = f.ego_id
"""

_VERDICTS = f"""
INSERT INTO verdict BY NAME
WITH _sight AS ({_SIGHT}),
_numbered AS (
    SELECT n.*, w.cause_code, w.cause_args, row_number() OVER (PARTITION BY drive_id, ego_id, rule_id, profile, object_id
        ORDER BY coalesce(t_ref_ns, t_start_ns) NULLS LAST, t_start_ns NULLS LAST, t_end_ns NULLS LAST,
            ref_id NULLS LAST, code) - 1 AS occurrence,
        {SENTENCE_SQL}, {HAS_MEASURE_SQL} AS reason_measures
    FROM _named n LEFT JOIN _worded w USING (rule_no, cause, start_ns))
SELECT v.drive_id, v.ego_id, rule_id, rule_version, kind, profile, severity, object_id,
    occurrence::INTEGER AS occurrence, ref_id, t_ref_ns, t_start_ns, t_end_ns,
    t_worst_ns, verdict, code AS reason_code, sentence AS reason, cause_code, cause_args, reason_measures, observed, required, margin, unit,
    coalesce(verdict = 'pass' AND {findings.IS_NEAR_MISS}, false) AS near_miss,
    coalesce(n_expected, 0) AS n_expected, coalesce(n_judged, 0) AS n_judged, p.x_m, p.y_m, p.lanelet_id,
    CASE WHEN of_others AND verdict IN ('pass', 'fail', 'not_applicable') AND code <> 'other_nation'
        AND (coalesce(g.gone_ns <= t_end_ns, g.gone_ns IS NOT NULL) OR coalesce(g.to_come_ns >= t_start_ns, g.to_come_ns IS NOT NULL))
        THEN 'line_of_sight' END AS assumes
FROM _numbered v {_PLACE}
LEFT JOIN _sight g ON g.drive_id = v.drive_id AND g.ego_id = v.ego_id
"""

_FINDINGS = f"""
INSERT INTO finding BY NAME
WITH _numbered AS (
    SELECT n.*, w.cause_code, w.cause_args, (row_number() OVER (PARTITION BY drive_id, ego_id, rule_id, profile, object_id
        ORDER BY t_start_ns, t_end_ns, ref_id NULLS LAST) - 1)::INTEGER AS occurrence,
        {SENTENCE_SQL}, {HAS_MEASURE_SQL} AS reason_measures
    FROM (SELECT *, NULL::VARCHAR AS label FROM _failed) n
    LEFT JOIN _worded w USING (rule_no, cause, start_ns))
SELECT sha256(to_json([v.sha256, v.ego_id, rule_id, profile, object_id,
    v.occurrence::VARCHAR])::VARCHAR)[:16] AS finding_id,
    v.drive_id, v.ego_id, rule_id, rule_version, kind, profile, severity, object_id, v.occurrence, ref_id,
    v.t_start_ns, v.t_end_ns, t_worst_ns, sentence AS reason, cause_code, cause_args, reason_measures, observed, required, margin, unit,
    p.x_m, p.y_m, p.lanelet_id
FROM _numbered v {_PLACE}
"""

_MARGINS = """
INSERT INTO margin BY NAME
SELECT m.* EXCLUDE (rule_no) REPLACE (nullif(m.profile, '') AS profile, nullif(m.object_id, '') AS object_id),
    r.rule_id FROM _margin m JOIN _rule r USING (rule_no)
ANTI JOIN _error e ON e.rule_no = m.rule_no AND e.drive_id = m.drive_id AND e.ego_id = m.ego_id
"""

INSERT_MEASURE_SERIES = """
INSERT INTO course BY NAME
WITH _named AS (SELECT c.* REPLACE (nullif(c.profile, '') AS profile, nullif(c.object_id, '') AS object_id), r.rule_id
    FROM _course c JOIN _rule r USING (rule_no)), _whose AS (
    SELECT finding_id, drive_id, ego_id, rule_id, profile, object_id, occurrence, ref_id, t_start_ns, false AS near FROM finding
    UNION ALL
    SELECT NULL, drive_id, ego_id, rule_id, profile, object_id, occurrence, ref_id, t_start_ns, true
    FROM verdict WHERE near_miss)
SELECT f.finding_id, f.drive_id, f.ego_id, f.rule_id, f.profile, f.object_id, f.occurrence,
    list(c.t_ns ORDER BY c.t_ns) AS t_ns, list(c.observed ORDER BY c.t_ns) AS observed,
    list(c.required ORDER BY c.t_ns) AS required, list(c.margin ORDER BY c.t_ns) AS margin, list(c.holds ORDER BY c.t_ns) AS holds
FROM _named c
JOIN _whose f ON f.near = c.near AND f.drive_id = c.drive_id AND f.ego_id = c.ego_id AND f.rule_id = c.rule_id
    AND f.profile IS NOT DISTINCT FROM c.profile
    AND f.object_id IS NOT DISTINCT FROM c.object_id AND f.ref_id IS NOT DISTINCT FROM c.ref_id AND f.t_start_ns = c.t_start_ns
GROUP BY f.finding_id, f.drive_id, f.ego_id, f.rule_id, f.profile, f.object_id, f.occurrence
"""
"""Run after these, if the courses of findings and near misses are asked for."""

COLLECT_STATEMENTS = (coverage_gaps.CREATE_GAPS, _ALL, _NAMED, _FAILED)
"""Run in this order after the last rule."""
SELECT_REASONS = "SELECT rule_no, cause, start_ns FROM _named UNION ALL SELECT rule_no, cause, start_ns FROM _failed"
"""The causes that `make_reason_table` puts into words between the two lists of statements."""
INSERT_STATEMENTS = (_VERDICTS, _FINDINGS, _MARGINS)
"""Run in this order after `make_reason_table`."""
