-- The trace as recorded: the tables that the readers of logs write, and that no later step changes.
-- Positions: box centres, in metres of the map, right-handed. Times: integer nanoseconds of the log's own clock. Other values: SI units.

-- lifetime: run
CREATE TABLE data_log (
    drive_id VARCHAR NOT NULL,        -- file name without extension, a hyphen, and the first 8 hex digits of the content's SHA-256
    file_name VARCHAR NOT NULL,       -- name of the log file, without its folder
    sha256 VARCHAR NOT NULL,          -- SHA-256 of the log's bytes
    format VARCHAR NOT NULL,          -- the reader that read the log: osi-mcap, canonical-parquet, ..., or the name of the mapping
    environment_id VARCHAR,           -- the map on which this drive is judged; NULL: no map
    t_start_ns BIGINT,                -- first time stamp of any actor
    t_end_ns BIGINT,                  -- last time stamp of any actor
    utc_start_ns BIGINT,              -- UTC time of t_start_ns; NULL: the log does not state it
    n_states BIGINT NOT NULL,         -- number of rows in actor_state
    sensor_range_m DOUBLE,            -- range within which the recorder sees every actor; NULL: unlimited (ground truth)
    map_offset_x_m DOUBLE,            -- offset that is added to the map's x coordinates to match the log, as stated by the mapping or the log; NULL: none is stated
    map_offset_y_m DOUBLE,            -- the same for y
    has_indicator BOOLEAN NOT NULL,   -- the ego's indicator is known in at least one state
    names_indicator BOOLEAN,          -- the mapping of the log names a column for the indicators; NULL: the log has no mapping
    has_brake_light BOOLEAN NOT NULL, -- the ego's brake light is known in at least one state
    has_acceleration BOOLEAN NOT NULL, -- acceleration was recorded, not derived
    geo_reference VARCHAR,            -- projection that gives the drive's positions on the earth: from the map, else from the log; in data_log.parquet of a converted log, as the log states it, usable or not; NULL: neither has a usable one
    geo_x_m DOUBLE,                   -- x offset to the coordinates of geo_reference: the drive's coordinates are rotated by geo_yaw_rad, then this is added; NULL: as geo_reference
    geo_y_m DOUBLE,                   -- the same for y
    geo_yaw_rad DOUBLE,               -- rotation about the z axis, counter-clockwise; NULL: as geo_reference
    lon DOUBLE,                       -- longitude in degrees (WGS 84) of the first known position of the ego (of several egos, the one whose id comes first); NULL: not known, or no geo_reference
    lat DOUBLE,                       -- latitude in degrees (WGS 84) of the same position; NULL: as lon
    in_sight BOOLEAN NOT NULL         -- the assumption line_of_sight holds: an actor without samples for a while is assumed not to be in plain view of the recorder (check --visibility)
);

-- lifetime: drive
CREATE TABLE actor (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the log's own id of the actor, as text
    actor_class VARCHAR,              -- [actor_class] NULL: unknown
    length_m DOUBLE,                  -- box length; NULL: unknown
    width_m DOUBLE,                   -- box width; NULL: unknown
    height_m DOUBLE,                  -- box height; NULL: unknown
    is_ego BOOLEAN NOT NULL           -- the actor is an ego of this run
);

-- lifetime: drive
CREATE TABLE actor_state (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor
    t_ns BIGINT NOT NULL,             -- time stamp
    x_m DOUBLE,                       -- box centre, east; NULL: the actor is present, but its position is not known
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
    signal_id VARCHAR NOT NULL,       -- id of the traffic signal in the map or the log
    t_ns BIGINT NOT NULL,             -- time stamp
    state VARCHAR                     -- [light_state] NULL: not known
);

-- lifetime: drive
CREATE TABLE declared_event (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor that declared the event
    t_ns BIGINT NOT NULL,             -- time of the declaration
    event VARCHAR NOT NULL,           -- [event] recorded headlights are stored as the event headlights
    value VARCHAR                     -- value of the event, as text; NULL: it has none
);

-- lifetime: run
CREATE TABLE drive_condition (
    drive_id VARCHAR NOT NULL,        -- the drive
    condition VARCHAR NOT NULL,       -- [condition]
    value VARCHAR NOT NULL,           -- one of the words of the column of the same name in ego_condition
    source VARCHAR NOT NULL           -- [condition_source]
);

-- lifetime: part
CREATE TABLE deferred_ego (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL           -- an ego that is judged in another part of the run: no tables are derived for it in this part
);

-- lifetime: run
CREATE TABLE quality (
    drive_id VARCHAR NOT NULL,        -- the drive
    check_id VARCHAR NOT NULL,        -- [log_check] the check
    severity VARCHAR NOT NULL,        -- [check_severity]
    actor_id VARCHAR,                 -- the actor concerned; NULL: the whole drive
    n BIGINT NOT NULL,                -- number of samples concerned
    t_first_ns BIGINT,                -- time of the first of these samples. For lost_time: the last time before the loss; NULL: not known, or the loss is at the beginning of the log
    t_last_ns BIGINT,                 -- for lost_time only: the first time after the loss; NULL: the loss is at the end of the log, or the check is another one
    message VARCHAR NOT NULL          -- what was observed and its effect, in one sentence
);

-- Quantities of an actor that the checks of the log doubt, with the time: a step at which a rule uses one of them is unknown.
-- lifetime: drive
CREATE TABLE doubt (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor whose data are doubted
    quantity VARCHAR NOT NULL,        -- [quantity] the doubted quantity
    t_from_ns BIGINT NOT NULL,        -- first doubted time
    t_to_ns BIGINT NOT NULL,          -- last doubted time
    code VARCHAR NOT NULL             -- [log_check] the check that doubts the quantity
);
