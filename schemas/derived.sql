-- The library: what queries/derive/<table>.sql fills. Keyed by (drive_id, ego_id) unless it is a property of the map or of any actor.
-- What is present but cannot be placed is a row with NULL, never an absent row.

-- ---- the map, prepared once per environment

-- lifetime: map
CREATE TABLE lane_segment (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    k INTEGER NOT NULL,               -- segment from point k to k + 1
    s0_m DOUBLE NOT NULL,             -- lanelet station of its start
    len_m DOUBLE NOT NULL,            -- its length along the centre line
    x0_m DOUBLE NOT NULL,             -- start
    y0_m DOUBLE NOT NULL,             -- start
    tx0 DOUBLE NOT NULL,              -- unit tangent at the start
    ty0 DOUBLE NOT NULL,              -- unit tangent at the start
    hw0_m DOUBLE NOT NULL,            -- half width at the start
    x1_m DOUBLE NOT NULL,             -- end
    y1_m DOUBLE NOT NULL,             -- end
    tx1 DOUBLE NOT NULL,              -- unit tangent at the end
    ty1 DOUBLE NOT NULL,              -- unit tangent at the end
    hw1_m DOUBLE NOT NULL,            -- half width at the end
    slack0_m DOUBLE NOT NULL,         -- how far it reaches beyond its start: 0.05 at the lanelet's ends, where tangents may differ by a hair
    slack1_m DOUBLE NOT NULL          -- how far it reaches beyond its end
);

-- lifetime: map
CREATE TABLE lane_near (
    environment_id VARCHAR NOT NULL,  -- the map
    from_id VARCHAR NOT NULL,         -- a drivable lanelet
    to_id VARCHAR NOT NULL,           -- itself, or one that continues it within three links
    hops INTEGER NOT NULL             -- least number of links, 0 to 3
);

-- lifetime: map
CREATE TABLE lane_next (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet
    ahead_id VARCHAR,                 -- the one that continues it straightest; NULL: none does
    behind_id VARCHAR,                -- the one that it continues straightest; NULL: it continues none
    map_ends BOOLEAN NOT NULL,        -- nothing continues it, nor any lane beside it that is driven the same way: what comes there is not in the map
    map_begins BOOLEAN NOT NULL       -- it continues none, nor does any lane beside it that is driven the same way
);

-- lifetime: map
CREATE TABLE lane_apart (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet
    other_id VARCHAR NOT NULL         -- one of another road that lies over or under it, as far as the map tells: no junction, link or common end joins the two (but decks may begin and end together), and their heights there differ by more than 2.5 m or are not known; each pair both ways round
);

-- lifetime: map
CREATE TABLE lane_beside (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet
    side VARCHAR NOT NULL,            -- [side]
    s_start_m DOUBLE NOT NULL,        -- from here, along the lanelet's centre line; no row: nothing lies beyond that boundary in the map
    s_end_m DOUBLE NOT NULL,          -- to here
    beside_id VARCHAR NOT NULL,       -- the lanelet beyond that boundary: as the map names it, else the drivable one that runs along it, at most 2 m away, of whatever road; the opposing lane behind a narrow strip
    against BOOLEAN NOT NULL,         -- that one is driven the other way
    gap_m DOUBLE NOT NULL,            -- from the boundary to its nearer bound; 0: the map names it
    strip VARCHAR,                    -- [lane_strip] NULL: nothing
    drivable BOOLEAN NOT NULL,        -- see lanelet
    lane_type VARCHAR NOT NULL,       -- [lane_type] see lanelet
    width_m DOUBLE NOT NULL           -- its width
);

-- lifetime: map
CREATE TABLE road_half (
    environment_id VARCHAR NOT NULL,  -- the map
    road_id VARCHAR NOT NULL,         -- a road of one direction
    of_road_id VARCHAR NOT NULL,      -- the road of the other direction beside it, before it by its id: the two are one road for a driver
    turned BOOLEAN NOT NULL           -- their reference lines run in opposite directions: what one begins with the other ends with
);

-- lifetime: map
CREATE TABLE junction_area (
    environment_id VARCHAR NOT NULL,  -- the map
    junction_id VARCHAR NOT NULL,     -- see lanelet
    geom GEOMETRY                     -- the ground of its drivable lanelets
);

-- lifetime: map
CREATE TABLE road_surface (
    environment_id VARCHAR NOT NULL,  -- the map
    road_id VARCHAR NOT NULL,         -- see lanelet
    geom GEOMETRY                     -- its carriageway: the ground of its drivable lanelets, and of those kept free or used beside them (shoulder, stop, border, parking, restricted, biking)
);

-- lifetime: map
CREATE TABLE strip_cell (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet
    k INTEGER NOT NULL,               -- the segment
    cell BIGINT NOT NULL              -- 4 m grid cell that the strip of 15 m on both sides of it may touch
);

-- lifetime: map
CREATE TABLE lane_cell (
    environment_id VARCHAR NOT NULL,  -- the map
    cell BIGINT NOT NULL,             -- 2 m grid cell that the segment's lane area may touch
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    drivable BOOLEAN NOT NULL,        -- see lanelet
    footway BOOLEAN,                  -- for people on foot only; NULL: what the lane is for is not known
    k INTEGER NOT NULL,               -- the segment
    s0_m DOUBLE NOT NULL,             -- lanelet station of the segment's start
    len_m DOUBLE NOT NULL,            -- its length along the centre line
    x0_m DOUBLE NOT NULL,             -- start
    y0_m DOUBLE NOT NULL,             -- start
    tx0 DOUBLE NOT NULL,              -- unit tangent at the start
    ty0 DOUBLE NOT NULL,              -- unit tangent at the start
    hw0_m DOUBLE NOT NULL,            -- half width of the lane at the start
    x1_m DOUBLE NOT NULL,             -- end
    y1_m DOUBLE NOT NULL,             -- end
    tx1 DOUBLE NOT NULL,              -- unit tangent at the end
    ty1 DOUBLE NOT NULL,              -- unit tangent at the end
    hw1_m DOUBLE NOT NULL,            -- half width of the lane at the end
    slack0_m DOUBLE NOT NULL,         -- see lane_segment
    slack1_m DOUBLE NOT NULL          -- see lane_segment
);

