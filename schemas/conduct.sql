-- The library, second part: the conditions of a step, the ego's own motion, and what it does with the others on its road.
-- As in derived.sql: what is present but cannot be placed is a row with NULL, never an absent row.

-- lifetime: part
CREATE TABLE ego_condition (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    road_type VARCHAR,                -- [road_type] of the lanelet, or as given; NULL: not known
    carriageway VARCHAR,              -- [carriageway] as the map's lanes show, or as given; NULL: not known
    lanes_each_way BIGINT,            -- drivable lanes of its road in the direction that has fewer; NULL: not known, or one direction only
    area VARCHAR,                     -- [area] by road type, or as given; NULL: not known
    nation VARCHAR,                   -- [nation] NULL: not given
    weather VARCHAR,                  -- [weather] NULL: not given
    light VARCHAR,                    -- [light] NULL: not given
    vehicle_class VARCHAR,            -- [vehicle_class] of the ego, as given or by its class; a car that draws a trailer (see ego_part) is car_towing; NULL: not known, or another that draws one
    limit_mps DOUBLE,                 -- speed limit of the map where the ego is; NULL: the map does not state it
    engaged BOOLEAN                   -- the automated driver drives: by its mode flag, or as given; true where neither is there; NULL: there are flags, and none is known here
);

-- lifetime: part
CREATE TABLE ego_mode (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    mode VARCHAR NOT NULL,            -- [mode] a declared event whose values are on and off; one row per step for each that the ego ever declared
    is_on BOOLEAN                     -- by the last declaration before the step; NULL: none yet
);

