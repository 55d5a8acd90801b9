-- The road, one format for all maps. Keyed by environment_id (map hash, offset and handedness), so a thousand drives share one.
-- A lanelet is one lane of one lane section. Its points run in the direction of travel, so left and right are the driver's.

-- lifetime: run
CREATE TABLE environment (
    environment_id VARCHAR NOT NULL,  -- <map stem>-<first 8 hex of sha256><offset, if any><@lht or @rht, with ? if only by default, with ~ if the lanes run the other way than its rule says>
    name VARCHAR NOT NULL,            -- file name of the map, or the log it was embedded in
    sha256 VARCHAR NOT NULL,          -- hash of the map's bytes
    format VARCHAR NOT NULL,          -- opendrive, lanelet2, commonroad, sumo, osi, argoverse2, 123d, scenarionet
    offset_x_m DOUBLE NOT NULL,       -- added to the map's coordinates
    offset_y_m DOUBLE NOT NULL,       -- added to the map's coordinates
    handedness VARCHAR NOT NULL,      -- [handedness]
    handedness_source VARCHAR NOT NULL, -- [handedness_source]
    geo_reference VARCHAR,            -- projection (a PROJ string or what else PROJ understands), if the map has one
    geo_offset_x_m DOUBLE,            -- the map's own coordinates, without offset_x_m and offset_y_m, are turned by geo_offset_yaw_rad and then moved by this to be those of geo_reference; NULL: no geo_reference
    geo_offset_y_m DOUBLE,            -- the same for y
    geo_offset_z_m DOUBLE,            -- the same for z
    geo_offset_yaw_rad DOUBLE,        -- turn about the z axis from the map's own coordinates to those of geo_reference, counter-clockwise
    geo_usable BOOLEAN,               -- geo_reference gives positions on the earth; why not is in map_quality (geo_reference_unusable); NULL: there is none
    signs_mapped BOOLEAN NOT NULL     -- it has the stop and give-way signs of the ways into its junctions, where there are any; false: it has none of them (signs_unmapped in map_quality)
);

-- lifetime: map
CREATE TABLE lanelet (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- OpenDRIVE: road.section.lane
    road_id VARCHAR NOT NULL,         -- the road it belongs to
    section INTEGER NOT NULL,         -- index of the lane section along the road, from 0
    lane_no INTEGER NOT NULL,         -- OpenDRIVE lane number (negative: right of the reference line)
    lane_type VARCHAR NOT NULL,       -- [lane_type]
    drivable BOOLEAN NOT NULL,        -- motor vehicles may drive here (by lane_type)
    bidirectional BOOLEAN NOT NULL,   -- driven in both directions; its points then run as the road's right-hand side would
    along_road INTEGER NOT NULL,      -- 1: direction of travel is that of the reference line, -1: against it
    junction_id VARCHAR,              -- the junction it is a connecting lane of; NULL: none
    road_type VARCHAR,                -- [road_type] NULL: the map does not state it
    length_m DOUBLE NOT NULL,         -- along the centre line
    width_m DOUBLE NOT NULL,          -- mean width
    area_m2 DOUBLE NOT NULL,          -- area between the bounds
    left_id VARCHAR,                  -- the lanelet beside it on the driver's left; NULL: none
    left_against BOOLEAN,             -- that one is driven the other way
    right_id VARCHAR,                 -- the lanelet beside it on the driver's right; NULL: none
    right_against BOOLEAN,            -- that one is driven the other way
    geom GEOMETRY                     -- the area between its bounds: a polygon, or several where the bounds cross
);

-- lifetime: map
CREATE TABLE lane_point (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    k INTEGER NOT NULL,               -- 0.. in the direction of travel; at least two per lanelet
    s_m DOUBLE NOT NULL,              -- distance from the lanelet's start along its centre line
    x_m DOUBLE NOT NULL,              -- centre line
    y_m DOUBLE NOT NULL,              -- centre line
    z_m DOUBLE,                       -- elevation of the reference line; NULL: unknown
    tx DOUBLE NOT NULL,               -- unit tangent in the direction of travel
    ty DOUBLE NOT NULL,               -- unit tangent in the direction of travel
    half_width_m DOUBLE NOT NULL,     -- half the distance between the bounds
    left_x_m DOUBLE NOT NULL,         -- left bound
    left_y_m DOUBLE NOT NULL,         -- left bound
    right_x_m DOUBLE NOT NULL,        -- right bound
    right_y_m DOUBLE NOT NULL,        -- right bound
    road_s_m DOUBLE NOT NULL          -- station on the road's reference line
);

