-- The results of the evaluation: verdicts, findings and margins.

-- lifetime: run
CREATE TABLE verdict (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego; '' where the drive has none
    rule_id VARCHAR NOT NULL,         -- pack and file name of the rule
    rule_version VARCHAR NOT NULL,    -- hash of the rule's file
    kind VARCHAR NOT NULL,            -- [rule_kind]
    profile VARCHAR,                  -- profile judged against; NULL: the rule has none
    severity VARCHAR NOT NULL,        -- [rule_severity]
    object_id VARCHAR,                -- the other actor; NULL: none
    occurrence INTEGER NOT NULL,      -- counts verdicts, 0.. per drive, ego, rule, profile and object, in time order; not that of findings, see finding_ids
    ref_id INTEGER,                   -- the assertion reference point, 0.. per drive, ego and rule; NULL: invariant
    t_ref_ns BIGINT,                  -- its time; NULL: invariant
    t_start_ns BIGINT,                -- start of the judged interval
    t_end_ns BIGINT,                  -- its end
    t_worst_ns BIGINT,                -- earliest step with the least margin
    verdict VARCHAR NOT NULL,         -- [verdict]
    reason_code VARCHAR NOT NULL,     -- machine-readable reason
    reason VARCHAR NOT NULL,          -- the same for a person
    cause_code VARCHAR,               -- the cause, as a code: from the rule, or for what is missing; text: in words of the rule's own; NULL: reason_code is enough
    cause_args VARCHAR,               -- the arguments of cause_code, as a JSON object named with units: t_ns is a time, object_id an actor
    reason_measures BOOLEAN NOT NULL, -- the reason states observed and required
    observed DOUBLE,                  -- value at the worst step
    required DOUBLE,                  -- the value that observed was compared with
    margin DOUBLE,                    -- signed distance to the threshold, positive = kept; NULL for sense = holds
    unit VARCHAR,                     -- of observed, required and margin
    near_miss BOOLEAN NOT NULL,       -- passed with less than near_margin
    n_expected BIGINT NOT NULL,       -- steps that had to be judged
    n_judged BIGINT NOT NULL,         -- steps that were judged
    x_m DOUBLE,                       -- ego at the worst step
    y_m DOUBLE,                       -- ego at the worst step
    lanelet_id VARCHAR,               -- ego's lanelet at the worst step
    assumes VARCHAR,                  -- the assumption that it depends on; line_of_sight: by the end of the judged interval an actor was lost, or came later, which is assumed not to be in plain view while not recorded (check --visibility); NULL: none
    t_start_s DOUBLE,                 -- t_start_ns in seconds since the drive's first time stamp, as reasons print times
    t_worst_s DOUBLE,                 -- t_worst_ns in the same way
    finding_ids VARCHAR[] NOT NULL    -- its findings, in time order: those with a failing step of it; a finding may belong to several verdicts; empty: it did not fail, or failed without a failing step
);

-- lifetime: run
CREATE TABLE finding (
    finding_id VARCHAR NOT NULL,      -- hash of drive content, ego, rule, profile, object and occurrence
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    rule_id VARCHAR NOT NULL,         -- the rule
    rule_version VARCHAR NOT NULL,    -- hash of the rule's file
    kind VARCHAR NOT NULL,            -- [rule_kind]
    profile VARCHAR,                  -- profile judged against; NULL: the rule has none
    severity VARCHAR NOT NULL,        -- [rule_severity]
    object_id VARCHAR,                -- the other actor; NULL: none
    occurrence INTEGER NOT NULL,      -- counts findings, 0.. per drive, ego, rule, profile and object, in time order; not that of verdicts, see finding_ids there
    ref_id INTEGER,                   -- the assertion reference point; NULL: invariant
    t_start_ns BIGINT NOT NULL,       -- first failing step
    t_end_ns BIGINT NOT NULL,         -- last failing step
    t_worst_ns BIGINT NOT NULL,       -- earliest step with the least margin
    reason VARCHAR NOT NULL,          -- for a person
    cause_code VARCHAR,               -- the cause from the rule, as a code; text: in words of its own; NULL: none
    cause_args VARCHAR,               -- the arguments of cause_code, as a JSON object
    reason_measures BOOLEAN NOT NULL, -- the reason states observed and required
    observed DOUBLE,                  -- value at the worst step
    required DOUBLE,                  -- the value that observed was compared with
    margin DOUBLE,                    -- negative; NULL for sense = holds
    unit VARCHAR,                     -- of observed, required and margin
    x_m DOUBLE,                       -- ego at the worst step
    y_m DOUBLE,                       -- ego at the worst step
    lon DOUBLE,                       -- longitude of x_m, y_m in degrees (WGS 84); NULL: neither map nor log has a geo reference with positions on the earth
    lat DOUBLE,                       -- latitude of x_m, y_m in degrees (WGS 84); NULL: as lon
    lanelet_id VARCHAR,               -- ego's lanelet at the worst step
    n_copies INTEGER,                 -- copies with errors like the recording's that were judged, of the part of the drive around it: 100, fewer if these are enough; the errors are normal, with standard deviations of 0.1 m in the position of each actor, 0.05 s in its clock and 0.1 m in the place of the map; NULL: none were, because the finding is minor, it is not the gravest of its rule (check --robustness judges all), check --no-robustness was given, that part alone does not give the finding, or the run was interrupted while they were judged
    n_stays INTEGER,                  -- number of these copies in which it is a finding too; NULL: as n_copies
    t_start_s DOUBLE NOT NULL,        -- t_start_ns in seconds since the drive's first time stamp, as reasons print times
    t_worst_s DOUBLE NOT NULL,        -- t_worst_ns in the same way
    t_end_s DOUBLE NOT NULL,          -- t_end_ns in the same way
    closing_mps DOUBLE                -- closing speed of ego and object: their relative velocity along the line between their box centres. Of a rule tagged contact: at the last step before the first failing one at which the velocities of both are known, at most 1 s before it. Of another rule: at the worst step, or, where they touch at it, at the last step before they did. Negative: they move apart; NULL: no object, no such step, or the place or velocity of one is not known
);

-- lifetime: drive
CREATE TABLE margin (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    rule_id VARCHAR NOT NULL,         -- the rule
    profile VARCHAR,                  -- profile judged against; NULL: the rule has none
    object_id VARCHAR,                -- the other actor; NULL: none
    ref_id INTEGER,                   -- the assertion reference point; NULL: invariant
    t_ns BIGINT NOT NULL,             -- the judged step
    observed DOUBLE,                  -- value at that step
    required DOUBLE,                  -- the value that observed was compared with
    margin DOUBLE,                    -- signed, positive = kept; NULL for sense = holds
    holds BOOLEAN,                    -- kept at this step; NULL: unknown
    unit VARCHAR,                     -- of observed, required and margin
    t_s DOUBLE NOT NULL,              -- t_ns in seconds since the drive's first time stamp, as reasons print times
    finding_id VARCHAR                -- the finding of which it is a failing step; NULL: it is of none
);
