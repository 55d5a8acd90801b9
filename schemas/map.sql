-- The road, in one format for all maps. The key is environment_id (map hash, offset and handedness): many drives share one map.
-- A lanelet is one lane of one lane section, on one type of road. Its points run in the direction of travel: left and right are as the driver sees them.

-- lifetime: run
CREATE TABLE environment (
    environment_id VARCHAR NOT NULL,  -- <map stem>-<first 8 hex of sha256><offset, if any><@lht or @rht; then ? if this is only the default, ~ if the lanes run against the driving side that the map states>
    name VARCHAR NOT NULL,            -- file name of the map, or of the log that contains the map
    sha256 VARCHAR NOT NULL,          -- SHA-256 of the map's bytes
    format VARCHAR NOT NULL,          -- opendrive, lanelet2, commonroad, sumo, osi, argoverse2, 123d, scenarionet
    offset_x_m DOUBLE NOT NULL,       -- offset that was added to the map's x coordinates
    offset_y_m DOUBLE NOT NULL,       -- offset that was added to the map's y coordinates
    handedness VARCHAR NOT NULL,      -- [handedness]
    handedness_source VARCHAR NOT NULL, -- [handedness_source]
    geo_reference VARCHAR,            -- projection, as a PROJ string or another text that PROJ reads; NULL: the map has none
    geo_offset_x_m DOUBLE,            -- x offset to the coordinates of geo_reference: the map's own coordinates (without offset_x_m, offset_y_m) are rotated by geo_offset_yaw_rad, then this is added; NULL: no geo_reference
    geo_offset_y_m DOUBLE,            -- the same for y
    geo_offset_z_m DOUBLE,            -- the same for z
    geo_offset_yaw_rad DOUBLE,        -- rotation about the z axis from the map's own coordinates to those of geo_reference, counter-clockwise
    geo_usable BOOLEAN,               -- geo_reference gives positions on the earth; if false, map_quality has the reason (geo_reference_unusable); NULL: the map has no geo_reference
    signs_mapped BOOLEAN NOT NULL     -- the map has the stop and give-way signs at its junctions; false: it has none of them (signs_unmapped in map_quality)
);

-- lifetime: map
CREATE TABLE lanelet (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- id of the lanelet; from OpenDRIVE: road.section.lane
    road_id VARCHAR NOT NULL,         -- the road of the lanelet
    section INTEGER NOT NULL,         -- number of the lane section, from 0 along the road; the later parts of a section that is divided where the type of its road changes have numbers after the last
    lane_no INTEGER NOT NULL,         -- lane number of OpenDRIVE (negative: right of the reference line)
    lane_type VARCHAR NOT NULL,       -- [lane_type]
    drivable BOOLEAN NOT NULL,        -- motor vehicles may drive here, by lane_type
    bidirectional BOOLEAN NOT NULL,   -- driven in both directions; its points run as those of a lane on the right of the reference line
    along_road INTEGER NOT NULL,      -- 1: the direction of travel is that of the road's reference line; -1: the opposite
    junction_id VARCHAR,              -- the junction in which this is a connecting lane; NULL: none
    road_type VARCHAR,                -- [road_type] NULL: the map does not state it
    length_m DOUBLE NOT NULL,         -- length along the centre line
    width_m DOUBLE NOT NULL,          -- mean width
    area_m2 DOUBLE NOT NULL,          -- area between the bounds
    left_id VARCHAR,                  -- the adjacent lanelet on the driver's left; NULL: none
    left_against BOOLEAN,             -- the adjacent lanelet on the left is driven in the opposite direction
    right_id VARCHAR,                 -- the adjacent lanelet on the driver's right; NULL: none
    right_against BOOLEAN,            -- the adjacent lanelet on the right is driven in the opposite direction
    geom GEOMETRY                     -- the area between the bounds: a polygon, or several polygons if the bounds cross each other
);

-- lifetime: map
CREATE TABLE lane_point (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    k INTEGER NOT NULL,               -- number of the point, from 0, in the direction of travel; at least two points per lanelet
    s_m DOUBLE NOT NULL,              -- distance from the start of the lanelet along its centre line
    x_m DOUBLE NOT NULL,              -- x of the point on the centre line
    y_m DOUBLE NOT NULL,              -- y of the point on the centre line
    z_m DOUBLE,                       -- elevation of the road's reference line; NULL: not known
    tx DOUBLE NOT NULL,               -- unit tangent in the direction of travel, x
    ty DOUBLE NOT NULL,               -- unit tangent in the direction of travel, y
    half_width_m DOUBLE NOT NULL,     -- half the distance between the bounds
    left_x_m DOUBLE NOT NULL,         -- left bound, x
    left_y_m DOUBLE NOT NULL,         -- left bound, y
    right_x_m DOUBLE NOT NULL,        -- right bound, x
    right_y_m DOUBLE NOT NULL,        -- right bound, y
    road_s_m DOUBLE NOT NULL          -- station (distance from the start) on the road's reference line
);

