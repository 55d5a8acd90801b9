-- The derived tables, second part: the conditions of a step, the ego's own motion, and its conduct towards other road users.
-- As in derived.sql, an actor that is present without a known position has a row with NULL, never an absent row.

-- lifetime: part
CREATE TABLE ego_condition (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    road_type VARCHAR,                -- [road_type] of the lanelet, or as given; NULL: not known
    carriageway VARCHAR,              -- [carriageway] as the map's lanes show, or as given; NULL: not known
    lanes_each_way BIGINT,            -- number of drivable lanes of the ego's road, in the direction that has fewer; NULL: not known, or only one direction
    area VARCHAR,                     -- [area] by road type, or as given; NULL: not known
    nation VARCHAR,                   -- [nation] NULL: not given
    weather VARCHAR,                  -- [weather] NULL: not given
    light VARCHAR,                    -- [light] NULL: not given
    vehicle_class VARCHAR,            -- [vehicle_class] of the ego: as given, or by its actor class; car_towing for a car that tows a trailer (see ego_part); NULL: not known, or another vehicle that tows a trailer
    limit_mps DOUBLE,                 -- the map's speed limit at the ego's position; NULL: the map does not state it
    engaged BOOLEAN                   -- the automated driver drives: by its mode flag, or as given; true without either; NULL: the log has flags, but none is known at this step
);

-- lifetime: part
CREATE TABLE ego_mode (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    mode VARCHAR NOT NULL,            -- [mode] a declared event whose values are on and off; one row per step for each mode that the ego ever declared
    is_on BOOLEAN                     -- the mode is on, by the last declaration before the step; NULL: none yet
);

-- lifetime: part
CREATE TABLE ego_motion (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    v_long_mps DOUBLE,                -- speed along the ego's own heading; negative: reversing {velocity}
    accel_mps2 DOUBLE,                -- longitudinal acceleration, least-squares over 0.25 s on both sides; NULL: incomplete window (ends of the log, holes), or below 5 Hz {velocity}
    lat_accel_mps2 DOUBLE,            -- lateral acceleration, left positive: speed times smoothed yaw rate {velocity}
    jerk_mps3 DOUBLE,                 -- slope of accel_mps2 over 0.7 s on both sides, at every sampling rate {velocity}
    accel_2s_mps2 DOUBLE,             -- mean acceleration over the 2 s that end at this step {velocity}
    jerk_1s_mps3 DOUBLE,              -- mean jerk over the 1 s that ends at this step {velocity}
    accel_peak_mps2 DOUBLE NOT NULL,  -- how much further from zero the true longitudinal acceleration may be (also when braking), because the filter flattens peaks {velocity}
    lat_peak_mps2 DOUBLE NOT NULL,    -- how much further from zero the true lateral acceleration may be, as accel_peak_mps2 {velocity}
    accel_error_mps2 DOUBLE,          -- error bound of the longitudinal acceleration, from the scatter of the speeds or a contradiction by the positions; NULL: too few samples {velocity}
    lat_error_mps2 DOUBLE,            -- error bound of the lateral acceleration, from the scatter of the headings or a contradiction by the course; NULL: too few samples {velocity}
    jerk_error_mps3 DOUBLE,           -- error bound of the jerk {velocity}
    jerk_1s_error_mps3 DOUBLE         -- error bound of the mean jerk over 1 s {velocity}
);

-- lifetime: part
CREATE TABLE track_end (
    drive_id VARCHAR NOT NULL,        -- the drive; only where data_log.in_sight holds
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- an actor
    lost BOOLEAN NOT NULL,            -- true: its track, or the part of it before a hole, ends here; false: the track or part begins here {position}
    t_ns BIGINT NOT NULL,             -- the last (or first) sample with a position
    plain_ns BIGINT NOT NULL          -- time limit of plain view: after it (if lost; else before it), an actor without samples is assumed not to be in plain view {position}
);

