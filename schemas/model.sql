-- The trace as recorded: what ingest writes and nothing later changes.
-- Frame: right-handed map metres, box centres. Time: integer nanoseconds of the log's own clock. Everything else SI.

-- lifetime: run
CREATE TABLE data_log (
    drive_id VARCHAR NOT NULL,        -- <file stem>-<first 8 hex of the content's sha256>
    file_name VARCHAR NOT NULL,       -- name of the log, without its folder
    sha256 VARCHAR NOT NULL,          -- hash of the log's bytes
    format VARCHAR NOT NULL,          -- reader that read it: osi-mcap, canonical-parquet, or the mapping's name
    environment_id VARCHAR,           -- the map this drive is judged on; NULL: no map
    t_start_ns BIGINT,                -- first time stamp of any actor
    t_end_ns BIGINT,                  -- last time stamp of any actor
    utc_start_ns BIGINT,              -- UTC of t_start_ns where the log says it, else NULL
    n_states BIGINT NOT NULL,         -- rows of actor_state
    sensor_range_m DOUBLE,            -- range within which the recorder sees every actor; NULL: ground truth, unlimited
    map_offset_x_m DOUBLE,            -- added to the map's x to bring it to where the log is, as the mapping or the log says; NULL: nothing said
    map_offset_y_m DOUBLE,            -- the same for y
    has_indicator BOOLEAN NOT NULL,   -- the ego's indicator is known in at least one state
    names_indicator BOOLEAN,          -- its mapping names a column of the indicators; NULL: it has no mapping
    has_brake_light BOOLEAN NOT NULL, -- the ego's brake light is known in at least one state
    has_acceleration BOOLEAN NOT NULL, -- acceleration was recorded, not derived
    geo_reference VARCHAR,            -- projection by which the drive is put on the earth: the map's, else the log's; NULL: neither has one that gives positions on the earth (in data_log.parquet of a converted log: as the log says it, usable or not)
    geo_x_m DOUBLE,                   -- the drive's coordinates are turned by geo_yaw_rad and then moved by this to be those of geo_reference; NULL: as there
    geo_y_m DOUBLE,                   -- the same for y
    geo_yaw_rad DOUBLE,               -- turn about the z axis, counter-clockwise
    lon DOUBLE,                       -- longitude in degrees (WGS 84) of the first known position of the ego, of several of that whose id is first; NULL: not known, or no geo_reference
    lat DOUBLE,                       -- latitude in degrees (WGS 84) of the same; NULL: as lon
    in_sight BOOLEAN NOT NULL         -- whoever is not recorded for a while is taken not to be in plain view of the recorder (check --visibility)
);

-- lifetime: drive
CREATE TABLE actor (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the log's own id of the actor, as text
    actor_class VARCHAR,              -- [actor_class] NULL: unknown
    length_m DOUBLE,                  -- box length; NULL: unknown
    width_m DOUBLE,                   -- box width; NULL: unknown
    height_m DOUBLE,                  -- box height; NULL: unknown
    is_ego BOOLEAN NOT NULL           -- selected as ego for this run
);

-- lifetime: drive
CREATE TABLE actor_state (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor
    t_ns BIGINT NOT NULL,             -- time stamp
    x_m DOUBLE,                       -- box centre, east; NULL: present but not placed
    y_m DOUBLE,                       -- box centre, north
    z_m DOUBLE,                       -- box centre, up
    yaw_rad DOUBLE,                   -- heading, counter-clockwise from east
    vx_mps DOUBLE,                    -- velocity east (world frame)
    vy_mps DOUBLE,                    -- velocity north (world frame)
    ax_mps2 DOUBLE,                   -- acceleration east as recorded; NULL: not recorded
    ay_mps2 DOUBLE,                   -- acceleration north as recorded; NULL: not recorded
    indicator VARCHAR,                -- [indicator] NULL: not known
    brake_light VARCHAR               -- [brake_light] NULL: not known
);

-- lifetime: drive
CREATE TABLE signal_state (
    drive_id VARCHAR NOT NULL,        -- the drive
    signal_id VARCHAR NOT NULL,       -- traffic signal, by the map's or the log's id
    t_ns BIGINT NOT NULL,             -- time stamp
    state VARCHAR                     -- [light_state] NULL: not known
);

-- lifetime: drive
CREATE TABLE declared_event (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- who declared it
    t_ns BIGINT NOT NULL,             -- when
    event VARCHAR NOT NULL,           -- [event] recorded headlights are the event headlights
    value VARCHAR                     -- its value as text, if any
);

-- lifetime: run
CREATE TABLE drive_condition (
    drive_id VARCHAR NOT NULL,        -- the drive
    condition VARCHAR NOT NULL,       -- [condition]
    value VARCHAR NOT NULL,           -- one of the words of its column in ego_condition
    source VARCHAR NOT NULL           -- [condition_source]
);

-- lifetime: part
CREATE TABLE deferred_ego (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL           -- an ego that is judged in another part of the run: nothing is derived for it now
);

-- lifetime: run
CREATE TABLE quality (
    drive_id VARCHAR NOT NULL,        -- the drive
    check_id VARCHAR NOT NULL,        -- [log_check] which check
    severity VARCHAR NOT NULL,        -- [check_severity]
    actor_id VARCHAR,                 -- the actor concerned; NULL: the whole drive
    n BIGINT NOT NULL,                -- how many samples
    t_first_ns BIGINT,                -- the first of them; of lost_time: the last time before it, NULL: it begins with the log
    t_last_ns BIGINT,                 -- of lost_time: the first time behind it, NULL: it ends with the log; NULL for all other checks
    message VARCHAR NOT NULL          -- what was seen and what follows from it, in one sentence
);

-- What of an actor is not believed, and when: a step at which a rule uses it is unknown.
-- lifetime: drive
CREATE TABLE doubt (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor of whom the log is doubted
    quantity VARCHAR NOT NULL,        -- [quantity] what of it
    t_from_ns BIGINT NOT NULL,        -- from here
    t_to_ns BIGINT NOT NULL,          -- to here, this time included
    code VARCHAR NOT NULL             -- [log_check] the check that doubts it
);
