-- The results of the evaluation: verdicts, findings and margins.

-- lifetime: run
CREATE TABLE verdict (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego; '' if the drive has none
    rule_id VARCHAR NOT NULL,         -- pack and file name of the rule
    rule_version VARCHAR NOT NULL,    -- hash of the rule's file
    kind VARCHAR NOT NULL,            -- [rule_kind]
    profile VARCHAR,                  -- the profile of the verdict; NULL: the rule has none
    severity VARCHAR NOT NULL,        -- [rule_severity]
    object_id VARCHAR,                -- the other actor; NULL: none
    occurrence INTEGER NOT NULL,      -- number of the verdict, from 0 per drive, ego, rule, profile and object, in time order; independent of finding.occurrence, see finding_ids
    ref_id INTEGER,                   -- number of the assertion reference point, from 0 per drive, ego and rule; NULL: invariant
    t_ref_ns BIGINT,                  -- time of the assertion reference point; NULL: invariant
    t_start_ns BIGINT,                -- start of the judged interval
    t_end_ns BIGINT,                  -- end of the judged interval
    t_worst_ns BIGINT,                -- earliest step with the least margin
    verdict VARCHAR NOT NULL,         -- [verdict]
    reason_code VARCHAR NOT NULL,     -- machine-readable reason
    reason VARCHAR NOT NULL,          -- reason_code as a sentence
    cause_code VARCHAR,               -- the cause as a code: from the rule, or for missing data; text: in the rule's own words; NULL: reason_code is enough
    cause_args VARCHAR,               -- the arguments of cause_code, as a JSON object whose names contain units: t_ns is a time, object_id an actor; NULL: none
    reason_measures BOOLEAN NOT NULL, -- the reason states the values observed and required
    observed DOUBLE,                  -- measured value at the worst step
    required DOUBLE,                  -- the value with which observed was compared
    margin DOUBLE,                    -- signed distance to the threshold, positive if the rule is kept; NULL for sense = holds
    unit VARCHAR,                     -- unit of observed, required and margin
    near_miss BOOLEAN NOT NULL,       -- passed, with a margin below near_margin
    n_expected BIGINT NOT NULL,       -- number of steps that had to be judged
    n_judged BIGINT NOT NULL,         -- number of steps that were judged
    x_m DOUBLE,                       -- x of the ego at the worst step
    y_m DOUBLE,                       -- y of the ego at the worst step
    lanelet_id VARCHAR,               -- lanelet of the ego at the worst step
    assumes VARCHAR,                  -- the assumption on which the verdict depends; line_of_sight: an actor was lost, or appeared later, by the end of the judged interval; while not recorded, it is assumed not to be in plain view (check --visibility); NULL: none
    t_start_s DOUBLE,                 -- t_start_ns in seconds since the drive's first time stamp, the time that reasons state
    t_worst_s DOUBLE,                 -- t_worst_ns in seconds since the drive's first time stamp
    finding_ids VARCHAR[] NOT NULL    -- its findings, in time order: each contains a failing step of this verdict; a finding may belong to several verdicts; empty: it did not fail, or failed without a failing step
);

-- lifetime: run
CREATE TABLE finding (
    finding_id VARCHAR NOT NULL,      -- hash of the drive's content, ego, rule, profile, object and occurrence
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    rule_id VARCHAR NOT NULL,         -- the rule
    rule_version VARCHAR NOT NULL,    -- hash of the rule's file
    kind VARCHAR NOT NULL,            -- [rule_kind]
    profile VARCHAR,                  -- the profile of the finding; NULL: the rule has none
    severity VARCHAR NOT NULL,        -- [rule_severity]
    object_id VARCHAR,                -- the other actor; NULL: none
    occurrence INTEGER NOT NULL,      -- number of the finding, from 0 per drive, ego, rule, profile and object, in time order; independent of verdict.occurrence, see finding_ids of verdict
    ref_id INTEGER,                   -- number of the assertion reference point; NULL: invariant
    t_start_ns BIGINT NOT NULL,       -- first failing step
    t_end_ns BIGINT NOT NULL,         -- last failing step
    t_worst_ns BIGINT NOT NULL,       -- earliest step with the least margin
    reason VARCHAR NOT NULL,          -- the reason as a sentence
    cause_code VARCHAR,               -- the cause from the rule, as a code; text: in the rule's own words; NULL: none
    cause_args VARCHAR,               -- the arguments of cause_code, as a JSON object
    reason_measures BOOLEAN NOT NULL, -- the reason states the values observed and required
    observed DOUBLE,                  -- measured value at the worst step
    required DOUBLE,                  -- the value with which observed was compared
    margin DOUBLE,                    -- signed distance to the threshold: negative; NULL for sense = holds
    unit VARCHAR,                     -- unit of observed, required and margin
    x_m DOUBLE,                       -- x of the ego at the worst step
    y_m DOUBLE,                       -- y of the ego at the worst step
    lon DOUBLE,                       -- longitude of x_m, y_m in degrees (WGS 84); NULL: neither map nor log has a geo reference with positions on the earth
    lat DOUBLE,                       -- latitude of x_m, y_m in degrees (WGS 84); NULL: as lon
    lanelet_id VARCHAR,               -- lanelet of the ego at the worst step
    n_copies INTEGER,                 -- number of copies that were judged: this part of the drive with random errors. Their standard deviations are 0.1 m in each actor's position, 0.05 s in its clock and 0.1 m in the map's position (normal distribution). It is 100, or fewer if these decide; NULL: none, because the finding is minor or not the gravest of its rule (check --robustness judges all), check --no-robustness was given, this part alone does not give the finding, or the run was interrupted
    n_stays INTEGER,                  -- number of these copies that have the finding too; NULL: as n_copies
    t_start_s DOUBLE NOT NULL,        -- t_start_ns in seconds since the drive's first time stamp, the time that reasons state
    t_worst_s DOUBLE NOT NULL,        -- t_worst_ns in seconds since the drive's first time stamp
    t_end_s DOUBLE NOT NULL,          -- t_end_ns in seconds since the drive's first time stamp
    closing_mps DOUBLE                -- closing speed of ego and object: their relative velocity along the line between their box centres. For a rule tagged contact: at the last step before the first failing one at which both velocities are known, at most 1 s before it. For another rule: at the worst step or, if they touch there, at the last step before the touch. Negative: they move apart; NULL: no object, no such step, or a position or velocity is not known
);

-- lifetime: drive
CREATE TABLE margin (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    rule_id VARCHAR NOT NULL,         -- the rule
    profile VARCHAR,                  -- the profile of the judged step; NULL: the rule has none
    object_id VARCHAR,                -- the other actor; NULL: none
    ref_id INTEGER,                   -- number of the assertion reference point; NULL: invariant
    t_ns BIGINT NOT NULL,             -- the judged step
    observed DOUBLE,                  -- measured value at that step
    required DOUBLE,                  -- the value with which observed was compared
    margin DOUBLE,                    -- signed distance to the threshold, positive if the rule is kept; NULL for sense = holds
    holds BOOLEAN,                    -- the rule is kept at this step; NULL: unknown
    unit VARCHAR,                     -- unit of observed, required and margin
    t_s DOUBLE NOT NULL,              -- t_ns in seconds since the drive's first time stamp, the time that reasons state
    finding_id VARCHAR                -- the finding to which this failing step belongs; NULL: none
);