-- lifetime: part
CREATE TABLE sight (
    drive_id VARCHAR NOT NULL,        -- the drive; only where data_log.in_sight holds
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which an actor without a position is or may be present
    around_m DOUBLE NOT NULL,         -- distance from the ego's middle within which nothing blocks the view: up to the nearest box, or the sensor's range {position}
    lane_m DOUBLE NOT NULL,           -- distance ahead of the ego's front within which its lane is in plain view {position}
    vehicle_lane_m DOUBLE NOT NULL    -- distance ahead of the ego's front within which no vehicle can be hidden in its lane; a box that reaches less than half a metre into the lane hides no vehicle {position}
);

-- lifetime: part
CREATE TABLE hidden (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- an actor that is or may be present without a position on the corridor: it has no position or box, is lost, is beyond the map's end, or is straight ahead of a missing link or in a hole between two lanes
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    vehicle BOOLEAN NOT NULL,         -- the actor may be a vehicle {class}
    least_m DOUBLE NOT NULL,          -- lower bound of the distance from box to box, from the time and place of the last and next sighting that are not in doubt; if late, also from the part that is in plain view {position, heading, size}
    ahead BOOLEAN,                    -- the actor is ahead of the ego; NULL: it may be ahead or not {position}
    along BOOLEAN NOT NULL,           -- the actor moves in the ego's direction: by its last or next sighting on the corridor, not in doubt {position}
    late BOOLEAN NOT NULL,            -- the actor is not in plain view, where it would have been recorded: see track_end {position}
    lane_m DOUBLE NOT NULL,           -- lower bound of the distance ahead, if the actor is in the ego's lane: least_m; if late, the part of the lane in plain view; if it is not on the map, the corridor's length {position}
    beside_lane BOOLEAN NOT NULL      -- the actor is not in the ego's lane: it is seen too far beside the lane, too short a time before or after, to be in it {position, heading, velocity}
);

-- lifetime: part
CREATE TABLE in_way (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; one row for every step
    object_id VARCHAR,                -- the nearest actor of any class in the ego's way or heading into it; NULL: none, as far as known
    actor_class VARCHAR,              -- [actor_class] see actor; NULL also if there is no actor {class}
    gap_m DOUBLE,                     -- distance along the road from the ego's front to the actor, 0 alongside; NULL: no actor {position, heading, size}
    along_mps DOUBLE,                 -- speed of the actor along the road, positive away from the ego; NULL: no actor, or not known {velocity}
    need_mps2 DOUBLE NOT NULL,        -- the hardest deceleration needed within the last 2 s to stay 5 m away from an actor in the way; 0: none was needed {velocity}
    known BOOLEAN NOT NULL            -- within the last 2 s, no other actor can have been in the way: every near actor has a position, and no actor beside the way could step into it {position}
);

-- lifetime: part
CREATE TABLE neighbour (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    k INTEGER NOT NULL,               -- see step
    seg INTEGER NOT NULL,             -- see step
    object_id VARCHAR NOT NULL,       -- an actor in the corridor's strip, at most 30 m from the ego, box to box
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    chain_id INTEGER NOT NULL,        -- the running chain of the ego
    ahead_m DOUBLE NOT NULL,          -- distance from the ego's front to the object's front, positive ahead {position}
    gap_ahead_m DOUBLE NOT NULL,      -- distance from the ego's front to the object's rear {position, heading, size}
    gap_behind_m DOUBLE NOT NULL,     -- distance from the object's front to the ego's rear {position, heading, size}
    d_m DOUBLE NOT NULL,              -- see pair {position}
    lat_half_m DOUBLE NOT NULL,       -- see pair {heading, size}
    half_width_m DOUBLE NOT NULL,     -- see pair
    heading_diff_rad DOUBLE NOT NULL, -- see pair {heading}
    side VARCHAR NOT NULL,            -- [side] the side of the ego on which the object is {position}
    gap_m DOUBLE NOT NULL,            -- see beside {position, heading, size}
    clearance_m DOUBLE,               -- see pair {position, heading, size}
    ego_speed_mps DOUBLE,             -- speed of the ego {velocity}
    speed_mps DOUBLE,                 -- speed of the object {velocity}
    ego_left_mps DOUBLE               -- the ego's speed across the corridor, left positive: from its velocity if known, else from speed and heading {velocity}
);