-- lifetime: part
CREATE TABLE ego_motion (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    v_long_mps DOUBLE,                -- speed along its own heading; negative: reversing {velocity}
    accel_mps2 DOUBLE,                -- longitudinal acceleration, least-squares over 0.25 s to both sides; NULL where that is not whole (log's ends, holes), and below 5 Hz {velocity}
    lat_accel_mps2 DOUBLE,            -- speed times smoothed yaw rate, to the left positive {velocity}
    jerk_mps3 DOUBLE,                 -- slope of accel_mps2 over 0.7 s on either side, at every rate {velocity}
    accel_2s_mps2 DOUBLE,             -- mean acceleration over the 2 s that end at this step {velocity}
    jerk_1s_mps3 DOUBLE,              -- mean jerk over the 1 s that ends at this step {velocity}
    accel_peak_mps2 DOUBLE NOT NULL,  -- the true longitudinal acceleration may be further from zero by so much (also when braking), as the filter flattens peaks {velocity}
    lat_peak_mps2 DOUBLE NOT NULL,    -- the same of the lateral acceleration {velocity}
    accel_error_mps2 DOUBLE,          -- the longitudinal acceleration may be off by so much: by the scatter of the speeds, or as the places contradict it; NULL: too few samples {velocity}
    lat_error_mps2 DOUBLE,            -- the same of the lateral acceleration, by the scatter of the headings or the course {velocity}
    jerk_error_mps3 DOUBLE,           -- the same of the jerk {velocity}
    jerk_1s_error_mps3 DOUBLE         -- the same of the change of acceleration over 1 s {velocity}
);

-- lifetime: part
CREATE TABLE track_end (
    drive_id VARCHAR NOT NULL,        -- the drive; only where data_log.in_sight holds
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- an actor
    lost BOOLEAN NOT NULL,            -- its track, or the part of it before a hole, ends here; false: it begins here {position}
    t_ns BIGINT NOT NULL,             -- the last sample with a place, or the first
    plain_ns BIGINT NOT NULL          -- after this, or before it, whoever is not recorded is not in plain view {position}
);

-- lifetime: part
CREATE TABLE sight (
    drive_id VARCHAR NOT NULL,        -- the drive; only where data_log.in_sight holds
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which somebody is or may be there who has no place
    around_m DOUBLE NOT NULL,         -- nearer to the ego's middle than this nothing stands in the way of sight: the nearest box, or the sensor's range {position}
    lane_m DOUBLE NOT NULL,           -- so far ahead of the ego's front its lane is in plain view {position}
    vehicle_lane_m DOUBLE NOT NULL    -- so far ahead of it no vehicle stands unseen in its lane: a box that reaches less than half a metre into it hides none {position}
);

-- lifetime: part
CREATE TABLE hidden (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- somebody who is or may be there and has no place in the corridor: no position or box, lost, beyond the map's end, or straight on from where the ego's lane ends without a link, or in a hole between two lanes
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    vehicle BOOLEAN NOT NULL,         -- it may be a vehicle {class}
    least_m DOUBLE NOT NULL,          -- box to box it is at least so far away, by when and where it is seen, and, if late, by what is in plain view {position, heading, size}
    ahead BOOLEAN,                    -- it is ahead of the ego; NULL: it may be or not {position}
    along BOOLEAN NOT NULL,           -- it goes the ego's way: where it was seen last or is seen next on the corridor {position}
    late BOOLEAN NOT NULL,            -- it is not in plain view, for it would have been recorded: see track_end {position}
    lane_m DOUBLE NOT NULL,           -- in the ego's lane ahead of it, it is at least so far away: least_m; if late, as far as that lane is in plain view; if it is not on the map, as far as the corridor reaches {position}
    beside_lane BOOLEAN NOT NULL      -- it is seen so far beside the ego's lane, and so soon before or after, that it is not in that lane {position, heading, velocity}
);

-- lifetime: part
CREATE TABLE in_way (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; every step has one row
    object_id VARCHAR,                -- the nearest actor of any class in the ego's way or heading into it; NULL: nobody is, as far as is known
    actor_class VARCHAR,              -- [actor_class] see actor; NULL also where nobody is {class}
    gap_m DOUBLE,                     -- along the road from the ego's front to it, none alongside; NULL: nobody is {position, heading, size}
    along_mps DOUBLE,                 -- its speed along the road, positive away from the ego; NULL: nobody is, or not known {velocity}
    need_mps2 DOUBLE NOT NULL,        -- the hardest deceleration that anybody in the way asked for within the last 2 s, to stay 5 m off him; 0: nobody did {velocity}
    known BOOLEAN NOT NULL            -- within the last 2 s nobody else can have been in the way: everybody near enough has a place, and no one beside the way could step into it {position}
);

-- lifetime: part
CREATE TABLE neighbour (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    k INTEGER NOT NULL,               -- see step
    seg INTEGER NOT NULL,             -- see step
    object_id VARCHAR NOT NULL,       -- an actor in the corridor's strip, at most 30 m away, box to box
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    chain_id INTEGER NOT NULL,        -- the ego's running chain
    ahead_m DOUBLE NOT NULL,          -- its front to the ego's front, positive ahead {position}
    gap_ahead_m DOUBLE NOT NULL,      -- its rear to the ego's front {position, heading, size}
    gap_behind_m DOUBLE NOT NULL,     -- the ego's rear to its front {position, heading, size}
    d_m DOUBLE NOT NULL,              -- see pair {position}
    lat_half_m DOUBLE NOT NULL,       -- see pair {heading, size}
    half_width_m DOUBLE NOT NULL,     -- see pair
    heading_diff_rad DOUBLE NOT NULL, -- see pair {heading}
    side VARCHAR NOT NULL,            -- [side] of the ego {position}
    gap_m DOUBLE NOT NULL,            -- see beside {position, heading, size}
    clearance_m DOUBLE,               -- see pair {position, heading, size}
    ego_speed_mps DOUBLE,             -- ego's speed {velocity}
    speed_mps DOUBLE,                 -- its speed {velocity}
    ego_left_mps DOUBLE               -- ego's speed across the corridor, to the left of the way that this leads: from its velocity where that is known, else from speed and heading {velocity}
);

-- lifetime: part
CREATE TABLE follower (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; no row: not known
    lane VARCHAR NOT NULL,            -- [lane_of_follower] one row each {position}
    object_id VARCHAR,                -- nearest vehicle behind in it, within 200 m, that heads as the ego does; NULL: nobody there
    gap_m DOUBLE,                     -- its front to the ego's rear along the corridor; negative: alongside {position, heading, size}
    speed_mps DOUBLE,                 -- its speed {velocity}
    closing_mps DOUBLE                -- its speed minus the ego's {velocity}
);

-- lifetime: part
CREATE TABLE lane_crossing (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    from_chain_id INTEGER NOT NULL,   -- running chain before
    to_chain_id INTEGER NOT NULL,     -- running chain from here on
    to_lanelet_id VARCHAR,            -- its lanelet
    t_ns BIGINT NOT NULL,             -- first step with the centre in another lane of the same direction
    k INTEGER NOT NULL,               -- see step
    t_before_ns BIGINT NOT NULL,      -- the step before {position}
    seen BOOLEAN NOT NULL,            -- no hole lies between the two {position}
    side INTEGER NOT NULL             -- 1 to the left, -1 to the right {position}
);

-- lifetime: part
CREATE TABLE ego_road (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- a running chain, see chain
    road INTEGER NOT NULL,            -- 1.. in time order; chains that the ego changed between, over a line, are one road {position}
    offset_m DOUBLE NOT NULL          -- add to a station of the chain for the station along the road {position}
);

-- lifetime: part
CREATE TABLE lane_change (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order; from a lane to one beside it that is driven the same way; after those, the changes out of restricted ground
    t_start_ns BIGINT NOT NULL,       -- first step with a corner more than 0.05 m over the boundary {position}
    begin_seen BOOLEAN NOT NULL,      -- the step before it is there and inside the lane {position}
    t_cross_ns BIGINT,                -- first step with the centre over it; NULL: the log or a hole ends before (and half a metre was over it), or it crossed in a hole {position}
    t_done_ns BIGINT,                 -- first step wholly in the new lane; NULL: the log or a hole ends before {position}
    side VARCHAR NOT NULL,            -- [side] {position}
    from_lanelet_id VARCHAR NOT NULL, -- the lane left, at t_start
    to_lanelet_id VARCHAR,            -- the lane entered, at t_cross; NULL: not seen
    merge BOOLEAN,                    -- out of a lane that only leads onto this one (entry, on-ramp, or one that ends); NULL: not known {position}
    ego_speed_mps DOUBLE,             -- ego's speed at t_start {velocity}
    leader_id VARCHAR,                -- nearest vehicle ahead in the new lane at t_start; NULL: nobody, see known {position}
    leader_gap_m DOUBLE,              -- ego front to its rear {position, heading, size}
    leader_speed_mps DOUBLE,          -- its speed {velocity}
    follower_id VARCHAR,              -- nearest vehicle behind in the new lane at t_start, or beside the ego there and still when its centre goes over the line; NULL: nobody, see known {position}
    follower_gap_m DOUBLE,            -- its front to the ego's rear; negative: alongside {position, heading, size}
    follower_gap_before_m DOUBLE,     -- the same gap at the step before t_start: the ego comes over the line between the two; NULL: not seen {position, heading, size}
    follower_speed_mps DOUBLE,        -- its speed {velocity}
    follower_decel_mps2 DOUBLE,       -- its strongest mean deceleration over 0.5 s in the 4 s after t_start (positive: it slowed); NULL: not seen whole, or nobody {velocity}
    known BOOLEAN NOT NULL,           -- every vehicle nearby was placed at t_start: nobody else is leader or follower {position}
    unseen_m DOUBLE                   -- whoever else may be behind in the new lane at t_start, for he was not placed, is at least so far away; infinite: nobody; NULL: the ego was not placed {position}
);

-- lifetime: part
CREATE TABLE cut_in (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order; another vehicle moves from beside into the running lane ahead of the ego, or may: for a second or longer it cannot be told who is ahead
    object_id VARCHAR,                -- that vehicle; NULL: somebody may have, and of the rest only ego_speed_mps (the highest) and free_m may be known
    t_ns BIGINT NOT NULL,             -- first step at which it cannot be told, or first step with its box more than 0.3 m inside the running lane, from at most 0.05 m; within 45 degrees of it, at most 150 m ahead. Of one that overtook the ego, and was further in all the time that its front was ahead: first step as the nearest one ahead (lead.joined)
    begin_seen BOOLEAN NOT NULL,      -- the step before is there and it is placed: else it may have come in earlier {position}
    side VARCHAR,                     -- [side] where it came from {position}
    gap_m DOUBLE,                     -- ego front to its rear at that step, along the corridor {position, heading, size}
    ego_speed_mps DOUBLE,             -- ego's speed then {velocity}
    speed_mps DOUBLE,                 -- its speed then {velocity}
    in_place_ns BIGINT,               -- first step with its centre in the running lane; NULL: never {position}
    free_m DOUBLE                     -- where it cannot be told who is ahead: so far, at the least, nobody is, at every such step; NULL: not known {position, heading, size}
);

-- lifetime: part
CREATE TABLE beside (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which the two boxes overlap along the corridor, or after which they go past each other before the next; or may overlap: then the rest is NULL
    object_id VARCHAR NOT NULL,       -- any other actor
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    side VARCHAR,                     -- [side] of the ego {position}
    gap_m DOUBLE,                     -- gap between the two boxes across the corridor; negative: overlap; past each other between two steps: the mean of those at both {position, heading, size}
    clearance_m DOUBLE,               -- box to box, see pair; past each other between two steps: the gap across {position, heading, size}
    blur_m DOUBLE,                    -- how much nearer the two may have been between this step and its neighbours, if both swerve by 3 m/s2; 0 in a log of about ten samples a second and more {position}
    ahead_m DOUBLE,                   -- its front to the ego's front along the corridor, positive ahead {position}
    ego_speed_mps DOUBLE,             -- ego's speed {velocity}
    speed_mps DOUBLE,                 -- its speed {velocity}
    ego_lat_mps DOUBLE,               -- ego's speed across the corridor, towards it positive {velocity}
    lat_mps DOUBLE,                   -- its speed across the corridor, towards the ego positive {velocity}
    cycle_lane VARCHAR,               -- [marking + unsaid] it is on a cycle lane of the carriageway: the marking between that and the lane of motor vehicles, unsaid where the map has none; NULL: it is on none {position}
    along BOOLEAN,                    -- it heads as the corridor runs (within 45 degrees: who crosses it at 89 does not go the same way) {position}
    on_carriageway BOOLEAN,           -- its box reaches into the ego's running lane or a drivable lane beside it, or its centre is on any, or on a cycle lane that adjoins one (a verge, kerb or footway between them makes it a track); NULL: not known
    on_strip BOOLEAN                  -- its centre is beside the drivable lanes, with no kerb or verge between: on a shoulder, stop, border, parking, restricted or cycle lane; NULL: not known, as behind a border, which may be a kerb {position}
);

-- lifetime: part
CREATE TABLE passing (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order; ego and another road user that heads the same way change their order, or a vehicle that cannot be placed may have
    object_id VARCHAR NOT NULL,       -- the other
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    ego_passes BOOLEAN,               -- the ego's front got ahead of its front by more than 0.25 m; false: its front got ahead of the ego's; NULL: one of the two, or nothing: it may be beside the ego and has no place {position}
    t_ns BIGINT NOT NULL,             -- first step in the new order; the last one at which it may be beside the ego
    t_unseen_ns BIGINT,               -- last step in the old order, if the order may have changed unseen since then; the first one at which it may be beside the ego; NULL: t_ns is when it changed {position}
    t_from_ns BIGINT NOT NULL,        -- first step of the stretch around t_ns in which they are beside each other {position}
    t_to_ns BIGINT NOT NULL,          -- last one {position}
    side VARCHAR,                     -- [side] where the other is, seen from the ego; NULL: ego_passes is {position}
    gap_m DOUBLE,                     -- least gap across the corridor in that stretch; NULL: they are beside each other in no step that was seen {position, heading, size}
    whole BOOLEAN NOT NULL,           -- the stretch was seen from before its first step until after its last, without a hole: else gap_m is only the least that was seen {position}
    same_lane BOOLEAN,                -- its centre is in the ego's running lane at t_ns: the ego passes round it; NULL: ego_passes is {position}
    ego_speed_mps DOUBLE,             -- ego's speed at t_ns {velocity}
    speed_mps DOUBLE                  -- its speed at t_ns; standing: at most 0.5 {velocity}
);

-- lifetime: part
CREATE TABLE line_step (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step with a corner of the ego more than 0.05 m over a boundary of its running lane; none inside a junction, and none where its box is not placed (ego_state.front_s_m is NULL)
    side VARCHAR NOT NULL,            -- [side] that boundary; one row each {position}
    out_m DOUBLE NOT NULL,            -- how far the furthest corner is over it {position, heading, size}
    marking VARCHAR,                  -- [marking] see lane_boundary: as seen from the running lane, at the ego's centre; NULL: the map does not state it
    forbidden BOOLEAN,                -- from this lane it must not be crossed: solid, or double with the nearer one solid; NULL: marking not known
    beyond VARCHAR,                   -- [lane_type + same + opposing] what lies beyond it (see lane_beside): same or opposing (a drivable lane, by its direction), else its lane_type; NULL: nothing in the map {position}
    middle BOOLEAN,                   -- it is the middle of the road: traffic beyond it comes the other way; NULL: it may be, as on the overtaking side the map has nothing beyond it (and the road is no motorway), or a gap of more than 1 m or a strip that it calls a median, which may be a central reservation
    t_since_ns BIGINT NOT NULL,       -- first step of this stretch over it; a line is one stretch, whichever of its two lanes is the running one {position}
    begin_seen BOOLEAN NOT NULL,      -- the step before that is there and inside {position}
    manoeuvre BOOLEAN NOT NULL,       -- the stretch is (part of) a lane change or an overtake, see lane_departure {position}
    t_astride_ns BIGINT,              -- first step since when the box has been on the line, whichever of its two lanes is the running one: more than 0.05 m of it on either side; NULL: at this step it is not {position}
    astride_begin_seen BOOLEAN,       -- the step before that is there; NULL: not on the line {position}
    changes BOOLEAN,                  -- in that time the centre gets from one side of the line to the other, and stays there: a lane change, or a part of an overtake; NULL: the end is not seen and it may go back, or not on the line {position}
    overtaking BOOLEAN,               -- the ego is overtaking somebody, or going round somebody on foot in its lane, from 10 m and 5 s at the speed at which it comes nearer (at least 30 m) before it to the same past it; NULL: it may be, but that one is lost meanwhile, or the side to overtake on is not known {position}
    passing_id VARCHAR,               -- a vehicle standing, or a cyclist or animal at most at 4.47 m/s, in the running lane or on its edge, that is being passed (from 10 m and 5 s at the ego's speed, at least 30 m, ahead of the ego to 10 m and 5 s behind) and leaves too little room to be passed on this side of the line; NULL: none, or in this stretch the ego overtakes somebody that drives {position}
    passing_known BOOLEAN NOT NULL,   -- nobody else may be passed: everybody near was placed, or is not in plain view and the lane ahead is {position}
    access BOOLEAN                    -- within 30 m the ego goes on to, or comes from, a way beside the road on the far side of the line: it leaves the lanes at 20 mph or less, and turns off, stands there or gets further than 10 m from the running lane's centre line; a shoulder, bay or cycle lane of the same road is no such way, and who was or gets back by 0.25 m on the same lane was on no such way; NULL: not known, as where it turns off and comes back the other way
);

-- lifetime: part
CREATE TABLE overtake_place (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- see overtake
    junction_m DOUBLE,                -- ego's front at t0 to the next junction on its way, along the corridor; infinite: none within the corridor; negative: inside one {position}
    crossing_m DOUBLE,                -- the same to the next pedestrian crossing {position}
    marking_out VARCHAR,              -- [marking] of the boundary crossed at t0, seen from the running lane; NULL: the map does not state it {position}
    marking_back VARCHAR,             -- [marking] of the boundary crossed back at t3, seen from the overtaking lane; NULL: the map does not state it, or never back {position}
    no_overtaking BOOLEAN,            -- a no-overtaking sign holds at t0, or where the ego's front draws level with the rear of a vehicle that it passes, until its end is said or the next junction; NULL: the map has no such signs at all, or neither a sign nor a junction on the way behind: one may stand further back, or where the map begins {position}
    rear_id VARCHAR,                  -- vehicle behind or beside, in the overtaking lane or moving into it, at t0; NULL: nobody {position, heading, size}
    rear_gap_m DOUBLE,                -- its front to the ego's rear; negative: alongside {position, heading, size}
    rear_ttc_s DOUBLE,                -- time until it gets to the ego's rear at the ego's speed and the highest of its own in the 2 s before; infinite: never, or nobody; 0: alongside {position, velocity}
    rear_known BOOLEAN NOT NULL,      -- every vehicle behind or beside, within 200 m, was placed, and its speed known {position, heading, size}
    rear_unseen_m DOUBLE              -- who was not placed, and may be behind or beside, is at least so far away; NULL: there is none such, or one that was placed has no class or speed {position, heading, size}
);

-- lifetime: part
CREATE TABLE following (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- every step
    object_id VARCHAR,                -- of those ahead the nearest that it follows, else the lead; NULL: nobody ahead, or cannot be told
    follows BOOLEAN,                  -- the ego is behind it and goes its way: in its lane, no overtake or lane change (of up to 10 s astride the line) under way, and the other neither oncoming nor beside: what stands is in the way of the ego's box now and when the ego is there, what moves is in its way too, or has its centre in the lane and is more than 3 s from being passed; NULL: not known {position}
    gap_m DOUBLE,                     -- see lead {position, heading, size}
    ego_speed_mps DOUBLE,             -- ego's speed {velocity}
    speed_mps DOUBLE,                 -- its speed {velocity}
    joined_ns BIGINT,                 -- see vehicle_ahead; since when the gap is new; NULL: it was ahead before, or how it came was not seen {position}
    let_in_ns BIGINT,                 -- see vehicle_ahead; since when the gap is new, if it was not the ego that changed lanes {position}
    free_m DOUBLE                     -- see vehicle_ahead: where it cannot be told, nobody is nearer than this {position, heading, size}
);