-- ---- time, and what the drive can tell

-- lifetime: part
CREATE TABLE ego_clock (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- an ego of the drive, whether it is judged now or in another part of the run
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
    object_id VARCHAR NOT NULL,       -- an actor that is the ego itself, and no other road user
    part VARCHAR NOT NULL             -- [part_of_ego]
);

-- lifetime: part
CREATE TABLE ego_actor (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    actor_id VARCHAR NOT NULL         -- the ego, or a trailer that it draws: boxes that are the ego's at one time
);

-- lifetime: part
CREATE TABLE lost_time (
    drive_id VARCHAR NOT NULL,        -- the drive
    t_from_ns BIGINT NOT NULL,        -- the log has lost something of what was recorded after this moment
    t_to_ns BIGINT NOT NULL           -- and before this one; the two are far away if the log's beginning or end is lost
);

-- lifetime: part
CREATE TABLE step (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a sample of the ego
    k INTEGER NOT NULL,               -- 0.. in time order
    dt_ns BIGINT,                     -- time since the previous step; NULL: the first
    seg INTEGER NOT NULL,             -- 0.., one more after each hole longer than max_gap_ns, and after each lost time
    travel_m DOUBLE NOT NULL          -- way made since the first step, between the positions that are known
);

-- lifetime: run
CREATE TABLE capability (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    signal VARCHAR NOT NULL,          -- [signal] what a rule may require
    available BOOLEAN NOT NULL,       -- the log and map give it
    reason VARCHAR NOT NULL           -- why the signal is available or missing, as JSON from the macro why
);

-- lifetime: run
CREATE TABLE registration (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    n_steps BIGINT NOT NULL,          -- ego steps with a position
    n_on_lane BIGINT NOT NULL,        -- of them, centre on a drivable lane, or on a shoulder, lay-by, border, parking, restricted or cycle lane
    n_moving BIGINT NOT NULL,         -- of those on a lane, with a heading, moving faster than 1 m/s, and not overtaking in an opposing lane
    n_with_direction BIGINT NOT NULL, -- of the moving ones, heading within 90 degrees of the lane's direction, or on a lane that is driven both ways
    lateral_median_m DOUBLE,          -- median distance from the centre line of the lane, beside an overtake in the opposing lane where that is enough; NULL: never on a lane
    is_aside BOOLEAN NOT NULL,        -- that median is so great, in steps that tell, that the map may be moved against the log
    ok BOOLEAN NOT NULL,              -- good enough for rules that need the map: the ego fits; or it is against its lane and three of four other vehicles are with theirs; or it keeps to the middle of a lane (within 0.6 m for 5 s and 50 m, or within 0.3 m for 2 s and 20 m) before and after it is anywhere else, on a road that runs as that one does or on two that cross
    reason VARCHAR NOT NULL           -- why ok is true or false, as JSON from the macro why
);

-- ---- where everybody is

-- lifetime: part
CREATE TABLE road_user (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor
    actor_class VARCHAR,              -- [actor_class] as far as it is known: the recorded one; vehicle also for one without a class that is longer than 3 m; object only for a thing that stays within 1 m in the whole log; NULL: it may be anything {class}
    length_m DOUBLE,                  -- box {size}
    width_m DOUBLE                    -- box {size}
);

-- lifetime: part
CREATE TABLE state_dynamics (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor
    t_ns BIGINT NOT NULL,             -- time stamp
    x_m DOUBLE,                       -- box centre {position}
    y_m DOUBLE,                       -- box centre {position}
    z_m DOUBLE,                       -- box centre, up; NULL: not recorded, or the same all the while as in a flat simulation {position}
    yaw_rad DOUBLE,                   -- heading {heading}
    travel_rad DOUBLE,                -- direction of travel: of the motion where it moves (a vehicle: its heading, or the opposite one where it reverses), else the heading {heading}
    vx_mps DOUBLE,                    -- velocity east {velocity}
    vy_mps DOUBLE,                    -- velocity north {velocity}
    speed_mps DOUBLE,                 -- length of the velocity vector {velocity}
    accel_mps2 DOUBLE,                -- backward difference of speed at the log's own rate, unfiltered; NULL: first sample, after a hole, or its velocity is derived by a filter (quality velocity_filtered) {velocity}
    length_m DOUBLE,                  -- box {size}
    width_m DOUBLE,                   -- box {size}
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    indicator VARCHAR                 -- [indicator] see actor_state
);

-- lifetime: part
CREATE TABLE lane_occupancy (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- the actor
    t_ns BIGINT NOT NULL,             -- time stamp
    lanelet_id VARCHAR,               -- a lanelet that contains the box centre, one row each; NULL: on none, or no position
    s_m DOUBLE,                       -- station of the centre along it {position}
    d_m DOUBLE,                       -- offset from its centre line, left of travel positive {position}
    half_width_m DOUBLE,              -- half its width there
    heading_diff_rad DOUBLE,          -- actor's heading against the lane's direction, -pi..pi {heading}
    drivable BOOLEAN                  -- see lanelet {position}
);

-- lifetime: part
CREATE TABLE ego_lane (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    lanelet_id VARCHAR,               -- the drivable lanelet it is on, one per step; in junctions the one that its way leads through; NULL: none
    s_m DOUBLE,                       -- station along it {position}
    d_m DOUBLE,                       -- offset from its centre line, left of travel positive {position}
    half_width_m DOUBLE,              -- half its width there
    with_direction BOOLEAN,           -- heading within 90 degrees of the lane's direction {heading}
    with_traffic BOOLEAN              -- with_direction, or the lane is driven both ways {position}
);

