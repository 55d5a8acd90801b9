-- The files beside verdicts.parquet and findings.parquet: drives.parquet and rules.parquet.

-- lifetime: run
CREATE TABLE drive (
    drive_id VARCHAR NOT NULL,        -- the drive; its file's stem where the file could not be read
    file_name VARCHAR NOT NULL,       -- name of the log, without its folder
    sha256 VARCHAR,                   -- hash of the log's bytes; NULL: could not be read
    format VARCHAR,                   -- reader that read it; NULL: none could
    environment_id VARCHAR,           -- the map it was judged on; NULL: no map
    map_name VARCHAR,                 -- file name of that map
    map_sha256 VARCHAR,               -- hash of that map's bytes
    handedness VARCHAR,               -- [handedness] NULL: no map
    handedness_source VARCHAR,        -- [handedness_source] NULL: no map
    utc_start_ns BIGINT,              -- UTC of the first time stamp; NULL: the log does not state it
    t_start_ns BIGINT,                -- first time stamp of any actor, on the log's own clock
    duration_s DOUBLE,                -- from the first to the last time stamp; NULL: no states
    lon DOUBLE,                       -- longitude in degrees (WGS 84) of the first position of the ego (if there are several, of the one whose id comes first); NULL: not known, or neither map nor log has a geo reference with positions on the earth
    lat DOUBLE,                       -- latitude in degrees (WGS 84) of the same; NULL: as lon
    km DOUBLE NOT NULL,               -- distance driven, all egos together
    n_states BIGINT NOT NULL,         -- actor states read
    n_steps BIGINT NOT NULL,          -- ego steps, all egos together
    n_egos BIGINT NOT NULL,           -- egos judged
    status VARCHAR NOT NULL,          -- judged, not_judged
    status_reason VARCHAR,            -- why it was not judged; NULL: it was
    lossy BOOLEAN NOT NULL,           -- parts of the log were lost or salvaged: the verdicts are about the rest
    conditions STRUCT("condition" VARCHAR, "value" VARCHAR, source VARCHAR)[] NOT NULL, -- conditions of the drive: set by the user (env), from the log (trace) or from its map (map): weather, nation, ...
    exposure STRUCT(ego_id VARCHAR, km DOUBLE, hours DOUBLE, engaged_km DOUBLE, engaged_hours DOUBLE, n_steps BIGINT)[] NOT NULL, -- per ego: distance, time without holes, both with the automated driver, and steps
    occasions STRUCT(rule_id VARCHAR, profile VARCHAR, n BIGINT, n_judged BIGINT)[] NOT NULL, -- per rule and profile: how often it applied or may have applied (verdict rows except not_applicable), and how many of these passed or failed
    quality STRUCT(check_id VARCHAR, severity VARCHAR, actor_id VARCHAR, n BIGINT, t_first_ns BIGINT, message VARCHAR)[] NOT NULL, -- data-quality findings of the log and its map
    not_judged STRUCT(ego_id VARCHAR, signal VARCHAR, reason_code VARCHAR, reason VARCHAR)[] NOT NULL, -- signals that the log and map lack: rules that require them are unknown
    recorded STRUCT(actor_id VARCHAR, t_from_ns BIGINT, t_to_ns BIGINT)[] NOT NULL -- per actor of the log, in time order: the stretches in which its place is known, without a hole and without lost time; other times were not examined
);

-- lifetime: run
CREATE TABLE rule (
    rule_id VARCHAR NOT NULL,         -- pack and file name of the rule
    rule_version VARCHAR NOT NULL,    -- hash of the rule's file
    pack VARCHAR NOT NULL,            -- ukhc, rss, comfort, ...
    pack_title VARCHAR NOT NULL,      -- the subject of the pack; empty: not stated
    title VARCHAR NOT NULL,           -- what it demands, in a few words
    breach VARCHAR,                   -- what happened when it is broken, in a few words; NULL: its findings are called "Not kept" and the title
    clause VARCHAR NOT NULL,          -- the clause it comes from
    hypothesis VARCHAR NOT NULL,      -- the same as a question
    kind VARCHAR NOT NULL,            -- [rule_kind]
    subtype VARCHAR,                  -- temporal, physical; NULL: neither pre- nor postcondition
    window_s DOUBLE,                  -- length of the period before or after the reference point as used; NULL: none
    derivation VARCHAR NOT NULL,      -- direct, model
    severity VARCHAR NOT NULL,        -- [rule_severity]
    legal VARCHAR NOT NULL,           -- must, should
    status VARCHAR NOT NULL,          -- draft, stable, deprecated; only stable rules gate
    is_named BOOLEAN NOT NULL,        -- the user named it by its id: it is unknown where a log has none of a signal that few logs have, else it does not apply there
    sense VARCHAR NOT NULL,           -- relation that must hold between observed and required
    unit VARCHAR,                     -- of observed, required and margin
    observes VARCHAR,                 -- the name of observed, as a noun phrase; NULL: nothing is measured, or the title names it
    near_margin DOUBLE,               -- a pass with a smaller margin is a near miss; NULL: none
    law VARCHAR[] NOT NULL,           -- [nation] the nations whose law it is: not applicable if the nation is known to be another; empty: not the law of one nation
    tags VARCHAR[] NOT NULL,          -- [rule_tag] tags by which reports recognise it
    requires VARCHAR[] NOT NULL,      -- signals without which it is unknown
    profiles VARCHAR[] NOT NULL,      -- profiles that it was judged against; empty: it has none
    params STRUCT("name" VARCHAR, "value" VARCHAR, unit VARCHAR, overridden BOOLEAN)[] NOT NULL -- parameters as used, their values as text
);