-- lifetime: map
CREATE TABLE lane_link (
    environment_id VARCHAR NOT NULL,  -- the map
    from_id VARCHAR NOT NULL,         -- a lanelet
    to_id VARCHAR NOT NULL,           -- one that continues it in the direction of travel
    turn_rad DOUBLE NOT NULL          -- heading change over to_id, left positive: smallest = straight on
);

-- lifetime: map
CREATE TABLE lane_boundary (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    side VARCHAR NOT NULL,            -- [side]
    s_start_m DOUBLE NOT NULL,        -- from here, along the lanelet's centre line
    s_end_m DOUBLE NOT NULL,          -- to here
    marking VARCHAR,                  -- [marking] NULL: the map does not state it, or not in a word that is known
    color VARCHAR,                    -- [marking_color] NULL: the map does not state it
    lane_change VARCHAR               -- [lanes_changed] as the map says; NULL: it does not
);

-- lifetime: map
CREATE TABLE speed_limit (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    s_start_m DOUBLE NOT NULL,        -- from here, along the lanelet's centre line
    s_end_m DOUBLE NOT NULL,          -- to here
    limit_mps DOUBLE,                 -- the limit; NULL: said to have none, or not readable
    source VARCHAR NOT NULL           -- [limit_source]
);

-- lifetime: map
CREATE TABLE traffic_signal (
    environment_id VARCHAR NOT NULL,  -- the map
    signal_id VARCHAR NOT NULL,       -- id in the map
    kind VARCHAR,                     -- [sign_kind] NULL: not recognised
    country VARCHAR,                  -- code list it is from, lower case
    type VARCHAR,                     -- code
    subtype VARCHAR,                  -- code
    value DOUBLE,                     -- the number on it, in the map's own unit
    unit VARCHAR,                     -- that unit
    dynamic BOOLEAN NOT NULL,         -- changes its state
    turns VARCHAR[],                  -- [turn] of a traffic light: the turns it holds for: those of its arrow, or all four for a full light; NULL: the map does not state it
    road_id VARCHAR NOT NULL,         -- road it is listed on
    road_s_m DOUBLE NOT NULL,         -- station on that road
    lanelet_id VARCHAR NOT NULL,      -- a lanelet it holds for; one row each
    lane_s_m DOUBLE NOT NULL,         -- where it stands, along that lanelet
    x_m DOUBLE NOT NULL,              -- where it stands
    y_m DOUBLE NOT NULL,              -- where it stands
    geom GEOMETRY                     -- the same, as a point
);

-- lifetime: map
CREATE TABLE stop_line (
    environment_id VARCHAR NOT NULL,  -- the map
    stop_line_id VARCHAR NOT NULL,    -- id in the map
    lanelet_id VARCHAR NOT NULL,      -- a lanelet it crosses; one row each
    lane_s_m DOUBLE NOT NULL,         -- where, along that lanelet
    source VARCHAR NOT NULL,          -- [stop_line_source]
    geom GEOMETRY                     -- the line across that lanelet, from its left to its right bound
);

-- lifetime: map
CREATE TABLE road_object (
    environment_id VARCHAR NOT NULL,  -- the map
    object_id VARCHAR NOT NULL,       -- id in the map
    kind VARCHAR NOT NULL,            -- [object_kind]
    name VARCHAR,                     -- the map's name for it
    road_id VARCHAR NOT NULL,         -- road it is listed on
    road_s_m DOUBLE NOT NULL,         -- station on that road
    x_m DOUBLE NOT NULL,              -- where it stands
    y_m DOUBLE NOT NULL,              -- where it stands
    outline_x_m DOUBLE[],             -- its outline, counter-clockwise; NULL: a point
    outline_y_m DOUBLE[],             -- its outline
    geom GEOMETRY                     -- its outline as a polygon, or as a line where it has no area; or the point where it stands
);

-- lifetime: map
CREATE TABLE crossing (
    environment_id VARCHAR NOT NULL,  -- the map
    crossing_id VARCHAR NOT NULL,     -- id in the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet it lies across; one row each
    s_start_m DOUBLE NOT NULL,        -- from here, along that lanelet
    s_end_m DOUBLE NOT NULL,          -- to here
    kind VARCHAR,                     -- [crossing_kind] NULL: the map does not state it
    geom GEOMETRY                     -- its part of that lanelet: a polygon
);

-- lifetime: run
CREATE TABLE map_quality (
    environment_id VARCHAR NOT NULL,  -- the map
    check_id VARCHAR NOT NULL,        -- [map_check] which check
    severity VARCHAR NOT NULL,        -- [check_severity]
    lanelet_id VARCHAR,               -- the lanelet or road concerned; NULL: the whole map
    n BIGINT NOT NULL,                -- how often
    message VARCHAR NOT NULL          -- what was seen and what follows from it
);
