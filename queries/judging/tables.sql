-- What the statements of all rules read and fill. Python fills _rule, _needs and _allowed.
CREATE OR REPLACE TEMP TABLE _subject AS
    SELECT c.drive_id, c.ego_id, c.period_ns, c.max_gap_ns, c.t_start_ns, c.t_end_ns, l.sha256, l.sensor_range_m,
        coalesce(l.t_start_ns, 0) AS start_ns
    FROM clock c LEFT JOIN data_log l ON c.drive_id = l.drive_id;
-- `is_lost`: the steps lie within a lost stretch of the log, so an actor without a state at them may have been there.
CREATE OR REPLACE TEMP TABLE _segment AS
    SELECT s.drive_id, s.ego_id, s.seg, min(s.t_ns) AS t_first_ns, max(s.t_ns) AS t_last_ns, min(s.k) AS k_first,
        coalesce(bool_or(l.t_to_ns > s.t_ns), false) AS is_lost
    FROM step s ASOF LEFT JOIN lost_time l ON l.drive_id = s.drive_id AND l.t_from_ns < s.t_ns GROUP BY ALL;
CREATE OR REPLACE TEMP TABLE _rule (rule_no INTEGER, rule_id VARCHAR, rule_version VARCHAR, kind VARCHAR, severity VARCHAR,
    subtype VARCHAR, eventually BOOLEAN, merge_ns BIGINT, sense VARCHAR, unit VARCHAR, observes VARCHAR, near_margin DOUBLE, without_time VARCHAR, without_anchor VARCHAR,
    of_others BOOLEAN, of_hidden BOOLEAN, of_lanes BOOLEAN, of_contact BOOLEAN, of_standing BOOLEAN, by_object BOOLEAN, own_grid BOOLEAN, limit_min_mps DOUBLE, limit_max_mps DOUBLE);
CREATE OR REPLACE TEMP TABLE _needs (rule_no INTEGER, pos INTEGER, signal VARCHAR, is_assumed BOOLEAN, may_be_unrecorded BOOLEAN);
CREATE OR REPLACE TEMP TABLE _allowed (rule_no INTEGER, code VARCHAR, condition VARCHAR, word VARCHAR);
CREATE OR REPLACE TEMP TABLE _error (rule_no INTEGER, drive_id VARCHAR, ego_id VARCHAR, code VARCHAR, reason VARCHAR);
CREATE OR REPLACE TEMP TABLE _group (rule_no INTEGER, drive_id VARCHAR, ego_id VARCHAR, object_id VARCHAR, clean BOOLEAN,
    t_start_ns BIGINT, t_end_ns BIGINT, n BIGINT,
    t_worst_ns BIGINT, observed DOUBLE, required DOUBLE, margin DOUBLE, code VARCHAR, reason VARCHAR);
CREATE OR REPLACE TEMP TABLE _outcome (rule_no INTEGER, drive_id VARCHAR, ego_id VARCHAR, profile VARCHAR, object_id VARCHAR,
    label VARCHAR, ref_id INTEGER, t_ref_ns BIGINT,
    t_start_ns BIGINT, t_end_ns BIGINT, t_worst_ns BIGINT, t_decides_ns BIGINT, verdict VARCHAR, code VARCHAR, reason VARCHAR,
    observed DOUBLE, required DOUBLE, margin DOUBLE, bound DOUBLE, asked DOUBLE, n_expected BIGINT, n_judged BIGINT);
CREATE OR REPLACE TEMP TABLE _stretch (rule_no INTEGER, drive_id VARCHAR, ego_id VARCHAR, profile VARCHAR, object_id VARCHAR,
    ref_id INTEGER, t_start_ns BIGINT, t_end_ns BIGINT, t_worst_ns BIGINT, code VARCHAR, reason VARCHAR,
    observed DOUBLE, required DOUBLE, margin DOUBLE,
    judged_object_id VARCHAR, failing STRUCT(label VARCHAR, t_first_ns BIGINT, t_last_ns BIGINT)[]);
CREATE OR REPLACE TEMP TABLE _margin (rule_no INTEGER, drive_id VARCHAR, ego_id VARCHAR, profile VARCHAR, object_id VARCHAR,
    ref_id INTEGER, t_ns BIGINT, observed DOUBLE, required DOUBLE, margin DOUBLE, holds BOOLEAN);
CREATE OR REPLACE TEMP TABLE _course (rule_no INTEGER, drive_id VARCHAR, ego_id VARCHAR, profile VARCHAR, object_id VARCHAR,
    ref_id INTEGER, t_start_ns BIGINT, near BOOLEAN, t_ns BIGINT, observed DOUBLE, required DOUBLE, margin DOUBLE, holds BOOLEAN);
-- The default grids of invariants: every ego step, or every ego step with each object that is present at it.
CREATE OR REPLACE TEMP VIEW _step_grid AS
    SELECT drive_id, ego_id, t_ns, NULL::VARCHAR AS object_id, k, seg FROM step;
CREATE OR REPLACE TEMP VIEW _pair_grid AS
    SELECT a.drive_id, a.ego_id, a.t_ns, a.object_id, b.k, b.seg
    FROM pair a JOIN step b ON a.drive_id = b.drive_id AND a.ego_id = b.ego_id AND a.t_ns = b.t_ns;
