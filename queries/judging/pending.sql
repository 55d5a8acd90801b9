-- What rules have judged and is not yet made into outcomes, of all of them; '' stands for no object, profile or label. `who`: the object that a
-- step is about, of objects that are combined the one that decides it.
CREATE OR REPLACE TEMP TABLE _judged AS
SELECT NULL::INTEGER AS rule_no, drive_id, ego_id, NULL::VARCHAR AS object_id, NULL::VARCHAR AS profile, NULL::VARCHAR AS label,
    NULL::INTEGER AS ref_id, t_ns, k, seg, NULL::BOOLEAN AS applies, NULL::BOOLEAN AS holds, NULL::DOUBLE AS gain,
    NULL::DOUBLE AS observed, NULL::DOUBLE AS required, NULL::VARCHAR AS code, NULL::VARCHAR AS reason, NULL::VARCHAR AS who,
    NULL::BIGINT AS n, NULL::BIGINT AS n_same
FROM step WHERE false;
-- Each reference point with its window, and whether the rule applies there. `crowd`: the condition is about objects, and the reference point
-- is not.
CREATE OR REPLACE TEMP TABLE _occasion (rule_no INTEGER, ref_id INTEGER, ref_no INTEGER, drive_id VARCHAR, ego_id VARCHAR, object_id VARCHAR,
    t_ref_ns BIGINT, a_ns BIGINT, b_ns BIGINT, applies BOOLEAN, doubt VARCHAR, crowd BOOLEAN);
CREATE OR REPLACE TEMP TABLE _reference_step (rule_no INTEGER, ref_id INTEGER, ref_no INTEGER, drive_id VARCHAR, ego_id VARCHAR,
    object_id VARCHAR, t_ns BIGINT, seg INTEGER);
CREATE OR REPLACE TEMP TABLE _profile_set (rule_no INTEGER, drive_id VARCHAR, ego_id VARCHAR, profile VARCHAR);