-- lifetime: part
CREATE TABLE follower (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; no row: it is not known which vehicle is behind
    lane VARCHAR NOT NULL,            -- [lane_of_follower] the lane; one row per lane {position}
    object_id VARCHAR,                -- the nearest vehicle behind in this lane, within 200 m, that heads in the ego's direction; NULL: no vehicle
    gap_m DOUBLE,                     -- distance from its front to the ego's rear along the corridor; negative: alongside {position, heading, size}
    speed_mps DOUBLE,                 -- speed of the follower {velocity}
    closing_mps DOUBLE                -- speed of the follower minus that of the ego {velocity}
);

-- lifetime: part
CREATE TABLE lane_crossing (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    from_chain_id INTEGER NOT NULL,   -- the running chain before
    to_chain_id INTEGER NOT NULL,     -- the running chain from this step on
    to_lanelet_id VARCHAR,            -- the lanelet of the new lane
    t_ns BIGINT NOT NULL,             -- first step with the ego's centre in another lane of the same direction
    k INTEGER NOT NULL,               -- see step
    t_before_ns BIGINT NOT NULL,      -- the step before {position}
    seen BOOLEAN NOT NULL,            -- there is no hole between the two steps {position}
    side INTEGER NOT NULL             -- the side to which the ego crosses: 1 left, -1 right {position}
);

-- lifetime: part
CREATE TABLE ego_road (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- a running chain, see chain
    road INTEGER NOT NULL,            -- number of the road, from 1, in time order; chains between which the ego changed lanes are one road {position}
    offset_m DOUBLE NOT NULL          -- difference that is added to a station of the chain to get the station along the road {position}
);

-- lifetime: part
CREATE TABLE lane_change (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the change, from 0, in time order: first the changes to an adjacent lane of the same direction, then those out of restricted ground
    t_start_ns BIGINT NOT NULL,       -- first step with a corner more than 0.05 m over the boundary {position}
    begin_seen BOOLEAN NOT NULL,      -- the step before t_start_ns exists, and the ego is inside the lane there {position}
    t_cross_ns BIGINT,                -- first step with the centre over the boundary; NULL: the log or a hole ends before (with half a metre of the ego over it), or it crossed during a hole {position}
    t_done_ns BIGINT,                 -- first step with the whole box in the new lane; NULL: the log or a hole ends before {position}
    side VARCHAR NOT NULL,            -- [side] the side to which the ego changes {position}
    from_lanelet_id VARCHAR NOT NULL, -- the lane that the ego leaves, at t_start_ns
    to_lanelet_id VARCHAR,            -- the lane that the ego enters, at t_cross_ns; NULL: not seen
    merge BOOLEAN,                    -- the old lane only leads onto the new one (an entry, an on-ramp, or a lane that ends); NULL: not known {position}
    ego_speed_mps DOUBLE,             -- speed of the ego at t_start_ns {velocity}
    leader_id VARCHAR,                -- the nearest vehicle ahead in the new lane at t_start_ns; NULL: none, see known {position}
    leader_gap_m DOUBLE,              -- distance from the ego's front to the leader's rear {position, heading, size}
    leader_speed_mps DOUBLE,          -- speed of the leader {velocity}
    follower_id VARCHAR,              -- the nearest vehicle behind in the new lane at t_start_ns, or one beside the ego that is still beside it when the ego's centre crosses the line; NULL: none, see known {position}
    follower_gap_m DOUBLE,            -- distance from the follower's front to the ego's rear; negative: alongside {position, heading, size}
    follower_gap_before_m DOUBLE,     -- the same gap at the step before t_start_ns: the ego crosses the line between the two steps; NULL: not seen {position, heading, size}
    follower_speed_mps DOUBLE,        -- speed of the follower {velocity}
    follower_decel_mps2 DOUBLE,       -- the follower's strongest mean deceleration over 0.5 s in the 4 s after t_start_ns (positive: it slowed); NULL: not completely seen, or no follower {velocity}
    known BOOLEAN NOT NULL,           -- the positions of all vehicles nearby are known at t_start_ns: no other vehicle is leader or follower {position}
    unseen_m DOUBLE                   -- lower bound of the distance of a vehicle without a position that may be behind in the new lane at t_start_ns; infinite: none; NULL: the ego's position was not known {position}
);

