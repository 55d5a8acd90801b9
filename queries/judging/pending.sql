-- What rules have judged and is not yet made into outcomes, of all of them; '' stands for no object, profile or label. `who`: the object that a
-- step is about, of objects that are combined the one that decides it.
CREATE OR REPLACE TEMP TABLE _judged AS
SELECT NULL::INTEGER AS rule_no, drive_id, ego_id, NULL::VARCHAR AS object_id, NULL::VARCHAR AS profile, NULL::VARCHAR AS label,
    NULL::INTEGER AS ref_id, t_ns, k, seg, NULL::BOOLEAN AS applies, NULL::BOOLEAN AS holds, NULL::DOUBLE AS gain,
    NULL::DOUBLE AS observed, NULL::DOUBLE AS required, NULL::VARCHAR AS code, NULL::VARCHAR AS reason, NULL::VARCHAR AS who,
    NULL::BIGINT AS n, NULL::BIGINT AS n_same
FROM step WHERE false;
-- Each reference point with its window, and whether the rule applies there. `crowd`: the condition is about objects, and the reference point
-- is not. `at_point`: it is judged at its own time.
CREATE OR REPLACE TEMP TABLE _occasion (rule_no INTEGER, ref_id INTEGER, ref_no INTEGER, drive_id VARCHAR, ego_id VARCHAR, object_id VARCHAR,
    t_ref_ns BIGINT, a_ns BIGINT, b_ns BIGINT, applies BOOLEAN, doubt VARCHAR, crowd BOOLEAN, at_point BOOLEAN);
-- The steps of windows, and the anchors.
CREATE OR REPLACE TEMP TABLE _window_step (rule_no INTEGER, ref_id INTEGER, ref_no INTEGER, drive_id VARCHAR, ego_id VARCHAR,
    object_id VARCHAR, t_ns BIGINT, seg INTEGER);
-- The steps at which each reference point is judged; t_ns is NULL for an anchor that is not known.
CREATE OR REPLACE TEMP VIEW _reference_step AS
FROM _window_step
UNION ALL
SELECT o.rule_no, o.ref_id, o.ref_no, o.drive_id, o.ego_id, o.object_id, o.t_ref_ns, s.seg
FROM _occasion o
LEFT JOIN step s ON s.drive_id = o.drive_id AND s.ego_id = o.ego_id AND s.t_ns = o.t_ref_ns
WHERE o.at_point AND o.applies AND o.t_ref_ns IS NOT NULL;
CREATE OR REPLACE TEMP TABLE _profile_set (rule_no INTEGER, drive_id VARCHAR, ego_id VARCHAR, profile VARCHAR);