-- lifetime: part
CREATE TABLE ego_aside (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which it is on no drivable lane, but on a way beside one
    lanelet_id VARCHAR NOT NULL,      -- the nearest such way: a shoulder, border, parking or cycle lane
    lane_type VARCHAR NOT NULL,       -- [lane_type] see lanelet
    road_type VARCHAR,                -- [road_type] see lanelet
    off_m DOUBLE NOT NULL,            -- distance from its centre line {position}
    with_direction BOOLEAN            -- heading within 90 degrees of its direction; NULL: heading not known {heading}
);

-- lifetime: part
CREATE TABLE own_way (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    seg INTEGER NOT NULL,             -- see step: a hole begins a new piece
    k INTEGER NOT NULL,               -- 0.. along the piece
    t_from_ns BIGINT,                 -- when the ego's centre was at the start of the segment; NULL: beyond the end of what it drove
    s0_m DOUBLE NOT NULL,             -- way made from the beginning of the piece to the start of the segment {position}
    len_m DOUBLE NOT NULL,            -- its length {position}
    driven_m DOUBLE NOT NULL,         -- way made to the end of the piece: beyond it the ego is taken to hold its bend for 3 s at its last speed, for 25 m at least {position}
    x0_m DOUBLE NOT NULL,             -- start {position}
    y0_m DOUBLE NOT NULL,             -- start {position}
    tx0 DOUBLE NOT NULL,              -- unit tangent at the start {position}
    ty0 DOUBLE NOT NULL,              -- unit tangent at the start {position}
    x1_m DOUBLE NOT NULL,             -- end {position}
    y1_m DOUBLE NOT NULL,             -- end {position}
    tx1 DOUBLE NOT NULL,              -- unit tangent at the end {position}
    ty1 DOUBLE NOT NULL,              -- unit tangent at the end {position}
    bend_per_m DOUBLE NOT NULL        -- its bend, 1 / radius, to the left positive {position}
);

-- lifetime: part
CREATE TABLE chain (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- 0.. in time order; a new one with every change to another running lane
    seq INTEGER NOT NULL,             -- order along the chain, from its far end behind
    lanelet_id VARCHAR NOT NULL,      -- the lanelet; without a map a piece of own_way
    s_start_m DOUBLE NOT NULL,        -- chain station of its start; 0 = start of the first lanelet the ego was on
    length_m DOUBLE NOT NULL,         -- its length
    t_first_ns BIGINT,                -- the ego drove it with the traffic from this step; NULL: not driven, the way continued straight on, or the ego cut the corner beside it
    t_last_ns BIGINT                  -- to this one
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
    side INTEGER,                     -- overtaking side: 1 left (right-hand traffic), -1 right; NULL: handedness unknown {position}
    over_width_m DOUBLE,              -- width of the lane beside it on the overtaking side (see lane_beside), with the gap between the two, if it is there along more than half of the lanelet; through a junction, that of the lane before or after it; NULL: there is none
    over_against BOOLEAN              -- that lane is driven the other way {position, heading, size}
);

-- lifetime: part
CREATE TABLE visited_cell (
    drive_id VARCHAR NOT NULL,        -- the drive
    cell BIGINT NOT NULL              -- 4 m grid cell in which some actor's centre, or a corner of an ego, ever was
);

-- lifetime: part
CREATE TABLE corridor_cell (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    cell BIGINT NOT NULL,             -- 4 m grid cell that the strip beside the segment may touch, of those that anybody was in
    lanelet_id VARCHAR NOT NULL,      -- a lanelet of any of the ego's chains
    k INTEGER NOT NULL,               -- the segment
    s0_m DOUBLE NOT NULL,             -- lanelet station of the segment's start
    len_m DOUBLE NOT NULL,            -- its length along the centre line
    x0_m DOUBLE NOT NULL,             -- start
    y0_m DOUBLE NOT NULL,             -- start
    tx0 DOUBLE NOT NULL,              -- unit tangent at the start
    ty0 DOUBLE NOT NULL,              -- unit tangent at the start
    hw0_m DOUBLE NOT NULL,            -- half width of the lane at the start
    x1_m DOUBLE NOT NULL,             -- end
    y1_m DOUBLE NOT NULL,             -- end
    tx1 DOUBLE NOT NULL,              -- unit tangent at the end
    ty1 DOUBLE NOT NULL,              -- unit tangent at the end
    hw1_m DOUBLE NOT NULL,            -- half width of the lane at the end
    slack0_m DOUBLE NOT NULL,         -- see lane_segment
    slack1_m DOUBLE NOT NULL          -- see lane_segment
);

-- lifetime: part
CREATE TABLE ego_corridor (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- a running chain whose strip the ego is in
    t_ns BIGINT NOT NULL,             -- the step
    s_m DOUBLE NOT NULL,              -- chain station of the box centre {position}
    d_m DOUBLE NOT NULL,              -- offset of the centre from the running lane's centre line, left positive {position}
    left_out_m DOUBLE,                -- furthest corner beyond the running lane's left boundary; negative: all inside {position, heading, size}
    left_in_m DOUBLE,                 -- nearest corner beyond it; positive: wholly over it {position}
    right_out_m DOUBLE,               -- furthest corner beyond the right boundary {position, heading, size}
    right_in_m DOUBLE,                -- nearest corner beyond it {position}
    front_s_m DOUBLE,                 -- chain station of the foremost corner {position, heading, size}
    rear_s_m DOUBLE,                  -- chain station of the rearmost corner {position, heading, size}
    lat_half_m DOUBLE,                -- half the extent of the box across the corridor {heading, size}
    half_width_m DOUBLE NOT NULL,     -- half width of the running lane at the centre's station
    over_width_m DOUBLE,              -- see corridor
    over_against BOOLEAN,             -- see corridor {position, heading, size}
    side INTEGER,                     -- see corridor {position}
    heading_diff_rad DOUBLE           -- ego's heading against the corridor, -pi..pi {heading}
);