-- lifetime: part
CREATE TABLE cut_in (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the cut-in, from 0, in time order: another vehicle moves from beside into the running lane ahead of the ego. Also a stretch of a second or longer in which it is not known which vehicle is ahead: a vehicle may have cut in
    object_id VARCHAR,                -- the vehicle that cuts in; NULL: a vehicle may have cut in; of the other columns, only ego_speed_mps (the highest) and free_m may then be known
    t_ns BIGINT NOT NULL,             -- first step with its box more than 0.3 m inside the running lane, coming from at most 0.05 m; within 45 degrees of the lane, at most 150 m ahead. Of a vehicle that overtook the ego and was already further inside: first step as the nearest vehicle ahead (lead.joined). If object_id is NULL, the first unknown step
    begin_seen BOOLEAN NOT NULL,      -- the step before exists, and the vehicle's position is known there: else it may have come in earlier {position}
    side VARCHAR,                     -- [side] the side from which the vehicle came {position}
    gap_m DOUBLE,                     -- distance from the ego's front to the vehicle's rear at t_ns, along the corridor {position, heading, size}
    ego_speed_mps DOUBLE,             -- speed of the ego at t_ns {velocity}
    speed_mps DOUBLE,                 -- speed of the vehicle at t_ns {velocity}
    in_place_ns BIGINT,               -- first step with the vehicle's centre in the running lane; NULL: never {position}
    free_m DOUBLE                     -- if object_id is NULL: distance ahead within which no vehicle is at any of these steps; NULL: not known {position, heading, size}
);

-- lifetime: part
CREATE TABLE beside (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which the two boxes overlap along the corridor, or after which they pass each other before the next step; or at which they may overlap: then the other columns are NULL
    object_id VARCHAR NOT NULL,       -- another actor
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    side VARCHAR,                     -- [side] the side of the ego on which the object is {position}
    gap_m DOUBLE,                     -- gap between the two boxes across the corridor; negative: overlap; if they pass each other between two steps, the mean of the gaps at both {position, heading, size}
    clearance_m DOUBLE,               -- distance between the two boxes, see pair; if they pass each other between two steps, gap_m {position, heading, size}
    blur_m DOUBLE,                    -- how much nearer the two may have been between this step and its neighbours, if both swerve by 3 m/s2; 0 in a log of about ten or more samples a second {position}
    ahead_m DOUBLE,                   -- distance from the ego's front to the object's front along the corridor, positive ahead {position}
    ego_speed_mps DOUBLE,             -- speed of the ego {velocity}
    speed_mps DOUBLE,                 -- speed of the object {velocity}
    ego_lat_mps DOUBLE,               -- the ego's speed across the corridor, positive towards the object {velocity}
    lat_mps DOUBLE,                   -- the object's speed across the corridor, positive towards the ego {velocity}
    cycle_lane VARCHAR,               -- [marking + unsaid] the object is on a cycle lane of the carriageway: the marking between this lane and the lane of motor vehicles, unsaid if the map states none; NULL: it is on no cycle lane {position}
    along BOOLEAN,                    -- the object heads in the corridor's direction, within 45 degrees {position}
    on_carriageway BOOLEAN,           -- the object is on the carriageway: its box reaches into the running lane or a drivable lane beside it, or its centre is on a drivable lane or an adjacent cycle lane. Not behind a verge, kerb or footway; NULL: not known
    on_strip BOOLEAN                  -- the object's centre is beside the drivable lanes, with no kerb or verge between: on a shoulder, stop, border, parking, restricted or cycle lane; NULL: not known, as behind a border, which may be a kerb {position}
);