-- lifetime: map
CREATE TABLE lane_link (
    environment_id VARCHAR NOT NULL,  -- the map
    from_id VARCHAR NOT NULL,         -- a lanelet
    to_id VARCHAR NOT NULL,           -- a lanelet that continues from_id in the direction of travel
    turn_rad DOUBLE NOT NULL          -- change of heading along to_id, left positive; the smallest absolute value is straight on
);

-- lifetime: map
CREATE TABLE lane_boundary (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    side VARCHAR NOT NULL,            -- [side] the side of the boundary
    s_start_m DOUBLE NOT NULL,        -- start of this marking, along the lanelet's centre line
    s_end_m DOUBLE NOT NULL,          -- end of this marking
    marking VARCHAR,                  -- [marking] NULL: the map does not state it, or uses an unknown word
    color VARCHAR,                    -- [marking_color] NULL: the map does not state it
    lane_change VARCHAR               -- [lanes_changed] as the map states; NULL: it does not state it
);

-- lifetime: map
CREATE TABLE speed_limit (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    s_start_m DOUBLE NOT NULL,        -- start of this limit, along the lanelet's centre line
    s_end_m DOUBLE NOT NULL,          -- end of this limit
    limit_mps DOUBLE,                 -- the limit; NULL: the map states that there is none, or the limit is not readable
    source VARCHAR NOT NULL           -- [limit_source]
);

-- lifetime: map
CREATE TABLE traffic_signal (
    environment_id VARCHAR NOT NULL,  -- the map
    signal_id VARCHAR NOT NULL,       -- id of the signal in the map
    kind VARCHAR,                     -- [sign_kind] NULL: not recognised
    country VARCHAR,                  -- country of the code list of type and subtype, lower case
    type VARCHAR,                     -- code of the signal's type
    subtype VARCHAR,                  -- code of the signal's subtype
    value DOUBLE,                     -- the number on the sign, in the map's own unit; NULL: none, or it holds only at times or for some, as another sign or the map states
    unit VARCHAR,                     -- unit of value
    dynamic BOOLEAN NOT NULL,         -- its state changes, as that of a light
    turns VARCHAR[],                  -- [turn] of a traffic light: the turns that it controls: those of its arrow, or all four for a full light; NULL: the map does not state it
    road_id VARCHAR NOT NULL,         -- the road in which the map lists the signal
    road_s_m DOUBLE NOT NULL,         -- station on that road
    lanelet_id VARCHAR NOT NULL,      -- a lanelet that the signal controls; one row per lanelet
    lane_s_m DOUBLE NOT NULL,         -- position of the signal, as a distance along that lanelet
    x_m DOUBLE NOT NULL,              -- position of the signal, x
    y_m DOUBLE NOT NULL,              -- position of the signal, y
    geom GEOMETRY                     -- position of the signal, as a point
);

-- lifetime: map
CREATE TABLE stop_line (
    environment_id VARCHAR NOT NULL,  -- the map
    stop_line_id VARCHAR NOT NULL,    -- id of the line in the map
    lanelet_id VARCHAR NOT NULL,      -- a lanelet that the line crosses; one row per lanelet
    lane_s_m DOUBLE NOT NULL,         -- position of the line, as a distance along that lanelet
    source VARCHAR NOT NULL,          -- [stop_line_source]
    geom GEOMETRY                     -- the line across that lanelet, from its left to its right bound
);

-- lifetime: map
CREATE TABLE road_object (
    environment_id VARCHAR NOT NULL,  -- the map
    object_id VARCHAR NOT NULL,       -- id of the object in the map
    kind VARCHAR NOT NULL,            -- [object_kind]
    name VARCHAR,                     -- the map's name for the object
    road_id VARCHAR NOT NULL,         -- the road in which the map lists the object
    road_s_m DOUBLE NOT NULL,         -- station on that road
    x_m DOUBLE NOT NULL,              -- position of the object, x
    y_m DOUBLE NOT NULL,              -- position of the object, y
    outline_x_m DOUBLE[],             -- outline, counter-clockwise, x; NULL: a point
    outline_y_m DOUBLE[],             -- outline, y; NULL: a point
    geom GEOMETRY                     -- the outline as a polygon, or as a line if its area is 0; without an outline, the position as a point
);

-- lifetime: map
CREATE TABLE crossing (
    environment_id VARCHAR NOT NULL,  -- the map
    crossing_id VARCHAR NOT NULL,     -- id of the crossing in the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet that the crossing crosses; one row per lanelet
    s_start_m DOUBLE NOT NULL,        -- start of the crossing, along that lanelet
    s_end_m DOUBLE NOT NULL,          -- end of the crossing
    kind VARCHAR,                     -- [crossing_kind] NULL: the map does not state it
    geom GEOMETRY                     -- the part of the lanelet that the crossing covers: a polygon
);

-- lifetime: run
CREATE TABLE map_quality (
    environment_id VARCHAR NOT NULL,  -- the map
    check_id VARCHAR NOT NULL,        -- [map_check] the check
    severity VARCHAR NOT NULL,        -- [check_severity]
    lanelet_id VARCHAR,               -- the lanelet or road concerned; NULL: the whole map
    n BIGINT NOT NULL,                -- number of elements concerned
    message VARCHAR NOT NULL          -- what was observed and its effect
);