-- lifetime: part
CREATE TABLE ego_state (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    x_m DOUBLE,                       -- box centre {position}
    y_m DOUBLE,                       -- box centre {position}
    z_m DOUBLE,                       -- see state_dynamics {position}
    yaw_rad DOUBLE,                   -- heading {heading}
    speed_mps DOUBLE,                 -- speed {velocity}
    accel_mps2 DOUBLE,                -- see state_dynamics {velocity}
    fastest_3s_mps DOUBLE,            -- highest speed of this step and of those in the 3 s before it; NULL: they show an ego that stands, and not all of the 3 s is recorded {velocity}
    travel_m DOUBLE,                  -- way made since the first step {position}
    length_m DOUBLE,                  -- box {size}
    width_m DOUBLE,                   -- box {size}
    combination_m DOUBLE,             -- length with the trailer that it draws; NULL: the trailer is not placed {size}
    indicator VARCHAR,                -- [indicator] NULL: not known
    lanelet_id VARCHAR,               -- see ego_lane
    with_direction BOOLEAN,           -- see ego_lane {heading}
    with_traffic BOOLEAN,             -- see ego_lane {position}
    in_junction BOOLEAN,              -- on a junction's lanelet; NULL: on none {position}
    road_type VARCHAR,                -- [road_type] of the lanelet; NULL: the map does not state it
    limit_mps DOUBLE,                 -- speed limit where it is; NULL: see limit_source
    limit_source VARCHAR,             -- [limit_source + none] none: the map says that there is no limit; NULL: it does not say
    chain_id INTEGER,                 -- its running chain at this step; NULL: none
    s_m DOUBLE,                       -- chain station of the centre {position}
    d_m DOUBLE,                       -- offset from the running lane's centre line, left positive {position}
    front_s_m DOUBLE,                 -- chain station of the front bumper {position, heading, size}
    rear_s_m DOUBLE,                  -- chain station of the rear bumper, the trailer's if it draws one {position, heading, size}
    lat_half_m DOUBLE,                -- half the extent of the box across the corridor {heading, size}
    heading_diff_rad DOUBLE           -- heading against the corridor {heading}
);

-- lifetime: part
CREATE TABLE ego_footway (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    depth_m DOUBLE                    -- how far a corner or the middle of a side is inside a footway and on no carriageway; 0: not at all; NULL: the box is not known, or part of it is on nothing that the map knows {position, heading, size}
);

-- lifetime: part
CREATE TABLE pair (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the ego's step
    object_id VARCHAR NOT NULL,       -- an actor present, and no part of the ego: one row per step from its first to its last sample, but none where it is over or under the ego's road by the heights of the log
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    x_m DOUBLE,                       -- its box centre; NULL: present but not placed (no position, stale, a hole in its track, or off_level) {position}
    y_m DOUBLE,                       -- its box centre {position}
    yaw_rad DOUBLE,                   -- its heading; of a vehicle that reverses the opposite one: decided by its motion, see travel_rad of state_dynamics {heading}
    speed_mps DOUBLE,                 -- its speed {velocity}
    accel_mps2 DOUBLE,                -- see state_dynamics {velocity}
    length_m DOUBLE,                  -- box {size}
    width_m DOUBLE,                   -- box {size}
    distance_m DOUBLE,                -- centre to centre {position}
    off_level BOOLEAN NOT NULL,       -- over or under the ego's road there, or it may be: the map has another road there, or the heights of the log are not reliable; whoever is so by reliable heights has no row {position}
    clearance_m DOUBLE,               -- box to box, the trailer's box being the ego's too; negative: depth of overlap; beyond 30 m a lower bound, and off_level, where an overlap in plan is NULL {position, heading, size}
    clearance_is_bound BOOLEAN,       -- clearance_m is only a lower bound {position, heading, size}
    s_m DOUBLE,                       -- station of its centre on the ego's running chain; NULL: not in the corridor's strip {position}
    d_m DOUBLE,                       -- its offset from the running lane's centre line, left positive {position}
    front_s_m DOUBLE,                 -- its furthest station along the ego's direction {position, heading, size}
    rear_s_m DOUBLE,                  -- its nearest {position, heading, size}
    lat_half_m DOUBLE,                -- half the extent of its box across the corridor {heading, size}
    heading_diff_rad DOUBLE,          -- its heading against the corridor, -pi..pi {heading}
    half_width_m DOUBLE,              -- half width of the running lane at its station
    over_width_m DOUBLE,              -- see corridor
    over_against BOOLEAN              -- see corridor {position, heading, size}
);

-- lifetime: part
CREATE TABLE between_steps (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step; the boxes are apart at it and at the next, and may have touched between the two: they came nearer than at either
    t_next_ns BIGINT NOT NULL,        -- the next step, not beyond a hole {position}
    object_id VARCHAR NOT NULL,       -- the other actor
    least_m DOUBLE NOT NULL,          -- least clearance between the two steps, both moved along the cubic through place and velocity at both (the chord where the velocities contradict it); negative: depth of overlap {position, heading, size}
    blur_m DOUBLE NOT NULL            -- how far off that may be: nobody brakes or swerves by more than 8 m/s2; smaller than -least_m: contact for sure; smaller than least_m: none, and no row {position}
);

-- lifetime: part
CREATE TABLE clearance_least (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which the clearance in pair is not known
    object_id VARCHAR NOT NULL,       -- the other actor
    least_m DOUBLE NOT NULL           -- positive: it is no smaller, after where the two were seen before and where they are seen next {position, heading, size}
);

-- lifetime: part
CREATE TABLE lost_object (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- an actor whose track ends while it could still have been there
    t_from_ns BIGINT NOT NULL,        -- unknown from here {position}
    t_to_ns BIGINT NOT NULL,          -- to here: the log's end, or where data_log.in_sight holds and its track ended near the ego, when it would have been recorded again {position}
    code VARCHAR NOT NULL             -- [loss]
);

