-- The derived tables, first part: queries/derive/<table>.sql fills each. The key is (drive_id, ego_id), except for properties of the map
-- or of any actor. An actor that is present without a known position has a row with NULL, never an absent row.

-- ---- the map, prepared once per environment

-- lifetime: map
CREATE TABLE lane_segment (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    k INTEGER NOT NULL,               -- number of the segment, which runs from point k to point k + 1
    s0_m DOUBLE NOT NULL,             -- station (distance along the lanelet's centre line) of the segment's start
    len_m DOUBLE NOT NULL,            -- length along the centre line
    x0_m DOUBLE NOT NULL,             -- start, x
    y0_m DOUBLE NOT NULL,             -- start, y
    tx0 DOUBLE NOT NULL,              -- unit tangent at the start, x
    ty0 DOUBLE NOT NULL,              -- unit tangent at the start, y
    hw0_m DOUBLE NOT NULL,            -- half width at the start
    x1_m DOUBLE NOT NULL,             -- end, x
    y1_m DOUBLE NOT NULL,             -- end, y
    tx1 DOUBLE NOT NULL,              -- unit tangent at the end, x
    ty1 DOUBLE NOT NULL,              -- unit tangent at the end, y
    hw1_m DOUBLE NOT NULL,            -- half width at the end
    slack0_m DOUBLE NOT NULL,         -- how far the segment extends beyond its start: 0.05 at the ends of the lanelet, where tangents may differ slightly; else 0
    slack1_m DOUBLE NOT NULL          -- how far the segment extends beyond its end, as slack0_m
);

-- lifetime: map
CREATE TABLE lane_near (
    environment_id VARCHAR NOT NULL,  -- the map
    from_id VARCHAR NOT NULL,         -- a drivable lanelet
    to_id VARCHAR NOT NULL,           -- the same lanelet, or a lanelet that continues it within three links
    hops INTEGER NOT NULL             -- least number of links from from_id to to_id, 0 to 3
);

-- lifetime: map
CREATE TABLE lane_next (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet
    ahead_id VARCHAR,                 -- the straightest lanelet that continues this one; NULL: none
    behind_id VARCHAR,                -- the straightest lanelet that this one continues; NULL: none
    map_ends BOOLEAN NOT NULL,        -- neither this lanelet nor a lane beside it of the same direction has a continuation: the map ends here
    map_begins BOOLEAN NOT NULL       -- neither this lanelet nor a lane beside it of the same direction continues another lanelet: the map begins here
);

-- lifetime: map
CREATE TABLE lane_apart (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet
    other_id VARCHAR NOT NULL         -- a lanelet of another road over or under it, as far as the map shows: no junction, link or common end joins the two (only decks may begin and end together), and their heights differ by more than 2.5 m or are not known; each pair has two rows
);

-- lifetime: map
CREATE TABLE lane_beside (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet
    side VARCHAR NOT NULL,            -- [side] the side of the boundary
    s_start_m DOUBLE NOT NULL,        -- start of the piece, along the lanelet's centre line; no row: the map has nothing beyond the boundary here
    s_end_m DOUBLE NOT NULL,          -- end of the piece
    beside_id VARCHAR NOT NULL,       -- the lanelet beyond the boundary: the neighbour that the map names, else the drivable lanelet of any road that runs along the boundary at most 2 m away; behind a narrow strip, the opposing lane
    against BOOLEAN NOT NULL,         -- that lanelet is driven in the opposite direction
    gap_m DOUBLE NOT NULL,            -- from the boundary to the nearer bound of beside_id; 0: the map names it as neighbour
    strip VARCHAR,                    -- [lane_strip] the strip between the two; NULL: none
    drivable BOOLEAN NOT NULL,        -- see lanelet
    lane_type VARCHAR NOT NULL,       -- [lane_type] see lanelet
    width_m DOUBLE NOT NULL           -- width of beside_id
);

-- lifetime: map
CREATE TABLE road_half (
    environment_id VARCHAR NOT NULL,  -- the map
    road_id VARCHAR NOT NULL,         -- a road of one direction
    of_road_id VARCHAR NOT NULL,      -- the adjacent road of the opposite direction, whose id comes first: for a driver, the two are one road
    turned BOOLEAN NOT NULL           -- the reference lines of the two roads run in opposite directions
);

-- lifetime: map
CREATE TABLE junction_area (
    environment_id VARCHAR NOT NULL,  -- the map
    junction_id VARCHAR NOT NULL,     -- see lanelet
    geom GEOMETRY                     -- the area of the junction's drivable lanelets
);

-- lifetime: map
CREATE TABLE road_surface (
    environment_id VARCHAR NOT NULL,  -- the map
    road_id VARCHAR NOT NULL,         -- see lanelet
    geom GEOMETRY                     -- the carriageway: the area of the road's drivable lanelets and of the shoulder, stop, border, parking, restricted and biking lanes beside them
);

-- lifetime: map
CREATE TABLE strip_cell (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet
    k INTEGER NOT NULL,               -- number of the segment, see lane_segment
    cell BIGINT NOT NULL              -- 4 m grid cell that the strip of 15 m on both sides of the segment may touch
);

-- lifetime: map
CREATE TABLE lane_cell (
    environment_id VARCHAR NOT NULL,  -- the map
    cell BIGINT NOT NULL,             -- 2 m grid cell that the segment's lane area may touch
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    drivable BOOLEAN NOT NULL,        -- see lanelet
    footway BOOLEAN,                  -- for pedestrians only; NULL: the use of the lane is not known
    k INTEGER NOT NULL,               -- number of the segment, see lane_segment
    s0_m DOUBLE NOT NULL,             -- lanelet station of the segment's start
    len_m DOUBLE NOT NULL,            -- length of the segment along the centre line
    x0_m DOUBLE NOT NULL,             -- start, x
    y0_m DOUBLE NOT NULL,             -- start, y
    tx0 DOUBLE NOT NULL,              -- unit tangent at the start, x
    ty0 DOUBLE NOT NULL,              -- unit tangent at the start, y
    hw0_m DOUBLE NOT NULL,            -- half width of the lane at the start
    x1_m DOUBLE NOT NULL,             -- end, x
    y1_m DOUBLE NOT NULL,             -- end, y
    tx1 DOUBLE NOT NULL,              -- unit tangent at the end, x
    ty1 DOUBLE NOT NULL,              -- unit tangent at the end, y
    hw1_m DOUBLE NOT NULL,            -- half width of the lane at the end
    slack0_m DOUBLE NOT NULL,         -- see lane_segment
    slack1_m DOUBLE NOT NULL          -- see lane_segment
);

-- ---- time, and the inputs that the drive has

-- lifetime: part
CREATE TABLE ego_clock (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- an ego of the drive, also if it is judged in another part of the run
    period_ns BIGINT NOT NULL,        -- see clock
    max_gap_ns BIGINT NOT NULL,       -- see clock
    t_start_ns BIGINT NOT NULL,       -- the ego's first sample
    t_end_ns BIGINT NOT NULL          -- the ego's last sample
);

-- lifetime: part
CREATE TABLE clock (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    period_ns BIGINT NOT NULL,        -- median time between the ego's samples
    max_gap_ns BIGINT NOT NULL,       -- samples closer than this are continuous (2.5 periods by default)
    t_start_ns BIGINT NOT NULL,       -- the ego's first sample
    t_end_ns BIGINT NOT NULL          -- the ego's last sample
);

-- lifetime: part
CREATE TABLE ego_part (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- an actor of the log that belongs to the ego and is no other road user
    part VARCHAR NOT NULL             -- [part_of_ego]
);

-- lifetime: part
CREATE TABLE ego_actor (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    actor_id VARCHAR NOT NULL         -- the ego, or a trailer that it tows: actors whose boxes belong to the ego at the same time
);

-- lifetime: part
CREATE TABLE lost_time (
    drive_id VARCHAR NOT NULL,        -- the drive
    t_from_ns BIGINT NOT NULL,        -- last time before the loss: the log lacks records between this time and t_to_ns
    t_to_ns BIGINT NOT NULL           -- first time after the loss; the two are far apart if the beginning or end of the log is lost
);

-- lifetime: part
CREATE TABLE step (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- time of the step: a sample of the ego
    k INTEGER NOT NULL,               -- number of the step, from 0, in time order
    dt_ns BIGINT,                     -- time since the previous step; NULL: the first step
    seg INTEGER NOT NULL,             -- number of the segment, from 0: it increases after each hole (a gap longer than max_gap_ns) and each lost time
    travel_m DOUBLE NOT NULL          -- distance driven since the first step, summed over the known positions
);

-- lifetime: run
CREATE TABLE capability (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    signal VARCHAR NOT NULL,          -- [signal] an input that a rule may require
    available BOOLEAN NOT NULL,       -- the log and map provide it
    reason VARCHAR NOT NULL           -- why the signal is available or missing, as JSON from the macro why
);

-- lifetime: run
CREATE TABLE registration (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    n_steps BIGINT NOT NULL,          -- number of ego steps with a position
    n_on_lane BIGINT NOT NULL,        -- steps with the centre on a drivable lane, or on a shoulder, lay-by, border, parking, restricted or cycle lane
    n_moving BIGINT NOT NULL,         -- steps on a lane, with a heading, faster than 1 m/s, and not in an overtake in an opposing lane
    n_with_direction BIGINT NOT NULL, -- steps of n_moving with a heading within 90 degrees of the lane's direction, or on a lane that is driven in both directions
    lateral_median_m DOUBLE,          -- median distance from the centre line of the lane; if enough steps lie outside an overtake in the opposing lane, only of those steps; NULL: never on a lane
    is_aside BOOLEAN NOT NULL,        -- lateral_median_m is so great, over meaningful steps, that the map may be shifted against the log
    ok BOOLEAN NOT NULL,              -- the map fits well enough for the rules that need it. One of: the ego fits; the ego is against its lane, but three of four other vehicles are with theirs; the ego keeps to the middle of a lane before and after the time elsewhere (within 0.6 m for 5 s and 50 m, or 0.3 m for 2 s and 20 m; on a road of the same direction or on two roads that cross)
    reason VARCHAR NOT NULL           -- why ok is true or false, as JSON from the macro why
);

-- ---- positions of the actors

-- lifetime: part
CREATE TABLE road_user (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor
    actor_class VARCHAR,              -- [actor_class] the class, as far as known: the recorded class; vehicle also for an actor without a class that is longer than 3 m; object only for an actor that stays within 1 m in the whole log; NULL: it may be any class {class}
    length_m DOUBLE,                  -- box length {size}
    width_m DOUBLE                    -- box width {size}
);

-- lifetime: part
CREATE TABLE state_dynamics (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor
    t_ns BIGINT NOT NULL,             -- time stamp
    x_m DOUBLE,                       -- box centre, x {position}
    y_m DOUBLE,                       -- box centre, y {position}
    z_m DOUBLE,                       -- box centre, height; NULL: not recorded, or constant as in a flat simulation {position}
    yaw_rad DOUBLE,                   -- heading {heading}
    travel_rad DOUBLE,                -- direction of travel: of a moving vehicle its heading (the opposite if it reverses), of another moving actor its velocity's direction, else the heading {heading}
    vx_mps DOUBLE,                    -- velocity east {velocity}
    vy_mps DOUBLE,                    -- velocity north {velocity}
    speed_mps DOUBLE,                 -- length of the velocity vector {velocity}
    accel_mps2 DOUBLE,                -- backward difference of the speed at the log's own rate, unfiltered; NULL: first sample, sample after a hole, or velocity derived by a filter (quality velocity_filtered) {velocity}
    length_m DOUBLE,                  -- box length {size}
    width_m DOUBLE,                   -- box width {size}
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    indicator VARCHAR                 -- [indicator] see actor_state
);

-- lifetime: part
CREATE TABLE lane_occupancy (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor
    t_ns BIGINT NOT NULL,             -- time stamp
    lanelet_id VARCHAR,               -- a lanelet that contains the box centre, one row per lanelet; NULL: on none, or no position
    s_m DOUBLE,                       -- station of the centre along the lanelet {position}
    d_m DOUBLE,                       -- offset from the lanelet's centre line, left of travel positive {position}
    half_width_m DOUBLE,              -- half the lanelet's width there
    heading_diff_rad DOUBLE,          -- the actor's heading relative to the lane's direction, -pi..pi {heading}
    drivable BOOLEAN                  -- see lanelet {position}
);

-- lifetime: part
CREATE TABLE ego_lane (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    lanelet_id VARCHAR,               -- the drivable lanelet that the ego is on, one per step; in junctions, the lanelet on the ego's path; NULL: none
    s_m DOUBLE,                       -- station along the lanelet {position}
    d_m DOUBLE,                       -- offset from the lanelet's centre line, left of travel positive {position}
    half_width_m DOUBLE,              -- half the lanelet's width there
    with_direction BOOLEAN,           -- the heading is within 90 degrees of the lane's direction {heading}
    with_traffic BOOLEAN              -- with_direction, or the lane is driven in both directions {position}
);

-- lifetime: part
CREATE TABLE ego_aside (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which the ego is on no drivable lane, but on a lane beside one
    lanelet_id VARCHAR NOT NULL,      -- the nearest lane of this kind: a shoulder, border, parking or cycle lane
    lane_type VARCHAR NOT NULL,       -- [lane_type] see lanelet
    road_type VARCHAR,                -- [road_type] see lanelet
    off_m DOUBLE NOT NULL,            -- distance of the ego from the lane's centre line {position}
    with_direction BOOLEAN            -- the heading is within 90 degrees of the lane's direction; NULL: heading not known {heading}
);

-- lifetime: part
CREATE TABLE own_way (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    seg INTEGER NOT NULL,             -- see step: a new piece of the path begins after a hole
    k INTEGER NOT NULL,               -- number of the segment along the piece, from 0
    t_from_ns BIGINT,                 -- time at which the ego's centre was at the segment's start; NULL: the segment is extrapolated
    s0_m DOUBLE NOT NULL,             -- path length from the start of the piece to the start of the segment {position}
    len_m DOUBLE NOT NULL,            -- length of the segment {position}
    driven_m DOUBLE NOT NULL,         -- driven length of the piece; beyond it, the path is extrapolated with the same curvature for 3 s at the last speed, at least 25 m {position}
    x0_m DOUBLE NOT NULL,             -- start, x {position}
    y0_m DOUBLE NOT NULL,             -- start, y {position}
    tx0 DOUBLE NOT NULL,              -- unit tangent at the start, x {position}
    ty0 DOUBLE NOT NULL,              -- unit tangent at the start, y {position}
    x1_m DOUBLE NOT NULL,             -- end, x {position}
    y1_m DOUBLE NOT NULL,             -- end, y {position}
    tx1 DOUBLE NOT NULL,              -- unit tangent at the end, x {position}
    ty1 DOUBLE NOT NULL,              -- unit tangent at the end, y {position}
    bend_per_m DOUBLE NOT NULL        -- curvature, 1 / radius, left positive {position}
);

-- lifetime: part
CREATE TABLE chain (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- number of the chain, from 0, in time order; each change to another running lane begins a new chain
    seq INTEGER NOT NULL,             -- order along the chain, from its end far behind
    lanelet_id VARCHAR NOT NULL,      -- the lanelet; without a map, a piece of own_way
    s_start_m DOUBLE NOT NULL,        -- chain station of the lanelet's start; 0: start of the first lanelet that the ego drove in this chain
    length_m DOUBLE NOT NULL,         -- length of the lanelet
    t_first_ns BIGINT,                -- first step at which the ego drove the lanelet in its direction; NULL: not driven: it continues straight on, or the ego cut the corner beside it
    t_last_ns BIGINT                  -- last step at which the ego drove it; NULL: as t_first_ns
);

-- lifetime: part
CREATE TABLE corridor (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- the running chain
    seq INTEGER NOT NULL,             -- order along the chain
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    s_start_m DOUBLE NOT NULL,        -- see chain {position}
    length_m DOUBLE NOT NULL,         -- see chain {size}
    side INTEGER,                     -- the overtaking side: 1 left (right-hand traffic), -1 right; NULL: handedness unknown {position}
    over_width_m DOUBLE,              -- width of the lane beside the lanelet on the overtaking side (see lane_beside), plus the gap between the two, if that lane exists along more than half of the lanelet; inside a junction, the width before or after it; NULL: no such lane
    over_against BOOLEAN              -- that lane is driven in the opposite direction {position, heading, size}
);

-- lifetime: part
CREATE TABLE visited_cell (
    drive_id VARCHAR NOT NULL,        -- the drive
    cell BIGINT NOT NULL              -- 4 m grid cell that at some time contained the centre of an actor or a corner of an ego
);

-- lifetime: part
CREATE TABLE corridor_cell (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    cell BIGINT NOT NULL,             -- 4 m grid cell that the strip beside the segment may touch and that an actor visited (see visited_cell)
    lanelet_id VARCHAR NOT NULL,      -- a lanelet of any of the ego's chains
    k INTEGER NOT NULL,               -- number of the segment
    s0_m DOUBLE NOT NULL,             -- lanelet station of the segment's start
    len_m DOUBLE NOT NULL,            -- length of the segment along the centre line
    x0_m DOUBLE NOT NULL,             -- start, x
    y0_m DOUBLE NOT NULL,             -- start, y
    tx0 DOUBLE NOT NULL,              -- unit tangent at the start, x
    ty0 DOUBLE NOT NULL,              -- unit tangent at the start, y
    hw0_m DOUBLE NOT NULL,            -- half width of the lane at the start
    x1_m DOUBLE NOT NULL,             -- end, x
    y1_m DOUBLE NOT NULL,             -- end, y
    tx1 DOUBLE NOT NULL,              -- unit tangent at the end, x
    ty1 DOUBLE NOT NULL,              -- unit tangent at the end, y
    hw1_m DOUBLE NOT NULL,            -- half width of the lane at the end
    slack0_m DOUBLE NOT NULL,         -- see lane_segment
    slack1_m DOUBLE NOT NULL          -- see lane_segment
);

-- lifetime: part
CREATE TABLE ego_corridor (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- a running chain whose strip contains the ego
    t_ns BIGINT NOT NULL,             -- the step
    s_m DOUBLE NOT NULL,              -- chain station of the box centre {position}
    d_m DOUBLE NOT NULL,              -- offset of the centre from the running lane's centre line, left positive {position}
    left_out_m DOUBLE,                -- distance of the outermost corner beyond the running lane's left boundary; negative: all corners are inside {position, heading, size}
    left_in_m DOUBLE,                 -- distance of the innermost corner beyond the left boundary; positive: the whole box is beyond it {position}
    right_out_m DOUBLE,               -- distance of the outermost corner beyond the right boundary; negative: all corners are inside {position, heading, size}
    right_in_m DOUBLE,                -- distance of the innermost corner beyond the right boundary; positive: the whole box is beyond it {position}
    front_s_m DOUBLE,                 -- chain station of the foremost corner {position, heading, size}
    rear_s_m DOUBLE,                  -- chain station of the rearmost corner {position, heading, size}
    lat_half_m DOUBLE,                -- half the extent of the box across the corridor {heading, size}
    half_width_m DOUBLE NOT NULL,     -- half width of the running lane at the centre's station
    over_width_m DOUBLE,              -- see corridor
    over_against BOOLEAN,             -- see corridor {position, heading, size}
    side INTEGER,                     -- see corridor {position}
    heading_diff_rad DOUBLE           -- the ego's heading relative to the corridor, -pi..pi {heading}
);

-- lifetime: part
CREATE TABLE ego_state (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    x_m DOUBLE,                       -- box centre, x {position}
    y_m DOUBLE,                       -- box centre, y {position}
    z_m DOUBLE,                       -- see state_dynamics {position}
    yaw_rad DOUBLE,                   -- heading {heading}
    speed_mps DOUBLE,                 -- speed of the ego {velocity}
    accel_mps2 DOUBLE,                -- see state_dynamics {velocity}
    fastest_3s_mps DOUBLE,            -- highest speed at this step and in the 3 s before it; NULL: the ego stands in the recorded part, and not all 3 s are recorded {velocity}
    travel_m DOUBLE,                  -- distance driven since the first step {position}
    length_m DOUBLE,                  -- box length {size}
    width_m DOUBLE,                   -- box width {size}
    combination_m DOUBLE,             -- length including the trailer that the ego tows; NULL: the trailer's position is not known {size}
    indicator VARCHAR,                -- [indicator] NULL: not known
    lanelet_id VARCHAR,               -- see ego_lane
    with_direction BOOLEAN,           -- see ego_lane {heading}
    with_traffic BOOLEAN,             -- see ego_lane {position}
    in_junction BOOLEAN,              -- on a junction's lanelet; NULL: on no lanelet {position}
    road_type VARCHAR,                -- [road_type] of the lanelet; NULL: the map does not state it
    limit_mps DOUBLE,                 -- speed limit at the ego's position; NULL: see limit_source
    limit_source VARCHAR,             -- [limit_source + none] none: the map states that there is no limit; NULL: it states nothing
    chain_id INTEGER,                 -- the running chain of the ego at this step; NULL: none
    s_m DOUBLE,                       -- chain station of the centre {position}
    d_m DOUBLE,                       -- offset of the centre from the running lane's centre line, left positive {position}
    front_s_m DOUBLE,                 -- chain station of the front bumper {position, heading, size}
    rear_s_m DOUBLE,                  -- chain station of the rear bumper, or of the trailer's rear {position, heading, size}
    lat_half_m DOUBLE,                -- half the extent of the box across the corridor {heading, size}
    heading_diff_rad DOUBLE           -- heading relative to the corridor {heading}
);

-- lifetime: part
CREATE TABLE ego_footway (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    depth_m DOUBLE                    -- how deep a corner or the middle of a side is inside a footway and outside every carriageway; 0: not inside; NULL: the box is not known, or part of it is outside every lane of the map {position, heading, size}
);

-- lifetime: part
CREATE TABLE pair (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the ego's step
    object_id VARCHAR NOT NULL,       -- an actor that is not part of the ego; one row per step from its first to its last sample, but none while reliable heights show it over or under the ego's road
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    x_m DOUBLE,                       -- the object's box centre, x; NULL: no position (not recorded, stale, a hole in the track, or off_level) {position}
    y_m DOUBLE,                       -- the object's box centre, y {position}
    yaw_rad DOUBLE,                   -- the object's heading; of a reversing vehicle the opposite heading (see travel_rad of state_dynamics) {heading}
    speed_mps DOUBLE,                 -- the object's speed {velocity}
    accel_mps2 DOUBLE,                -- see state_dynamics {velocity}
    length_m DOUBLE,                  -- the object's box length {size}
    width_m DOUBLE,                   -- the object's box width {size}
    distance_m DOUBLE,                -- distance from centre to centre {position}
    off_level BOOLEAN NOT NULL,       -- the object is or may be over or under the ego's road: the map has another road there, or the log's heights are not reliable; no row if reliable heights show it {position}
    clearance_m DOUBLE,               -- distance between the two boxes (the trailer's box included); negative: depth of overlap; only a lower bound beyond 30 m and while off_level; NULL also if off_level and the boxes overlap in plan {position, heading, size}
    clearance_is_bound BOOLEAN,       -- clearance_m is only a lower bound {position, heading, size}
    s_m DOUBLE,                       -- station of the object's centre on the ego's running chain; NULL: outside the corridor's strip {position}
    d_m DOUBLE,                       -- offset of the object's centre from the running lane's centre line, left positive {position}
    front_s_m DOUBLE,                 -- the object's furthest station along the ego's direction {position, heading, size}
    rear_s_m DOUBLE,                  -- the object's nearest station along the ego's direction {position, heading, size}
    lat_half_m DOUBLE,                -- half the extent of the object's box across the corridor {heading, size}
    heading_diff_rad DOUBLE,          -- the object's heading relative to the corridor, -pi..pi {heading}
    half_width_m DOUBLE,              -- half width of the running lane at the object's station
    over_width_m DOUBLE,              -- see corridor
    over_against BOOLEAN              -- see corridor {position, heading, size}
);

-- lifetime: part
CREATE TABLE between_steps (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step; the boxes are apart at this step and the next, but came nearer between the two and may have touched
    t_next_ns BIGINT NOT NULL,        -- the next step, with no hole before it {position}
    object_id VARCHAR NOT NULL,       -- the other actor
    least_m DOUBLE NOT NULL,          -- least clearance between the two steps, if both boxes move on the cubic through the positions and velocities at both (on the chord, if the velocities contradict it); negative: depth of overlap {position, heading, size}
    blur_m DOUBLE NOT NULL            -- error bound of least_m, if neither brakes or swerves by more than 8 m/s2. Smaller than -least_m: certain contact. Smaller than least_m: no contact, and no row {position}
);

-- lifetime: part
CREATE TABLE clearance_least (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which the clearance in pair is not known
    object_id VARCHAR NOT NULL,       -- the other actor
    least_m DOUBLE NOT NULL           -- lower bound of the clearance, positive: from the positions before and after the step {position, heading, size}
);

-- lifetime: part
CREATE TABLE lost_object (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- an actor whose track ends although it may still have been there
    t_from_ns BIGINT NOT NULL,        -- the actor's position is unknown from this time on {position}
    t_to_ns BIGINT NOT NULL,          -- the actor's position is unknown until this time: the log's end or, if data_log.in_sight holds and the track ended near the ego, the time at which the recorder would have found it again {position}
    code VARCHAR NOT NULL             -- [loss]
);

-- lifetime: part
CREATE TABLE track_off_level (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- an actor that has rows in pair, but at the last (or first) sample of its track is over or under the ego's road
    lost BOOLEAN NOT NULL             -- true: at the end of the track; false: at its beginning {position}
);

-- lifetime: part
CREATE TABLE unplaced (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- a vehicle that may be on the road ahead, but has no position on it
    code VARCHAR NOT NULL             -- [unplaced_cause + lost + lost_behind + appeared + beyond_map] the reason; see unseen
);

-- lifetime: part
CREATE TABLE unseen (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which the log does not have the object
    object_id VARCHAR NOT NULL,       -- an actor whose track ends before this step or begins after it, near enough to matter
    near BOOLEAN NOT NULL,            -- when seen, the object was close, within the sensor's range or coming towards the ego: it may be anywhere on the road {position}
    code VARCHAR NOT NULL,            -- [unseen_cause]
    ahead_m DOUBLE,                   -- if the object entered or left the map over its far end: distance from the ego's front to that end; NULL: it did not {position}
    behind_m DOUBLE,                  -- if it entered or left the map over its near end: distance from the ego's rear to that end; NULL: it did not {position}
    off_ahead_m DOUBLE,               -- if it entered or left the map over any end, of any road, and so is not on the ego's corridor: distance from the ego's front to the corridor's far end; NULL: it did not {position}
    off_behind_m DOUBLE               -- in the same case: distance from the ego's rear to the corridor's near end; NULL: as off_ahead_m {position}
);

-- lifetime: part
CREATE TABLE oncoming_vehicle (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- a vehicle or animal that comes towards the ego in the lane in which the ego would overtake; not one that never moved
    vehicle BOOLEAN,                  -- it is a vehicle; NULL: its class is not known {class}
    da_m DOUBLE,                      -- distance along the corridor from the ego's front to its nearest corner; if on_its_way, plus the distance that it has to drive to the corridor {position}
    speed_mps DOUBLE,                 -- speed of the vehicle {velocity}
    on_its_way BOOLEAN NOT NULL       -- it is not on the corridor yet, but gets there within 15 s {position, heading, velocity}
);

-- lifetime: part
CREATE TABLE oncoming (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; no row: the ego's own position is not known
    object_id VARCHAR,                -- OV: the nearest oncoming vehicle, on the overtaking chain or on its way to it; NULL: none seen
    da_m DOUBLE,                      -- distance ahead: from the ego's front to the OV's front along the corridor; NULL: no OV {position}
    speed_mps DOUBLE,                 -- speed of the OV {velocity}
    on_its_way BOOLEAN,               -- the OV was still on another lane: da_m includes the distance that it drove to the corridor {position, heading, velocity}
    free_m DOUBLE NOT NULL,           -- how far ahead of the ego's front both the corridor and the sensor range reach {position, heading, size}
    free_reason VARCHAR NOT NULL,     -- [free_end] what limits free_m
    n_unplaced BIGINT NOT NULL,       -- number of other vehicles without a position on the road: one of them may be nearer than the OV {position}
    unplaced_reason VARCHAR           -- why one of these vehicles has no position, as JSON from the macro why
);

-- lifetime: part
CREATE TABLE velocity_bound (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR,                -- an actor whose recorded velocity is in doubt (doubt); NULL: the ego
    t_ns BIGINT NOT NULL,             -- the step
    least_mps DOUBLE,                 -- least speed that the actor can have there, by its velocities before and after the doubt; NULL: not known {velocity}
    most_mps DOUBLE                   -- greatest speed, likewise {velocity}
);

-- lifetime: part
CREATE TABLE lead (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR,                -- the nearest vehicle ahead in the running lane (without a map: in the strip that the ego's box sweeps). Not counted: a vehicle in passed_by; one that crosses the lane on its own path through a junction; one of the next lane that reaches over the line beside the ego's path without coming nearer to it; one beside the ego's box. No row: not known; to know that nobody is within N m, use vehicle_ahead.free_m; NULL: no vehicle
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    gap_m DOUBLE,                     -- distance from bumper to bumper along the corridor; negative: the two boxes overlap {position, heading, size}
    speed_mps DOUBLE,                 -- speed of the lead along the lane, in either direction {velocity}
    accel_mps2 DOUBLE,                -- acceleration of the lead, mean over the 0.5 s up to the step; NULL: not known {velocity}
    ego_speed_mps DOUBLE,             -- the ego's speed {velocity}
    in_lane BOOLEAN,                  -- part of the ego's box is in the running lane: the ego follows, and does not overtake beside the lead {position}
    oncoming BOOLEAN,                 -- the lead heads against the corridor {position, heading, velocity}
    across_m DOUBLE,                  -- gap between the two boxes across the corridor; negative: overlap {position, heading, size}
    ego_across_mps DOUBLE,            -- the ego's speed across the corridor, positive towards the lead {velocity}
    across_mps DOUBLE,                -- the lead's speed across the corridor, positive towards the ego {velocity}
    error_mps DOUBLE NOT NULL,        -- error bound of the speed difference: 0.25 m/s for each of the two speeds that was derived by a filter (quality velocity_filtered), else 0 {velocity}
    t_since_ns BIGINT,                -- first step of the unbroken stretch in which this vehicle has been the lead {position}
    joined BOOLEAN                    -- the stretch began with a lane change of the ego or the lead, or when a vehicle beside the ego got ahead; false: the lead was ahead in the lane before (further away, or behind another vehicle), or the log begins there {position}
);

-- lifetime: part
CREATE TABLE passed_by (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- a vehicle ahead that is in the running lane by the map, but that the ego's path passes at a distance of 0.2 m or more. It stands clear of the middle of the lane, or the lane is too narrow for both. Vehicles are excluded round which the ego swerves in the last 2 s, or for which it leaves its lane
    is_sure BOOLEAN NOT NULL          -- false: the positions were measured by sensors, and the path overlaps the vehicle by less than their accuracy, or passes it by less than 0.2 m
);

-- lifetime: part
CREATE TABLE lane_ahead (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- an actor ahead that is in the running lane and not in passed_by, or that reaches into the lane and is in the ego's way or heading into it; no pedestrian or animal, and an object only if it is in the way; see lead
    actor_class VARCHAR,              -- [actor_class] see road_user; NULL also, without a map, if it is not known whether the actor is in the ego's way {class}
    gap_m DOUBLE,                     -- distance from bumper to bumper along the corridor; negative: the two boxes overlap {position, heading, size}
    speed_mps DOUBLE,                 -- speed of the actor {velocity}
    oncoming BOOLEAN,                 -- the actor heads against the corridor {position, heading, velocity}
    across_m DOUBLE,                  -- gap between the two boxes across the corridor; negative: overlap, the actor is in the ego's way {position, heading, size}
    ego_across_mps DOUBLE,            -- the ego's speed across the corridor, positive towards the actor {velocity}
    across_mps DOUBLE,                -- the actor's speed across the corridor, positive towards the ego {velocity}
    soon BOOLEAN,                     -- the actor is in the ego's way, or will be within 3 s at the present speeds across the corridor {position, heading, velocity}
    outside BOOLEAN                   -- no part of the actor is in the running lane: it is beside the lane, faces the ego and is in the ego's way {position}
);

-- lifetime: part
CREATE TABLE vehicle_ahead (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; no row: it is not known which vehicle is ahead
    object_id VARCHAR,                -- the nearest vehicle ahead in the running lane (lead), and vehicles that the lead may hide: the nearest in the ego's way, a nearer one that is heading into it, and the nearest that comes towards the ego, in the running lane or beside it in the ego's way; NULL: no vehicle, or see known
    nearest BOOLEAN NOT NULL,         -- this vehicle is the lead, or there is none {position}
    known BOOLEAN NOT NULL,           -- false: no vehicle is seen, or the lead is beside the ego's way, and beyond free_m an actor without a position or class may be in the way {position}
    gap_m DOUBLE,                     -- see lead {position, heading, size}
    speed_mps DOUBLE,                 -- speed of the vehicle along the lane, in either direction {velocity}
    accel_mps2 DOUBLE,                -- acceleration of the vehicle, mean over the 0.5 s up to the step; NULL: not known {velocity}
    ego_speed_mps DOUBLE,             -- the ego's speed {velocity}
    in_lane BOOLEAN,                  -- part of the ego's box is in the running lane {position}
    oncoming BOOLEAN,                 -- the vehicle heads against the corridor {position, heading, velocity}
    across_m DOUBLE,                  -- gap between the two boxes across the corridor; negative: overlap {position, heading, size}
    ego_across_mps DOUBLE,            -- the ego's speed across the corridor, positive towards the vehicle {velocity}
    across_mps DOUBLE,                -- the vehicle's speed across the corridor, positive towards the ego {velocity}
    error_mps DOUBLE NOT NULL,        -- see lead {velocity}
    closing_more_mps DOUBLE NOT NULL, -- by how much faster the two may come nearer than at the recorded speeds, where a velocity is in doubt; infinite: no bound; 0: no doubt {velocity}
    closing_less_mps DOUBLE NOT NULL, -- by how much slower, likewise {velocity}
    joined_ns BIGINT,                 -- of the lead: the time since which it is the lead, if it or the ego changed lanes then. Of another vehicle: the later of its last cut-in and the ego's last lane change; NULL: it was ahead before, or its arrival was not seen {position}
    let_in_ns BIGINT,                 -- joined_ns, if the ego did not change lanes; of a vehicle other than the lead: its last cut-in {position}
    passes_by BOOLEAN,                -- at the present velocities, the two boxes pass each other without contact: where lanes turn or cross, a vehicle ahead along the lane may be out of the way; NULL: the meeting is more than 3 s away, or not known {position}
    grazes BOOLEAN,                   -- it is not known whether the boxes pass without contact: they miss each other by less than the uncertainty of velocities and lane, or overlap by less than that of the headings {position, heading, size}
    free_m DOUBLE,                    -- where known is false: no actor is nearer to the ego's front in its lane than this distance {position, heading, size}
    free_mps DOUBLE                   -- where known is false: upper bound of the speed at which an actor comes nearer: the ego's speed, plus 70 mph unless the actor drives in the ego's direction {velocity}
);

-- ---- the overtake (paper, Appendix A)

-- lifetime: run
CREATE TABLE profile (
    profile VARCHAR NOT NULL,         -- [profile_name] the profile, also one of a user
    style INTEGER NOT NULL,           -- rank of aggressiveness, 0 = least aggressive
    pull_out_angle_rad DOUBLE,        -- beta, the angle of pulling out; NULL: the profile observed
    cut_in_angle_rad DOUBLE,          -- theta, the angle of cutting in; NULL: the profile observed
    pull_out_headroom_m DOUBLE,       -- distance from the ego's front to the VBP's rear (VBP: vehicle being passed) when pulling out starts
    cut_in_clearance_m DOUBLE,        -- distance from the VBP's front to the ego's rear when cutting in starts
    v_min_mps DOUBLE,                 -- lowest speed for which the profile is meant
    v_max_mps DOUBLE,                 -- highest speed for which the profile is meant
    selected BOOLEAN NOT NULL         -- the user selected it for this run
);

-- lifetime: part
CREATE TABLE excursion (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- the running chain that the ego leaves
    side INTEGER NOT NULL,            -- 1: over the left boundary, -1: over the right one {position}
    overtaking BOOLEAN,               -- this is the overtaking side; NULL: handedness unknown {position}
    t0_ns BIGINT NOT NULL,            -- first step with a corner more than 0.05 m over the boundary {position}
    begin_seen BOOLEAN NOT NULL,      -- the step before t0_ns exists, and the ego is inside the lane there {position}
    t_end_ns BIGINT NOT NULL,         -- last step over the boundary {position}
    t_back_ns BIGINT,                 -- the step after t_end_ns, wholly inside again; NULL: the log, a hole or the corridor ends first {position}
    t_over_ns BIGINT,                 -- first step with the whole box over the boundary; NULL: never {position, heading, size}
    t_out_ns BIGINT NOT NULL,         -- t_over_ns; if the box is never wholly over: the first step within 0.1 m of the greatest excursion {position}
    t_turn_ns BIGINT,                 -- last step after t_out_ns before the lateral speed finally changes its sign; NULL: never {position}
    t_return_ns BIGINT,               -- first step after t_turn_ns with a corner over the line again; NULL: never {position}
    max_out_m DOUBLE NOT NULL,        -- greatest distance of a corner beyond the boundary {position, heading, size}
    centre_over BOOLEAN NOT NULL,     -- the centre crossed the boundary too: an intended manoeuvre {position}
    lane_width_m DOUBLE NOT NULL,     -- width of the running lane at t0_ns
    over_width_m DOUBLE,              -- width of the lane beside it on the overtaking side at t0_ns; NULL: no such lane
    over_against BOOLEAN              -- that lane is driven in the opposite direction {position, heading, size}
);

-- lifetime: part
CREATE TABLE overtake (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the overtake, from 0, in time order; each vehicle passed in one excursion has its own row
    chain_id INTEGER NOT NULL,        -- the running chain
    opposing BOOLEAN,                 -- the overtaking lane is driven in the opposite direction; NULL: no lane beside, or unknown {position}
    side INTEGER NOT NULL,            -- the overtaking side: 1 left, -1 right {position}
    vbp_id VARCHAR NOT NULL,          -- VBP: the vehicle being passed, or one that may be it {position}
    vbp_placed BOOLEAN NOT NULL,      -- the VBP's position was known at t0; false: only its presence is known {position}
    sure BOOLEAN NOT NULL,            -- it certainly is an overtake, as two of three hold: the VBP's position was known at t0; the ego passed the VBP; the ego's centre crossed the line, or the ego was astride of it for 3 s; and the ego does not turn in at a junction. False: it may be one {position}
    begin_seen BOOLEAN NOT NULL,      -- t0 is certain: the step before t0 exists, and the ego is inside the lane there; false if t0 may lie in a turn at a junction, or if the ego may have begun later (t_begun_ns) {position}
    t0_ns BIGINT NOT NULL,            -- first step with a corner more than 0.05 m over the boundary or, if the ego stayed over it before it was level with the VBP: the last step at which it gained less than 0.1 m in a second and after which its centre gained 0.3 m {position}
    t_begun_ns BIGINT NOT NULL,       -- step at which the overtake certainly has begun: t0_ns or, if the centre then stayed and gained 0.1 to 0.3 m, the last step of this stay {position}
    t1_ns BIGINT,                     -- first step wholly in the overtaking lane {position}
    t_out_ns BIGINT NOT NULL,         -- end of pulling out: t1; in an overtake astride the line, the first step within 0.1 m of the furthest place of the centre before the ego is level with the VBP {position}
    t2_ns BIGINT,                     -- step at which the lateral speed changes its sign, see t_turn_ns of excursion {position}
    t3_ns BIGINT,                     -- first step wholly back in the running lane {position}
    t_end_ns BIGINT NOT NULL,         -- t3_ns, or the last step of the excursion {position}
    passed BOOLEAN NOT NULL,          -- the ego's front got ahead of the VBP's front {position}
    status VARCHAR NOT NULL,          -- [overtake_status] {position}
    v_av_mps DOUBLE,                  -- speed of the ego (AV: automated vehicle) at t0 {velocity}
    v_vbp_mps DOUBLE,                 -- speed of the VBP (vehicle being passed) at t0 {velocity}
    l_av_m DOUBLE,                    -- length of the ego, with its trailer {size}
    l_vbp_m DOUBLE,                   -- length of the VBP (vehicle being passed) {size}
    lane_width_m DOUBLE,              -- width of the running lane at t0 (w_L of Harper et al. 2021)
    vbp_gap_m DOUBLE,                 -- distance from the ego's front to the VBP's rear at t0, along the corridor; negative: the VBP is beside the ego {position, heading, size}
    span_m DOUBLE,                    -- from the rear of the first vehicle passed in this excursion to the front of this VBP, at t0; the VBP's length if it is the only one {position}
    t2_gap_m DOUBLE,                  -- distance from the VBP's front to the ego's rear at t2 {position, heading, size}
    t3_gap_m DOUBLE,                  -- distance from the VBP's front to the ego's rear at t3 {position, heading, size}
    v_vbp_t3_mps DOUBLE,              -- speed of the VBP (vehicle being passed) at t3 {velocity}
    ov_id VARCHAR,                    -- the oncoming vehicle (OV) at t0, see oncoming {position}
    da_m DOUBLE,                      -- distance ahead at t0: to the OV, or without an OV the free distance {position}
    v_ov_mps DOUBLE,                  -- OV's speed at t0; without an OV, the speed limit {velocity}
    n_unplaced BIGINT,                -- see oncoming, at t0; NULL: the ego's position is not known {position}
    unplaced_reason VARCHAR,          -- see oncoming
    free_reason VARCHAR,              -- [free_end] see oncoming
    pull_out_angle_rad DOUBLE,        -- observed: atan of lateral over longitudinal distance from t0 to t_out {heading}
    cut_in_angle_rad DOUBLE           -- observed: atan of lateral over longitudinal distance from t2 to t3 {heading}
);

-- lifetime: part
CREATE TABLE overtake_sda (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- see overtake
    profile VARCHAR NOT NULL,         -- [profile_name] see profile; selected or not
    t0_ns BIGINT NOT NULL,            -- see overtake {position}
    ov_id VARCHAR,                    -- of the oncoming vehicles at t0 (see oncoming_vehicle), the one that leaves the least spare distance; NULL: none {position}
    da_m DOUBLE,                      -- distance ahead to the OV; NULL: unknown; or more than sda_m, while another OV cannot be excluded; or too little at the ego's speed at t0, but enough at its mean speed (or at the speed reached at the end of the log) {position}
    at_least BOOLEAN NOT NULL,        -- da_m is only a lower bound: no OV is seen within this free distance {position}
    nobody BOOLEAN NOT NULL,          -- the positions of all vehicles are known, and there is no OV within da_m {position}
    sda_m DOUBLE,                     -- safe distance ahead, at the ego's speed at t0. Profile observed: at the ego's mean speed, if completed; at least the distance that ego and OV covered during the overtake plus the OV's stopping distance, if da_m is no more than that; NULL: undefined {position, heading, velocity, size}
    spare_m DOUBLE,                   -- spare distance: da_m minus sda_m {position, heading, velocity, size}
    spare_s DOUBLE,                   -- time in which spare_m closes at the speed v_AV + v_OV {position, heading, velocity, size}
    zone VARCHAR,                     -- [zone] NULL: unknown {position, heading, velocity, size}
    reason VARCHAR,                   -- why sda_m or da_m is NULL, or a remark on them, as JSON from the macro why
    pull_out_m DOUBLE,                -- part of sda_m: the distance that the ego drives to pull out; NULL: sda_m is the distance covered (covered_m), or undefined {position, heading, velocity, size}
    passing_m DOUBLE,                 -- part of sda_m: the distance that the ego drives beside the VBP; NULL: as pull_out_m {position, heading, velocity, size}
    cut_in_m DOUBLE,                  -- part of sda_m: the distance that the ego drives to cut in; NULL: as pull_out_m {position, heading, velocity, size}
    oncoming_m DOUBLE,                -- part of sda_m: the distance that the OV drives during the overtake; NULL: as pull_out_m {position, heading, velocity, size}
    covered_m DOUBLE,                 -- part of sda_m: the distance that the ego and the OV covered during the overtake, until both stand; NULL: sda_m is from the formula, or undefined {position, heading, velocity, size}
    stopping_m DOUBLE                 -- part of sda_m: the OV's stopping distance; NULL: undefined {position, heading, velocity, size}
);

-- lifetime: part
CREATE TABLE overtake_step (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- see overtake
    t_ns BIGINT NOT NULL,             -- a step from t0 to t_end
    stage VARCHAR NOT NULL,           -- [overtake_stage] {position}
    vbp_id VARCHAR NOT NULL,          -- the vehicle being passed (VBP) {position}
    sure BOOLEAN NOT NULL,            -- see overtake {position}
    ov_id VARCHAR,                    -- of the oncoming vehicles (OV) at this step, the one whose danger space reaches furthest into the ego's, see oncoming_vehicle; NULL: none {position}
    ov_known BOOLEAN NOT NULL,        -- the positions of all vehicles are known: no other vehicle may be oncoming {position}
    ov_reason VARCHAR,                -- why ov_known is false, and what to provide, as JSON from the macro why; filled also where ov_known is true
    sd_av_m DOUBLE,                   -- stopping distance of the ego (AV): the length of its danger space {position, heading, velocity, size}
    ds_av_s_m DOUBLE,                 -- chain station at which the ego's danger space begins: the middle of the front bumper {position, heading, velocity, size}
    ds_av_d_m DOUBLE,                 -- lateral offset of the middle of the ego's danger space: that of the front bumper's middle, left positive {position, heading, velocity, size}
    ds_av_half_m DOUBLE,              -- half the width of the ego's danger space: half the vehicle's width {position, heading, velocity, size}
    sd_ov_m DOUBLE,                   -- stopping distance of the OV: the length of its danger space {position, heading, velocity, size}
    ds_ov_s_m DOUBLE,                 -- chain station at which the OV's danger space begins; it extends against the corridor {position, heading, velocity, size}
    ds_ov_d_m DOUBLE,                 -- lateral offset of the middle of the OV's danger space {position, heading, velocity, size}
    ds_ov_half_m DOUBLE,              -- half the width of the OV's danger space {position, heading, velocity, size}
    vbp_in_ds_av_m DOUBLE,            -- how far the VBP is inside the ego's danger space, in corridor coordinates; negative: distance from it {position, heading, velocity, size}
    ov_in_ds_av_m DOUBLE,             -- how far an OV is inside the ego's danger space, the most of all OVs; NULL: not known for one OV, and no other is inside {position, heading, velocity, size}
    av_in_ds_ov_m DOUBLE,             -- how far the ego is inside an OV's danger space, as ov_in_ds_av_m {position, heading, velocity, size}
    ds_overlap_m DOUBLE               -- how far the ego's and an OV's danger spaces overlap, as ov_in_ds_av_m {position, heading, velocity, size}
);

-- lifetime: part
CREATE TABLE opportunity (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the opportunity, from 0, in time order
    object_id VARCHAR NOT NULL,       -- the slower vehicle ahead, which holds up the ego
    profile VARCHAR NOT NULL,         -- [profile_name] see profile (not observed)
    t_start_ns BIGINT NOT NULL,       -- first step at which the ego is held up {position}
    t_end_ns BIGINT NOT NULL,         -- last step at which the ego is held up {position}
    t_best_ns BIGINT,                 -- the step with the most spare distance; NULL: never known {position}
    da_m DOUBLE,                      -- distance ahead at t_best_ns, or the free distance; NULL: unknown {position}
    sda_m DOUBLE,                     -- safe distance ahead at t_best_ns {position, heading, velocity, size}
    spare_s DOUBLE,                   -- time in which the spare distance (da_m minus sda_m) closes {position, heading, velocity, size}
    zone VARCHAR,                     -- [zone] at t_best_ns; NULL: unknown {position, heading, velocity, size}
    taken BOOLEAN NOT NULL            -- an overtake of this vehicle began in this time {position}
);

-- ---- crossing boundaries, signalling, exits

-- lifetime: part
CREATE TABLE lane_departure (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the departure, from 0, in time order
    t_ns BIGINT NOT NULL,             -- first step with a corner more than 0.05 m over a boundary, in a manoeuvre: the centre crossed too, or a vehicle was overtaken; for the way back, see t_return_ns and t_back_ns of excursion
    begin_seen BOOLEAN NOT NULL,      -- see excursion {position}
    side VARCHAR NOT NULL,            -- [side] the side of the boundary {position}
    back BOOLEAN NOT NULL             -- the departure is the way back of an excursion: the ego crosses the boundary towards the running lane {position}
);

-- lifetime: part
CREATE TABLE indicator_on (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the stretch with an indicator on, from 0, in time order
    side VARCHAR NOT NULL,            -- [side]
    t_on_ns BIGINT NOT NULL,          -- first step with the indicator on; at the step before, it was off or on the other side
    t_off_ns BIGINT NOT NULL,         -- last step with the indicator on
    at_log_start BOOLEAN NOT NULL     -- the indicator was on when the log began: t_on_ns is not its start
);

-- lifetime: map
CREATE TABLE exit_lane (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a lanelet of a lane that leaves the main carriageway
    from_id VARCHAR,                  -- the through lanelet beside the exit lane; NULL: the exit branches off without one
    side VARCHAR NOT NULL             -- [side] the side on which the exit lane leaves
);

-- lifetime: part
CREATE TABLE exit_taken (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the exit, from 0, in time order
    t_ns BIGINT NOT NULL,             -- first step with a corner more than 0.05 m over the exit lane's boundary
    side VARCHAR NOT NULL,            -- [side] {position}
    lanelet_id VARCHAR NOT NULL,      -- the exit lanelet
    t_sign_ns BIGINT,                 -- first step at or past the last exit sign before the exit; NULL: passed before the log began {position}
    sign_id VARCHAR                   -- that sign; NULL: the map has none on the ego's path
);

-- lifetime: part
CREATE TABLE exit_passed (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the exit, from 0, in time order
    lanelet_id VARCHAR NOT NULL,      -- the exit lanelet beside the ego's lane
    side VARCHAR NOT NULL,            -- [side] {position}
    t_near_ns BIGINT NOT NULL,        -- first step with the ego beside the exit lanelet, or on it {position}
    t_gore_ns BIGINT,                 -- first step past the end of the exit lanelet, where the choice is final; NULL: the log ends before {position}
    taken BOOLEAN                     -- the ego was in the exit lane at its end; NULL: end not reached {position}
);

-- lifetime: run
CREATE TABLE exposure (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    km DOUBLE NOT NULL,               -- distance driven, in kilometres
    hours DOUBLE NOT NULL,            -- duration, without holes and without the time in which the ego is absent
    engaged_km DOUBLE NOT NULL,       -- distance driven up to the steps at which the automated driver drives (see ego_condition)
    engaged_hours DOUBLE NOT NULL,    -- duration up to these steps
    n_steps BIGINT NOT NULL           -- number of ego steps
);

-- lifetime: run
CREATE TABLE recorded (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- an actor of the log
    t_from_ns BIGINT NOT NULL,        -- start of a stretch in which the actor's position is known, without a hole or lost time
    t_to_ns BIGINT NOT NULL           -- end of the stretch
);