-- lifetime: part
CREATE TABLE passing (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the passing, from 0, in time order: the ego and another road user of the same direction change their order, or a vehicle without a known position may have
    object_id VARCHAR NOT NULL,       -- the other road user
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    ego_passes BOOLEAN,               -- true: the ego's front got ahead of the other's by more than 0.25 m; false: the other's front got ahead; NULL: the other may be beside the ego, and it is not known whether the order changed {position}
    t_ns BIGINT NOT NULL,             -- first step in the new order; if ego_passes is NULL, the last step at which the other may be beside the ego
    t_unseen_ns BIGINT,               -- last step in the old order, if the order may have changed unseen since then; if ego_passes is NULL, the first step at which the other may be beside the ego; NULL: the order changed at t_ns {position}
    t_from_ns BIGINT NOT NULL,        -- first step of the stretch around t_ns in which the two are beside each other {position}
    t_to_ns BIGINT NOT NULL,          -- last step of this stretch {position}
    side VARCHAR,                     -- [side] the side of the ego on which the other is; NULL: ego_passes is NULL {position}
    gap_m DOUBLE,                     -- least gap across the corridor from t_from_ns to t_to_ns; NULL: no step was seen at which the two are beside each other {position, heading, size}
    whole BOOLEAN NOT NULL,           -- the stretch was completely seen, from before its first step until after its last, without a hole; false: gap_m is only the least gap that was seen {position}
    same_lane BOOLEAN,                -- the other's centre is in the ego's running lane at t_ns: the ego passes round it; NULL: ego_passes is NULL {position}
    ego_speed_mps DOUBLE,             -- speed of the ego at t_ns {velocity}
    speed_mps DOUBLE                  -- speed of the other at t_ns; standing: at most 0.5 {velocity}
);

-- lifetime: part
CREATE TABLE line_step (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step with a corner of the ego more than 0.05 m over a boundary of its running lane; not inside a junction, and not without a position on the corridor (ego_state.front_s_m is NULL)
    side VARCHAR NOT NULL,            -- [side] the side of that boundary; one row per side {position}
    out_m DOUBLE NOT NULL,            -- distance of the outermost corner beyond the boundary {position, heading, size}
    marking VARCHAR,                  -- [marking] see lane_boundary: at the ego's centre, as seen from the running lane; NULL: the map does not state it
    forbidden BOOLEAN,                -- the marking must not be crossed from this lane: solid, or double with the nearer line solid; NULL: marking not known
    beyond VARCHAR,                   -- [lane_type + same + opposing] the lane beyond the boundary (see lane_beside): same or opposing for a drivable lane, by its direction, else its lane_type; NULL: the map has none {position}
    middle BOOLEAN,                   -- the boundary is the middle of the road: traffic beyond it comes from ahead; NULL: it may be. On the overtaking side, the map has nothing beyond it (and the road is no motorway), a gap of more than 1 m or a median, which may be a central reservation
    t_since_ns BIGINT NOT NULL,       -- first step of this stretch over the line; both lanes beside the line count, whichever is the running lane {position}
    begin_seen BOOLEAN NOT NULL,      -- the step before t_since_ns exists, and the ego is inside the lane there {position}
    manoeuvre BOOLEAN NOT NULL,       -- the stretch is or is part of a lane change or an overtake, see lane_departure {position}
    t_astride_ns BIGINT,              -- first step since which the box has been astride of the line, with more than 0.05 m on each side; both lanes beside the line count; NULL: not astride at this step {position}
    astride_begin_seen BOOLEAN,       -- the step before t_astride_ns exists; NULL: not astride {position}
    changes BOOLEAN,                  -- in that time, the centre crosses to the other side of the line and stays there: a lane change, or part of an overtake; NULL: the end is not seen and the ego may go back, or not astride {position}
    overtaking BOOLEAN,               -- the ego overtakes a vehicle, or passes round a pedestrian in its lane. This counts from 10 m plus 5 s of the closing speed (at least 30 m) before that actor to the same distance after it; NULL: it may overtake, but the actor is lost meanwhile, or the overtaking side is not known {position}
    passing_id VARCHAR,               -- an actor in the running lane or on its edge that the ego passes, and that leaves too little room on this side of the line: a standing vehicle, or a cyclist or animal at up to 4.47 m/s. It counts from 10 m plus 5 s of the ego's speed (at least 30 m) ahead to 10 m plus 5 s behind; NULL: none, or in this stretch the ego overtakes a moving vehicle {position}
    passing_known BOOLEAN NOT NULL,   -- no other actor may be passed: all near actors have a position, or are out of plain view while the lane ahead is in plain view {position}
    access BOOLEAN                    -- within 30 m, the ego enters or leaves premises or a side road beyond the line. It then is off the lanes at 20 mph or less, and turns off, stands, or gets more than 10 m from the running lane's centre line. A shoulder, bay or cycle lane of the same road does not count, nor an ego that was or comes back by 0.25 m on the same lane; NULL: not known, as when it turns off and comes back the opposite way
);