-- lifetime: part
CREATE TABLE track_off_level (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- an actor that pair has at some steps, but not at the last (or first) of its track: there it is over or under the ego's road
    lost BOOLEAN NOT NULL             -- at the end of its track, or at its beginning (false) {position}
);

-- lifetime: part
CREATE TABLE unplaced (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- a vehicle that may be on the road ahead and cannot be placed on it
    code VARCHAR NOT NULL             -- [unplaced_cause + lost + lost_behind + appeared + beyond_map] see unseen
);

-- lifetime: part
CREATE TABLE unseen (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which the log does not have the actor
    object_id VARCHAR NOT NULL,       -- an actor whose track ends before, or begins after, near enough to matter
    near BOOLEAN NOT NULL,            -- it was close by, in the sensor's range or coming towards the ego: it may be anywhere on the road {position}
    code VARCHAR NOT NULL,            -- [unseen_cause]
    ahead_m DOUBLE,                   -- it came in, or left, over the far end of the map, which is so far ahead of the ego's front; else NULL {position}
    behind_m DOUBLE,                  -- the same over the near end, so far behind the ego's rear {position}
    off_ahead_m DOUBLE,               -- it came in, or left, over an end of the map, be it on another road: it is not on the ego's corridor, which reaches so far ahead of the ego's front; else NULL {position}
    off_behind_m DOUBLE               -- and so far behind the ego's rear {position}
);

-- lifetime: part
CREATE TABLE oncoming_vehicle (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- who comes towards the ego on the lane that it would overtake in, a vehicle or an animal; one that was never seen to move does not
    vehicle BOOLEAN,                  -- NULL: its class is not known {class}
    da_m DOUBLE,                      -- along the corridor, the ego's front to its nearest corner; on its way: what it has yet to go as well {position}
    speed_mps DOUBLE,                 -- its speed {velocity}
    on_its_way BOOLEAN NOT NULL       -- it is not on the corridor yet and gets there within 15 s {position, heading, velocity}
);

-- lifetime: part
CREATE TABLE oncoming (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; no row: the ego itself is not placed
    object_id VARCHAR,                -- OV: the nearest oncoming vehicle on the overtaking chain or on its way to it; NULL: none seen
    da_m DOUBLE,                      -- distance ahead: ego front to OV front, along the corridor; NULL: no OV {position}
    speed_mps DOUBLE,                 -- its speed {velocity}
    on_its_way BOOLEAN,               -- it was still on another lane: da_m is the way that it then made {position, heading, velocity}
    free_m DOUBLE NOT NULL,           -- how far ahead of the ego's front the corridor and the sensor reach {position, heading, size}
    free_reason VARCHAR NOT NULL,     -- [free_end]
    n_unplaced BIGINT NOT NULL,       -- other vehicles that cannot be placed: a nearer OV is not ruled out {position}
    unplaced_reason VARCHAR           -- why one of them has no place, as JSON from the macro why
);

