-- The files beside verdicts.parquet and findings.parquet: drives.parquet and rules.parquet.

-- lifetime: run
CREATE TABLE drive (
    drive_id VARCHAR NOT NULL,        -- the drive; for a file that could not be read, its name without extension
    file_name VARCHAR NOT NULL,       -- name of the log file, without its folder
    sha256 VARCHAR,                   -- SHA-256 of the log's bytes; NULL: could not be read
    format VARCHAR,                   -- the reader that read the log; NULL: none could
    environment_id VARCHAR,           -- the map on which the drive was judged; NULL: no map
    map_name VARCHAR,                 -- file name of that map; NULL: no map
    map_sha256 VARCHAR,               -- SHA-256 of that map's bytes; NULL: no map
    handedness VARCHAR,               -- [handedness] NULL: no map
    handedness_source VARCHAR,        -- [handedness_source] NULL: no map
    utc_start_ns BIGINT,              -- UTC time of the first time stamp; NULL: the log does not state it
    t_start_ns BIGINT,                -- first time stamp of any actor, on the log's own clock
    duration_s DOUBLE,                -- from the first to the last time stamp; NULL: no states
    lon DOUBLE,                       -- longitude in degrees (WGS 84) of the first position of the ego (of several egos, the one whose id comes first); NULL: not known, or neither map nor log has a geo reference with positions on the earth
    lat DOUBLE,                       -- latitude in degrees (WGS 84) of the same position; NULL: as lon
    km DOUBLE NOT NULL,               -- distance driven in kilometres, all egos together
    n_states BIGINT NOT NULL,         -- number of actor states that were read
    n_steps BIGINT NOT NULL,          -- number of ego steps, all egos together
    n_egos BIGINT NOT NULL,           -- number of egos that were judged
    status VARCHAR NOT NULL,          -- judged, not_judged
    status_reason VARCHAR,            -- why the drive was not judged; NULL: it was judged
    lossy BOOLEAN NOT NULL,           -- parts of the log were lost or salvaged: the verdicts cover only the readable part
    conditions STRUCT("condition" VARCHAR, "value" VARCHAR, source VARCHAR)[] NOT NULL, -- conditions of the drive, such as weather or nation, each with its source: the user (env), the log (trace) or its map (map)
    exposure STRUCT(ego_id VARCHAR, km DOUBLE, hours DOUBLE, engaged_km DOUBLE, engaged_hours DOUBLE, n_steps BIGINT)[] NOT NULL, -- per ego: distance, time without holes, both also for the automated driver only, and number of steps
    occasions STRUCT(rule_id VARCHAR, profile VARCHAR, n BIGINT, n_judged BIGINT)[] NOT NULL, -- per rule and profile: n, how often the rule applied or may have applied (verdict rows except not_applicable), and n_judged, how many of these passed or failed
    quality STRUCT(check_id VARCHAR, severity VARCHAR, actor_id VARCHAR, n BIGINT, t_first_ns BIGINT, message VARCHAR)[] NOT NULL, -- data-quality findings of the log and its map
    not_judged STRUCT(ego_id VARCHAR, signal VARCHAR, reason_code VARCHAR, reason VARCHAR)[] NOT NULL, -- signals that the log and the map lack: rules that require them are unknown
    recorded STRUCT(actor_id VARCHAR, t_from_ns BIGINT, t_to_ns BIGINT)[] NOT NULL -- per actor of the log, in time order: the stretches in which its position is known, without a hole or lost time; other times were not examined
);

-- lifetime: run
CREATE TABLE rule (
    rule_id VARCHAR NOT NULL,         -- pack and file name of the rule
    rule_version VARCHAR NOT NULL,    -- hash of the rule's file
    pack VARCHAR NOT NULL,            -- name of the rule's pack: ukhc, rss, comfort, ...
    pack_title VARCHAR NOT NULL,      -- the subject of the pack; empty: not stated
    title VARCHAR NOT NULL,           -- what the rule demands, in a few words
    breach VARCHAR,                   -- what happened if the rule is broken, in a few words; NULL: its findings are called "Not kept" and the title
    clause VARCHAR NOT NULL,          -- the clause from which the rule comes
    hypothesis VARCHAR NOT NULL,      -- the title as a question
    kind VARCHAR NOT NULL,            -- [rule_kind]
    subtype VARCHAR,                  -- temporal, physical; NULL: neither pre- nor postcondition
    window_s DOUBLE,                  -- length of the period before or after the reference point, as used; NULL: none
    derivation VARCHAR NOT NULL,      -- how the rule follows from the clause: direct, model
    severity VARCHAR NOT NULL,        -- [rule_severity]
    legal VARCHAR NOT NULL,           -- the obligation in the clause: must, should
    status VARCHAR NOT NULL,          -- draft, stable, deprecated; only findings of stable rules count in the gate
    is_named BOOLEAN NOT NULL,        -- the user named the rule by its id: it is unknown if the log lacks a signal that few logs have. Without a name, it does not apply to that log
    sense VARCHAR NOT NULL,           -- relation that must hold between observed and required
    unit VARCHAR,                     -- unit of observed, required and margin
    observes VARCHAR,                 -- name of observed, as a noun phrase; NULL: nothing is measured, or the title names it
    near_margin DOUBLE,               -- a pass with a smaller margin is a near miss; NULL: no near misses
    law VARCHAR[] NOT NULL,           -- [nation] the nations whose law the rule is: not applicable if the nation is known to be another; empty: not the law of one nation
    tags VARCHAR[] NOT NULL,          -- [rule_tag] tags by which reports recognise the rule
    requires VARCHAR[] NOT NULL,      -- signals without which the rule is unknown
    profiles VARCHAR[] NOT NULL,      -- profiles against which the rule was judged; empty: it has none
    params STRUCT("name" VARCHAR, "value" VARCHAR, unit VARCHAR, overridden BOOLEAN)[] NOT NULL -- parameters as used, with their values as text
);