-- lifetime: part
CREATE TABLE overtake_place (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- see overtake
    junction_m DOUBLE,                -- distance along the corridor from the ego's front at t0 to the next junction; infinite: none within the corridor; negative: inside a junction {position}
    crossing_m DOUBLE,                -- distance from the ego's front at t0 to the next pedestrian crossing, as junction_m {position}
    marking_out VARCHAR,              -- [marking] of the boundary that the ego crosses at t0, seen from the running lane; NULL: the map does not state it {position}
    marking_back VARCHAR,             -- [marking] of the boundary that the ego crosses back at t3, seen from the overtaking lane; NULL: the map does not state it, or the ego never comes back {position}
    no_overtaking BOOLEAN,            -- a no-overtaking sign applies at t0, or where the ego's front draws level with the rear of a vehicle that it passes; it applies until its end sign or the next junction; NULL: the map has no such signs, or neither a sign nor a junction behind the ego: one may stand further back {position}
    rear_id VARCHAR,                  -- a vehicle behind or beside the ego at t0, in the overtaking lane or moving into it; NULL: none {position, heading, size}
    rear_gap_m DOUBLE,                -- distance from that vehicle's front to the ego's rear; negative: alongside {position, heading, size}
    rear_ttc_s DOUBLE,                -- time until that vehicle reaches the ego's rear, at the ego's speed and the vehicle's highest speed in the 2 s before; infinite: never, or no vehicle; 0: alongside {position, velocity}
    rear_known BOOLEAN NOT NULL,      -- the positions and speeds of all vehicles behind or beside, within 200 m, are known {position, heading, size}
    rear_unseen_m DOUBLE              -- lower bound of the distance of a vehicle without a position that may be behind or beside; NULL: none, or a vehicle with a position has no class or speed {position, heading, size}
);

-- lifetime: part
CREATE TABLE following (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; every step has a row
    object_id VARCHAR,                -- the nearest vehicle ahead that the ego follows, else the lead; NULL: none, or not known
    follows BOOLEAN,                  -- the ego is behind this vehicle and goes its way: in its lane, outside an overtake or lane change (of up to 10 s astride the line), and it is neither oncoming nor beside. A standing vehicle must be in the way of the ego's box at this step and when the ego arrives. A moving one must be in its way, or have its centre in the lane and be more than 3 s from being passed; NULL: not known {position}
    gap_m DOUBLE,                     -- see lead {position, heading, size}
    ego_speed_mps DOUBLE,             -- speed of the ego {velocity}
    speed_mps DOUBLE,                 -- speed of the vehicle {velocity}
    joined_ns BIGINT,                 -- see vehicle_ahead: the time since which the gap is new; NULL: the vehicle was ahead before, or its arrival was not seen {position}
    let_in_ns BIGINT,                 -- see vehicle_ahead: the time since which the gap is new, if the ego did not change lanes {position}
    free_m DOUBLE                     -- see vehicle_ahead: if it is not known which vehicle is ahead, none is nearer than this {position, heading, size}
);