-- lifetime: part
CREATE TABLE lead (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR,                -- nearest vehicle ahead in the running lane (without a map: in the strip that the ego's box sweeps on its own way), not one beside which that way passes (passed_by), nor one that moves across it by its own way through a junction, nor one of the next lane that reaches over the line beside the ego's way and does not come nearer to it, nor one beside the ego's box; NULL: nobody there; no row: not known; to know that nobody is within N m, use vehicle_ahead.free_m
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    gap_m DOUBLE,                     -- bumper to bumper along the corridor; negative: the two boxes overlap {position, heading, size}
    speed_mps DOUBLE,                 -- its speed along the lane, whichever way {velocity}
    accel_mps2 DOUBLE,                -- its acceleration, mean over the 0.5 s up to the step; NULL: not known {velocity}
    ego_speed_mps DOUBLE,             -- the ego's speed {velocity}
    in_lane BOOLEAN,                  -- some of the ego's box is in the running lane: it follows, and does not overtake beside it {position}
    oncoming BOOLEAN,                 -- it heads against the corridor {position, heading, velocity}
    across_m DOUBLE,                  -- gap between the two boxes across the corridor; negative: overlap {position, heading, size}
    ego_across_mps DOUBLE,            -- ego's speed across the corridor, towards it positive {velocity}
    across_mps DOUBLE,                -- its speed across the corridor, towards the ego positive {velocity}
    error_mps DOUBLE NOT NULL,        -- what the difference of the two speeds may be off by: 0.25 m/s for each that ingest derives by a filter (quality velocity_filtered), else 0 {velocity}
    t_since_ns BIGINT,                -- first step of the unbroken stretch in which it has been the nearest one {position}
    joined BOOLEAN                    -- the stretch began with one of the two changing lanes, or one beside coming ahead; false: it was ahead in the lane before (behind another, or further away), or the log begins there {position}
);

-- lifetime: part
CREATE TABLE passed_by (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- a vehicle ahead that the map puts into the running lane, and beside which the ego's own way passes by 0.2 m or more: it stands, and leaves the middle of the lane free, or the two have no room beside each other in one lane; not one that the ego swerves round in the last 2 s, nor one for whom it leaves its lane
    is_sure BOOLEAN NOT NULL          -- false: sensors measured the places, and the way meets the vehicle by less than they tell, or passes by less than 0.2 m
);

-- lifetime: part
CREATE TABLE lane_ahead (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- whoever is ahead in the running lane and not in passed_by, or reaches into it and is in the ego's way or heading into it; not on foot, no animal, and a thing only where it is in the way; see lead
    actor_class VARCHAR,              -- [actor_class] see road_user; NULL also, without a map, of one of whom it is not known whether it is in the ego's way {class}
    gap_m DOUBLE,                     -- bumper to bumper along the corridor; negative: the two boxes overlap {position, heading, size}
    speed_mps DOUBLE,                 -- its speed {velocity}
    oncoming BOOLEAN,                 -- it heads against the corridor {position, heading, velocity}
    across_m DOUBLE,                  -- gap between the two boxes across the corridor; negative: overlap, it is in the ego's way {position, heading, size}
    ego_across_mps DOUBLE,            -- ego's speed across the corridor, towards it positive {velocity}
    across_mps DOUBLE,                -- its speed across the corridor, towards the ego positive {velocity}
    soon BOOLEAN,                     -- it is in the ego's way, or will be within 3 s at the present speeds across {position, heading, velocity}
    outside BOOLEAN                   -- nothing of it is in the running lane: it is turned towards the ego, which is in its way beside the lane {position}
);

-- lifetime: part
CREATE TABLE vehicle_ahead (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; none: it cannot be told who is ahead
    object_id VARCHAR,                -- the nearest vehicle ahead in the running lane (lead), and those whom that may hide: the nearest one in the ego's way, one nearer that is heading into it, and the nearest that comes towards the ego, in the running lane or in the ego's way beside it; NULL: nobody there, or see known
    nearest BOOLEAN NOT NULL,         -- it is the lead, or there is none {position}
    known BOOLEAN NOT NULL,           -- false: nobody is seen, or the lead is beside the ego's way, and somebody without a place or of no known class may be in it: further away than free_m {position}
    gap_m DOUBLE,                     -- see lead {position, heading, size}
    speed_mps DOUBLE,                 -- its speed along the lane, whichever way {velocity}
    accel_mps2 DOUBLE,                -- its acceleration, mean over the 0.5 s up to the step; NULL: not known {velocity}
    ego_speed_mps DOUBLE,             -- the ego's speed {velocity}
    in_lane BOOLEAN,                  -- some of the ego's box is in the running lane {position}
    oncoming BOOLEAN,                 -- it heads against the corridor {position, heading, velocity}
    across_m DOUBLE,                  -- gap between the two boxes across the corridor; negative: overlap {position, heading, size}
    ego_across_mps DOUBLE,            -- ego's speed across the corridor, towards it positive {velocity}
    across_mps DOUBLE,                -- its speed across the corridor, towards the ego positive {velocity}
    error_mps DOUBLE NOT NULL,        -- see lead {velocity}
    joined_ns BIGINT,                 -- since when it is the lead, if one of the two then changed lanes; of another the last cut-in of it or lane change of the ego; NULL: it was ahead before, or how it came was not seen {position}
    let_in_ns BIGINT,                 -- joined_ns, where it was not the ego that changed lanes; of another than the lead its last cut-in {position}
    passes_by BOOLEAN,                -- at the present velocities the two boxes pass each other by: where lanes turn or cross, who is ahead along the lane is not in the way; NULL: it takes over 3 s, or is not known {position}
    grazes BOOLEAN,                   -- at the present velocities the boxes miss each other by less than those and the lane leave open, or meet by less than headings tell: whether they pass each other by is not known {position, heading, size}
    free_m DOUBLE,                    -- where not known: nobody is nearer to the ego's front in its lane than this {position, heading, size}
    free_mps DOUBLE                   -- where not known: nobody comes nearer faster than this: one that stands, or one that comes at 70 mph, unless it goes the ego's way {velocity}
);

-- ---- the overtake (paper, Appendix A)

-- lifetime: run
CREATE TABLE profile (
    profile VARCHAR NOT NULL,         -- [profile_name] or a user's own
    style INTEGER NOT NULL,           -- 0 = least aggressive
    pull_out_angle_rad DOUBLE,        -- beta; NULL for observed
    cut_in_angle_rad DOUBLE,          -- theta
    pull_out_headroom_m DOUBLE,       -- ego front to VBP rear when pulling out starts
    cut_in_clearance_m DOUBLE,        -- VBP front to ego rear when cutting in starts
    v_min_mps DOUBLE,                 -- speed range that it is meant for
    v_max_mps DOUBLE,                 -- speed range that it is meant for
    selected BOOLEAN NOT NULL         -- asked for in this run
);

-- lifetime: part
CREATE TABLE excursion (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- the running chain that is left
    side INTEGER NOT NULL,            -- 1 over the left boundary, -1 over the right {position}
    overtaking BOOLEAN,               -- that is the side to overtake on; NULL: handedness unknown {position}
    t0_ns BIGINT NOT NULL,            -- first step with a corner more than 0.05 m over the boundary {position}
    t_pull_ns BIGINT NOT NULL,        -- t0; where the ego stayed over the boundary with its centre in the lane first, the last step at which it gained less than 0.1 m in a second {position}
    begin_seen BOOLEAN NOT NULL,      -- the step before it is there and inside the lane {position}
    t_end_ns BIGINT NOT NULL,         -- last step over it {position}
    t_back_ns BIGINT,                 -- the step after that, wholly inside again; NULL: the log, a hole or the corridor ends first {position}
    t_over_ns BIGINT,                 -- first step wholly over; NULL: never {position, heading, size}
    t_out_ns BIGINT NOT NULL,         -- t_over; where it is never wholly over, the first step within 0.1 m of its furthest {position}
    t_turn_ns BIGINT,                 -- last step after t_out before the lateral speed turned back for good; NULL: never {position}
    t_return_ns BIGINT,               -- first step after that with a corner over the line again; NULL: never {position}
    max_out_m DOUBLE NOT NULL,        -- how far the furthest corner got {position, heading, size}
    centre_over BOOLEAN NOT NULL,     -- the centre crossed too: a manoeuvre, not a wobble {position}
    lane_width_m DOUBLE NOT NULL,     -- width of the running lane at t0
    over_width_m DOUBLE,              -- width of the lane beside it on the overtaking side at t0; NULL: none
    over_against BOOLEAN              -- that lane is driven the other way {position, heading, size}
);

-- lifetime: part
CREATE TABLE overtake (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order; each vehicle passed in one go is one more
    chain_id INTEGER NOT NULL,        -- the running chain
    opposing BOOLEAN,                 -- the overtaking lane is driven the other way; NULL: no lane beside, or unknown {position}
    side INTEGER NOT NULL,            -- 1 left, -1 right {position}
    vbp_id VARCHAR NOT NULL,          -- the vehicle being passed, or one that may be it {position}
    vbp_placed BOOLEAN NOT NULL,      -- it was placed at t0; else only its presence is known {position}
    sure BOOLEAN NOT NULL,            -- it is an overtake: two of the three hold, the VBP was placed at t0, the ego passed it, the ego's centre was over the line or the ego stayed astride of it for 3 s; else it may be one {position}
    begin_seen BOOLEAN NOT NULL,      -- t0 lies in the log: the step before it is there and inside the lane {position}
    t0_ns BIGINT NOT NULL,            -- t_pull of the excursion: first step with a corner more than 0.05 m over the boundary, or, after a look past the vehicle ahead, when it pulls out {position}
    t1_ns BIGINT,                     -- first step wholly in the overtaking lane {position}
    t_out_ns BIGINT NOT NULL,         -- end of pulling out: t1, or for an overtake astride the line the first step within 0.1 m of its furthest {position}
    t2_ns BIGINT,                     -- lateral speed turns back {position}
    t3_ns BIGINT,                     -- first step wholly back in the running lane {position}
    t_end_ns BIGINT NOT NULL,         -- t3, or the last step of the excursion {position}
    passed BOOLEAN NOT NULL,          -- the ego's front got past the VBP's front {position}
    status VARCHAR NOT NULL,          -- [overtake_status] {position}
    v_av_mps DOUBLE,                  -- ego's speed at t0 {velocity}
    v_vbp_mps DOUBLE,                 -- VBP's speed at t0 {velocity}
    l_av_m DOUBLE,                    -- ego's length {size}
    l_vbp_m DOUBLE,                   -- VBP's length {size}
    lane_width_m DOUBLE,              -- w_L, width of the running lane at t0
    vbp_gap_m DOUBLE,                 -- ego front to VBP rear at t0, along the corridor; negative: the VBP is beside the ego then {position, heading, size}
    span_m DOUBLE,                    -- from the rear of the first vehicle passed in this go to the front of this one, at t0: L_VBP if it is alone {position}
    t2_gap_m DOUBLE,                  -- VBP front to ego rear at t2 {position, heading, size}
    t3_gap_m DOUBLE,                  -- VBP front to ego rear at t3 {position, heading, size}
    v_vbp_t3_mps DOUBLE,              -- VBP's speed at t3 {velocity}
    ov_id VARCHAR,                    -- see oncoming, at t0 {position}
    da_m DOUBLE,                      -- distance ahead at t0; without an OV how far the road was free {position}
    v_ov_mps DOUBLE,                  -- OV's speed at t0; without an OV the speed limit {velocity}
    n_unplaced BIGINT,                -- see oncoming, at t0; NULL: the ego is not placed {position}
    unplaced_reason VARCHAR,          -- see oncoming
    free_reason VARCHAR,              -- [free_end] see oncoming
    pull_out_angle_rad DOUBLE,        -- observed: atan of lateral over longitudinal way from t0 to t_out {heading}
    cut_in_angle_rad DOUBLE           -- observed: the same from t2 to t3 {heading}
);

-- lifetime: part
CREATE TABLE overtake_sda (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- see overtake
    profile VARCHAR NOT NULL,         -- [profile_name] see profile; every one, selected or not
    t0_ns BIGINT NOT NULL,            -- see overtake {position}
    ov_id VARCHAR,                    -- of the oncoming vehicles at t0 the one that leaves the least, see oncoming_vehicle; NULL: none {position}
    da_m DOUBLE,                      -- distance ahead to it; NULL: unknown, or more than sda_m while another OV is not ruled out, or too little at the ego's speed at t0 and enough at its mean speed (or the one that it had reached when the log ended) {position}
    at_least BOOLEAN NOT NULL,        -- da_m is only a lower bound (a sight line) {position}
    nobody BOOLEAN NOT NULL,          -- every vehicle placed, and no OV as far as da_m {position}
    sda_m DOUBLE,                     -- safe distance ahead, at the ego's speed at t0; observed: at its mean speed, if completed, and where da_m is no more than what the ego and the OV covered while the ego was out and the OV's stopping distance: at least that; NULL: undefined {position, heading, velocity, size}
    spare_m DOUBLE,                   -- da_m - sda_m {position, heading, velocity, size}
    spare_s DOUBLE,                   -- the time in which it closes, at v_AV + v_OV {position, heading, velocity, size}
    zone VARCHAR,                     -- [zone] NULL: unknown {position, heading, velocity, size}
    reason VARCHAR,                   -- why sda_m or da_m is NULL, or a remark on them, as JSON from the macro why
    pull_out_m DOUBLE,                -- of sda_m, which its parts add up to: what the ego drives to pull out; NULL: sda_m is what was driven, or undefined {position, heading, velocity, size}
    passing_m DOUBLE,                 -- of sda_m: what it drives beside the vehicle being passed; NULL: as pull_out_m {position, heading, velocity, size}
    cut_in_m DOUBLE,                  -- of sda_m: what it drives to cut in; NULL: as pull_out_m {position, heading, velocity, size}
    oncoming_m DOUBLE,                -- of sda_m: what the OV drives meanwhile; NULL: as pull_out_m {position, heading, velocity, size}
    covered_m DOUBLE,                 -- of sda_m: what the ego and the OV covered while the ego was out, until both stand; NULL: sda_m is no more than the formula's, or undefined {position, heading, velocity, size}
    stopping_m DOUBLE                 -- of sda_m: the OV's stopping distance; NULL: undefined {position, heading, velocity, size}
);

-- lifetime: part
CREATE TABLE overtake_step (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- see overtake
    t_ns BIGINT NOT NULL,             -- a step from t0 to t_end
    stage VARCHAR NOT NULL,           -- [overtake_stage] {position}
    vbp_id VARCHAR NOT NULL,          -- the vehicle being passed {position}
    sure BOOLEAN NOT NULL,            -- see overtake {position}
    ov_id VARCHAR,                    -- of the oncoming vehicles at this step the one whose danger space reaches furthest into the ego's, see oncoming_vehicle; NULL: none {position}
    ov_known BOOLEAN NOT NULL,        -- no other vehicle may come: every one is placed {position}
    ov_reason VARCHAR,                -- why ov_known is false, and what to provide, as JSON from the macro why; not NULL where ov_known is true
    sd_av_m DOUBLE,                   -- stopping distance of the ego: length of its danger space {position, heading, velocity, size}
    ds_av_s_m DOUBLE,                 -- where that danger space begins along the corridor: the middle of the front bumper {position, heading, velocity, size}
    ds_av_d_m DOUBLE,                 -- middle of that danger space across the corridor: where the front bumper's middle is, left positive {position, heading, velocity, size}
    ds_av_half_m DOUBLE,              -- half its width: half the vehicle's {position, heading, velocity, size}
    sd_ov_m DOUBLE,                   -- stopping distance of the oncoming vehicle {position, heading, velocity, size}
    ds_ov_s_m DOUBLE,                 -- where its danger space begins, reaching against the corridor {position, heading, velocity, size}
    ds_ov_d_m DOUBLE,                 -- middle of its danger space across the corridor {position, heading, velocity, size}
    ds_ov_half_m DOUBLE,              -- half its width {position, heading, velocity, size}
    vbp_in_ds_av_m DOUBLE,            -- along the corridor, how far the VBP is inside the ego's danger space (negative: clear of it by that much) {position, heading, velocity, size}
    ov_in_ds_av_m DOUBLE,             -- an OV inside the ego's, the most of any; NULL: not known of one, and of the others none is inside {position, heading, velocity, size}
    av_in_ds_ov_m DOUBLE,             -- likewise the ego inside an OV's {position, heading, velocity, size}
    ds_overlap_m DOUBLE               -- likewise the two danger spaces inside each other {position, heading, velocity, size}
);

-- lifetime: part
CREATE TABLE opportunity (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order
    object_id VARCHAR NOT NULL,       -- the slower vehicle ahead
    profile VARCHAR NOT NULL,         -- [profile_name] see profile (not observed)
    t_start_ns BIGINT NOT NULL,       -- held up from here {position}
    t_end_ns BIGINT NOT NULL,         -- to here {position}
    t_best_ns BIGINT,                 -- the step with the most spare distance; NULL: never known {position}
    da_m DOUBLE,                      -- distance ahead there, or how far it was free; NULL: unknown {position}
    sda_m DOUBLE,                     -- safe distance ahead there {position, heading, velocity, size}
    spare_s DOUBLE,                   -- time in which the spare distance closes {position, heading, velocity, size}
    zone VARCHAR,                     -- [zone] at that step; NULL: unknown {position, heading, velocity, size}
    taken BOOLEAN NOT NULL            -- an overtake of that vehicle began in it {position}
);

-- ---- crossing boundaries, signalling, exits

-- lifetime: part
CREATE TABLE lane_departure (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order
    t_ns BIGINT NOT NULL,             -- first step with a corner more than 0.05 m over a boundary, in a manoeuvre: the centre crossed too, or a vehicle was overtaken; on the way back, see t_return and t_back of excursion
    begin_seen BOOLEAN NOT NULL,      -- see excursion {position}
    side VARCHAR NOT NULL,            -- [side] {position}
    back BOOLEAN NOT NULL             -- it is the way back of an excursion: the boundary is crossed towards the running lane {position}
);

-- lifetime: part
CREATE TABLE indicator_on (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order
    side VARCHAR NOT NULL,            -- [side]
    t_on_ns BIGINT NOT NULL,          -- first step with it on, the step before being off or the other side
    t_off_ns BIGINT NOT NULL,         -- last step with it on
    at_log_start BOOLEAN NOT NULL     -- was on when the log began: t_on_ns is not its start
);

-- lifetime: map
CREATE TABLE exit_lane (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a lanelet of a lane that leaves the main carriageway
    from_id VARCHAR,                  -- the through lanelet beside it; NULL: it branches off without one
    side VARCHAR NOT NULL             -- [side] on which it leaves
);

-- lifetime: part
CREATE TABLE exit_taken (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order
    t_ns BIGINT NOT NULL,             -- first step with a corner more than 0.05 m over the exit lane's boundary
    side VARCHAR NOT NULL,            -- [side] {position}
    lanelet_id VARCHAR NOT NULL,      -- the exit lanelet
    t_sign_ns BIGINT,                 -- first step at or past the last exit sign before it; NULL: passed before the log began {position}
    sign_id VARCHAR                   -- that sign; NULL: the map has none on the way
);

-- lifetime: part
CREATE TABLE exit_passed (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order
    lanelet_id VARCHAR NOT NULL,      -- the exit lanelet beside the ego's way
    side VARCHAR NOT NULL,            -- [side] {position}
    t_near_ns BIGINT NOT NULL,        -- first step beside it, or on it {position}
    t_gore_ns BIGINT,                 -- first step past its end, where the choice is made; NULL: the log ends before {position}
    taken BOOLEAN                     -- the ego was in the exit lane at its end; NULL: not reached {position}
);

-- lifetime: run
CREATE TABLE exposure (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    km DOUBLE NOT NULL,               -- way made
    hours DOUBLE NOT NULL,            -- time, without the holes and without the time in which the ego is absent
    engaged_km DOUBLE NOT NULL,       -- way up to the steps at which the automated driver drives (see ego_condition)
    engaged_hours DOUBLE NOT NULL,    -- the same time
    n_steps BIGINT NOT NULL           -- ego steps
);

-- lifetime: run
CREATE TABLE recorded (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- an actor of the log
    t_from_ns BIGINT NOT NULL,        -- its place is known from here
    t_to_ns BIGINT NOT NULL           -- to here, without a hole and without a lost time
);
