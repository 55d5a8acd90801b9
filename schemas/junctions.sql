-- The library, third part: where ways meet. Junctions, stop lines, crossings, conflict areas, standing still.
-- As in derived.sql: what is present but cannot be placed is a row with NULL, never an absent row.

-- lifetime: part
CREATE TABLE meeting (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    actor_id VARCHAR NOT NULL,        -- its box: its own, or that of its trailer
    cell_m DOUBLE NOT NULL,           -- width of the drive's grid cells: as far as two boxes reach {position}
    cell BIGINT NOT NULL,             -- visit of that box: the cell its centre is in {position}
    slot INTEGER NOT NULL,            -- the 10 s {position}
    heading INTEGER NOT NULL,         -- the 5 degrees of heading {heading}
    object_id VARCHAR NOT NULL,       -- another actor that moves at some time
    object_cell BIGINT NOT NULL,      -- its visit, the same way: the boxes around both overlap, the headings may differ by more than 20 degrees {position}
    object_slot INTEGER NOT NULL,     -- the 10 s {position}
    object_heading INTEGER NOT NULL   -- the 5 degrees of heading {heading}
);

-- lifetime: part
CREATE TABLE swept_box (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- an actor of meeting, ego or not, in the cells of its visits and those around them
    t_ns BIGINT NOT NULL,             -- a sample with position, heading and size, or a moment between two that are continuous
    t_sample_ns BIGINT NOT NULL,      -- the sample next to it {position}
    cell BIGINT NOT NULL,             -- visit of that sample, see meeting {position}
    slot INTEGER NOT NULL,            -- the 10 s {position}
    heading INTEGER NOT NULL,         -- the 5 degrees of heading {heading}
    ix INTEGER NOT NULL,              -- column of the drive's grid that the box's centre is in at that moment {position}
    iy INTEGER NOT NULL,              -- row {position}
    cell_m DOUBLE NOT NULL,           -- width of that grid's cells {position}
    x_m DOUBLE NOT NULL,              -- centre of the box {position}
    y_m DOUBLE NOT NULL,              -- its other coordinate {position}
    z_m DOUBLE,                       -- height, see state_dynamics {position}
    travel_rad DOUBLE NOT NULL,       -- direction in which it travels, see state_dynamics {heading}
    half_length_m DOUBLE NOT NULL,    -- half the box's length {size}
    half_width_m DOUBLE NOT NULL,     -- half its width {size}
    cos_yaw DOUBLE NOT NULL,          -- cosine of its heading {heading}
    sin_yaw DOUBLE NOT NULL,          -- sine {heading}
    t_before_ns BIGINT,               -- the moment before; NULL: the track begins, or there was a hole {position}
    t_after_ns BIGINT                 -- the moment after; NULL: it ends, or there is a hole {position}
);

-- lifetime: part
CREATE TABLE common_ground (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    actor_id VARCHAR NOT NULL,        -- its box: its own, or that of its trailer
    object_id VARCHAR NOT NULL,       -- another actor
    t_ego_ns BIGINT NOT NULL,         -- a moment of that box, see swept_box
    t_object_ns BIGINT NOT NULL       -- a moment of the other's box, at most 10 s apart, at which it covers the same ground, at more than 20 degrees
);

-- lifetime: part
CREATE TABLE conflict (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order; the ground swept by another's box and by the ego's (its trailer's with it) crosses or merges at more than 20 degrees (its way against the ego's where that comes nearest), at most 10 s apart; who stands all the while it is on it is in the way and no partner, nor who lacks position, heading or size, nor who takes that ground on the same course (to 20 degrees): see passage_conflict
    object_id VARCHAR NOT NULL,       -- the other actor
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    t_ego_in_ns BIGINT NOT NULL,      -- first step at which the ego's box is on ground that the other's box was or will be on (the conflict area) {position}
    t_ego_out_ns BIGINT NOT NULL,     -- last one {position}
    t_object_in_ns BIGINT NOT NULL,   -- first sample of the other on ground that the ego's box was or will be on {position}
    t_object_out_ns BIGINT NOT NULL,  -- last one {position}
    pet_s DOUBLE NOT NULL,            -- post-encroachment time: later entry minus earlier exit, both taken between samples, as near to each other as the speeds allow; negative: both in it at once {position, velocity}
    pet_at_most BOOLEAN NOT NULL,     -- it was no more than that: a track begins, or goes on after a hole, where the later one enters, or ends where the earlier one leaves {position}
    ego_first BOOLEAN NOT NULL,       -- the ego entered first (a tie: true) {position}
    angle_rad DOUBLE NOT NULL,        -- where the other enters: its heading against the ego's way there, -pi..pi: near pi oncoming, negative: it comes from the left {heading}
    ego_speed_mps DOUBLE,             -- ego's speed on entering {velocity}
    speed_mps DOUBLE,                 -- its speed on entering {velocity}
    decel_mps2 DOUBLE,                -- its strongest mean deceleration over 0.5 s from 4 s before the ego's entry until its own entry (positive: it slowed); that of an impact with the ego does not count; NULL: not seen whole, or it entered before that {velocity}
    junction_id VARCHAR,              -- junction that the ego's front is in on entering the area; NULL: none, or no map
    crossing_id VARCHAR               -- pedestrian crossing that the ego's box is on then; NULL: none, or no map
);

-- lifetime: part
CREATE TABLE impact (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- another actor
    t_ns BIGINT NOT NULL              -- first step at which it or the ego loses or gains speed by 12 m/s2 or more since the step before (somebody who may be on foot: loses) with the boxes 0.5 m or less apart, or a step up to 0.5 s before at which that began
);

-- lifetime: part
CREATE TABLE forced_braking (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- another actor that slowed by more than 1.5 m/s2 (mean over 0.5 s, or one period), beginning at most 4 s before the ego came onto ground that its way led to at an angle (more than 20 degrees, see conflict), or earlier if it came head on (within 30 degrees) and stood before the ego had left that ground (where the ego was out in the opposing lane meanwhile, however gently it braked): its way as it drove it, straight on where that ends; at the speed that it had it would have come there within 4 s of the ego; it came after the ego, or never
    actor_class VARCHAR,              -- [actor_class] see actor {class}
    t_from_ns BIGINT NOT NULL,        -- it begins to brake {position}
    t_to_ns BIGINT NOT NULL,          -- last sample at which it still does {position}
    t_ego_in_ns BIGINT NOT NULL,      -- first step of the ego on that ground, from t_from on {position}
    t_ego_out_ns BIGINT NOT NULL,     -- last one {position}
    speed_mps DOUBLE NOT NULL,        -- its speed at t_from {velocity}
    decel_mps2 DOUBLE NOT NULL,       -- its strongest mean deceleration over 0.5 s (or one period) until the ego has left, and before an impact of the two {velocity}
    pet_s DOUBLE NOT NULL,            -- post-encroachment time that there would have been at that speed; negative: both there at once {position, velocity}
    angle_rad DOUBLE NOT NULL,        -- its way against the ego's where it would have come to it first, see conflict {heading}
    other_cause VARCHAR,              -- [braking_cause] why it may not be the ego that it braked for; NULL: nothing else is seen
    waited BOOLEAN                   -- it stood before the ego had left that ground and went on (faster than 1.5 m/s) at most 2 s before or 5 s after that; false: it did not stand, or stood on; NULL: it went on earlier, or was not seen to go on {position, velocity}
);

-- lifetime: part
CREATE TABLE way_mark (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- a running chain, see chain
    kind VARCHAR NOT NULL,            -- [mark_kind]
    mark_id VARCHAR NOT NULL,         -- its id in the map; a traffic light within 30 m of no stop line is a stop line where it stands, by its own id, one inside a junction where that begins
    lanelet_id VARCHAR NOT NULL,      -- the first lanelet of the chain that it lies on
    seq_first INTEGER NOT NULL,       -- that lanelet, see chain
    seq_last INTEGER NOT NULL,        -- the last one
    s_start_m DOUBLE NOT NULL,        -- chain station of its start
    s_end_m DOUBLE NOT NULL,          -- chain station of its end
    control VARCHAR,                  -- [control] the first of these that holds for the way there: of a junction from 50 m before it to its connecting lanelets, of a stop line within 30 m, of a crossing (lights only) from 15 m before to 30 m after; not across another junction; NULL: none
    signal_id VARCHAR,                -- that signal: of several the one that is not for another turn, whose states were recorded, for the ego's turn, and nearest
    lights STRUCT(signal_id VARCHAR, fit VARCHAR)[] -- [fit: light_fit] of a traffic light all heads, by id, and for whom each is: for the ego's turn by its connecting lanelet or its arrow; maybe, where the turn is not driven to its end, or called one or the other
);

-- lifetime: part
CREATE TABLE near_mark (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- a chain in whose strip the ego is
    kind VARCHAR NOT NULL,            -- [mark_kind] see way_mark
    mark_id VARCHAR NOT NULL,         -- see way_mark
    s_start_m DOUBLE NOT NULL,        -- see way_mark
    t_ns BIGINT NOT NULL,             -- a step with the front bumper 10 m before it or further and the rear one at most 10 m past it, or one before that not
    k INTEGER NOT NULL,               -- see step
    seg INTEGER NOT NULL,             -- see step
    front_m DOUBLE NOT NULL,          -- front bumper beyond its start; negative: before it
    rear_m DOUBLE NOT NULL,           -- rear bumper beyond its end, a trailer's where the ego draws one
    front_before_m DOUBLE,            -- front_m at the last step before that was placed on this chain; NULL: none
    rear_before_m DOUBLE,             -- rear_m then
    joined BOOLEAN NOT NULL,          -- that is the step before, without a hole
    running BOOLEAN NOT NULL          -- the chain is the ego's running chain at this step, and it is not beside the lane by more than 4 m
);

-- lifetime: part
CREATE TABLE signal_phase (
    drive_id VARCHAR NOT NULL,        -- the drive
    signal_id VARCHAR NOT NULL,       -- see signal_state
    t_from_ns BIGINT NOT NULL,        -- the state holds from here
    t_to_ns BIGINT,                   -- to before here; NULL: no end
    state VARCHAR                     -- [light_state] see signal_state; NULL: not known, also beyond the last sample of a light that was recorded once a second or oftener
);

-- lifetime: part
CREATE TABLE mark_phase (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- see way_mark
    kind VARCHAR NOT NULL,            -- [mark_kind] see way_mark
    mark_id VARCHAR NOT NULL,         -- see way_mark
    s_start_m DOUBLE NOT NULL,        -- see way_mark
    t_from_ns BIGINT NOT NULL,        -- its lights show the state from here
    t_to_ns BIGINT,                   -- to before here; NULL: no end
    state VARCHAR,                    -- [light_state] what they show for the ego's turn, see signal_state: its arrow, a dark one leaves it to the full light; NULL: not known, or heads that may be for that turn differ
    state_before VARCHAR,             -- [light_state] the state before; NULL: not known
    begin_seen BOOLEAN NOT NULL,      -- both states are known: the change was seen
    t_before_ns BIGINT                -- since when the state before held; NULL: not seen
);

-- lifetime: part
CREATE TABLE junction_passage (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order; the ego goes through a junction, entered by a lane that ends there
    junction_id VARCHAR NOT NULL,     -- the junction
    t_in_ns BIGINT,                   -- first step with the ego's front bumper in it; NULL: the log, or a hole, begins inside {position}
    t_out_ns BIGINT,                  -- first step with its rear bumper, or that of its trailer, past it; NULL: the log, or a hole, ends inside, or the trailer is not seen then {position}
    t_first_ns BIGINT NOT NULL,       -- first step with its centre on a connecting lanelet {position}
    t_last_ns BIGINT NOT NULL,        -- last one {position}
    from_lanelet_id VARCHAR,          -- lanelet before it
    via_lanelet_id VARCHAR NOT NULL,  -- the (first) connecting lanelet
    to_lanelet_id VARCHAR,            -- lanelet after it
    turn VARCHAR,                     -- [turn] by the change of heading from one to the other (straight within 30 degrees, u_turn beyond 150); NULL: not seen from its front's way in until its centre was on the lane after it {position}
    turn_rad DOUBLE,                  -- that change, left positive {heading}
    straightest_rad DOUBLE,           -- that change on the straightest of all ways out of the road that the ego came by; NULL: that road is not known {heading}
    across BOOLEAN,                   -- the turn crosses the oncoming traffic (right where the left is driven on; any u_turn); NULL: handedness or turn not known {position, heading, velocity}
    branches INTEGER NOT NULL,        -- roads that meet in the junction: 2 is no junction for a driver
    control VARCHAR,                  -- [control + none] what governs the ego's way in, see way_mark; NULL: not known, as the map has none of these anywhere, or begins less than 50 m before the junction
    minor BOOLEAN                     -- by control stop or give_way the ego's road is the lesser one; NULL: control not known {position}
);

-- lifetime: part
CREATE TABLE passage_conflict (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- see junction_passage; one row for each of its relations
    relation VARCHAR NOT NULL,        -- [relation] oncoming (from the road ahead, also where it leads off at an angle and no other is as straight; such a one is from_left or from_right as well), from_left, from_right, ahead_going (a cyclist, animal or vehicle along the ego's own road that goes on while the ego turns), by their heading 2 s before against the ego's on its way in; pedestrian (on foot, in the junction or within 12 m before or past it: over the roads that the ego turns out of and into); who has no class may be either {position}
    object_id VARCHAR,                -- of those before whom the ego went (or into whom: on foot still there as it came, driven not yet past its front), the one with the least PET; NULL: nobody
    actor_class VARCHAR,              -- [actor_class] see road_user; what it is decides whether a low PET breaks a rule {class}
    pet_s DOUBLE,                     -- its PET, also where reason says that another one may be lower; infinite: nobody within 10 s, or until the log ends, 4 s later at least; NULL: not known {position, velocity}
    decel_mps2 DOUBLE,                -- see conflict; 0 where nobody; NULL: not known {velocity}
    braked_id VARCHAR,                -- somebody of this relation (by its heading as it began) who braked where its way led onto the ego's, whether it came or not, see forced_braking: of several one without another cause, then the hardest; NULL: nobody {position, velocity}
    braked_pet_s DOUBLE,              -- PET that there would have been at its speed {position, velocity}
    braked_mps2 DOUBLE,               -- how hard it braked {velocity}
    braked_cause VARCHAR,             -- [braking_cause] what else it may have braked for, see forced_braking; NULL: nothing
    reason VARCHAR                    -- why another one cannot be ruled out: somebody without position, heading or size, or whose track begins or ends within 30 m, or as far away as he comes from or goes to in that time; the log, a hole or the sensor's range ends too soon; NULL: nobody else
);

-- lifetime: part
CREATE TABLE stop_line_crossing (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order; the ego's front goes over a stop line of its running lane; again only if it was 0.5 m back in between
    stop_line_id VARCHAR NOT NULL,    -- the line; where a light has none, the light itself, see way_mark (a stop or give-way sign without a line: no row, see junction_passage)
    lanelet_id VARCHAR NOT NULL,      -- the lanelet that it crosses
    control VARCHAR,                  -- [control] the signal that the line belongs to, see way_mark; NULL: the map has none for it
    signal_id VARCHAR,                -- that signal
    t_ns BIGINT NOT NULL,             -- first step with the ego's front past the line
    begin_seen BOOLEAN NOT NULL,      -- the step before is there, with the front before the line {position}
    speed_mps DOUBLE,                 -- ego's speed at t {velocity}
    state VARCHAR,                    -- [light_state] what the light shows for the ego's turn at t, see mark_phase; NULL: not known
    state_before VARCHAR,             -- [light_state] its state before the present one; NULL: not known
    t_state_ns BIGINT,                -- since when it has been so; NULL: not known {position}
    amber_front_m DOUBLE,             -- at the onset of the amber that it crossed on, or of the one before that red: ego's front to the line; NULL: none seen {position, heading, size}
    amber_speed_mps DOUBLE,           -- ego's speed then {velocity}
    slowest_mps DOUBLE,               -- least speed with the front 0 to 3 m before the line, or at the last step before it if no step fell there; NULL: never seen there, or the speed not known {velocity}
    slowest_front_m DOUBLE,           -- ego's front to the line at that step {position, heading, size}
    stood_s DOUBLE                    -- longest time that it stood (at most 0.1 m/s) with the front 0 to 1 m before the line, as far as seen; 0: it did not; NULL: the speed there is not known {position, velocity}
);

-- lifetime: part
CREATE TABLE crossing_occupancy (
    drive_id VARCHAR NOT NULL,        -- the drive
    crossing_id VARCHAR NOT NULL,     -- a pedestrian crossing of the map
    object_id VARCHAR NOT NULL,       -- somebody on foot (or of a class not known) whose centre is on it
    along_road INTEGER NOT NULL,      -- which half: 1 on lanes driven along the reference line, -1 against it {position}
    t_from_ns BIGINT NOT NULL,        -- first sample there {position}
    t_to_ns BIGINT NOT NULL           -- last sample there {position}
);

-- lifetime: part
CREATE TABLE crossing_passage (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order; the ego goes over a pedestrian crossing, forwards or reversing onto it
    crossing_id VARCHAR NOT NULL,     -- the crossing
    kind VARCHAR,                     -- [crossing_kind] as the map says, or signalled where a light governs it; NULL: the map does not state it
    t_in_ns BIGINT,                   -- first step with its front on it, reversing with its rear; NULL: the log, or a hole, begins with the ego on it {position}
    t_out_ns BIGINT,                  -- first step with its rear past it, or its front back before it if it came reversing; NULL: the log, or a hole, ends with the ego on it {position}
    on_id VARCHAR,                    -- somebody on foot on the ego's half at any time from t_in to t_out, or on the other one if its middle was over that as well, the first of them; NULL: nobody {position}
    t_on_ns BIGINT,                   -- since when {position}
    coming_id VARCHAR,                -- somebody on foot on the other half at t_in who goes straight on to the ego's (within 3 s: longer is a wait on an island); NULL: nobody {position}
    coming_known BOOLEAN NOT NULL,    -- of everybody on the other half at t_in it is known whether they came from the ego's, leave there, or come; not where the ego's side reached over it {position}
    waiting_id VARCHAR,               -- somebody on foot who stands (0.5 m/s) off the lanes it lies on, within 2 m of its end on the ego's side, throughout the 2 s before t_in; NULL: nobody {position}
    waiting_known BOOLEAN NOT NULL,   -- nobody without a class stands there so {position}
    known BOOLEAN NOT NULL,           -- everybody on foot nearby was placed from 2 s before t_in to t_out: no track with a hole, or that begins or ends within 30 m then; nobody without a class is on it {position}
    signal_id VARCHAR,                -- the light for vehicles, see way_mark; NULL: none in the map
    state VARCHAR,                    -- [light_state] its state at t_in; NULL: not known
    stood_before BOOLEAN              -- the ego stood within 5 m before it during the 10 s before t_in; NULL: not seen, or it came reversing {position, velocity}
);

-- lifetime: part
CREATE TABLE standstill (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order; the ego stands (below 0.1 m/s, by its way from step to step where the log has no speed) for at least 1 s
    t_start_ns BIGINT NOT NULL,       -- first step {velocity}
    t_end_ns BIGINT NOT NULL,         -- last step {velocity}
    begin_seen BOOLEAN NOT NULL,      -- it was seen to stop: the step before is there and it moves {position}
    end_seen BOOLEAN NOT NULL,        -- it was seen to start again {position}
    road_type VARCHAR,                -- [road_type] see ego_state
    lanelet_id VARCHAR,               -- see ego_lane; NULL: on none
    junction_id VARCHAR,              -- the junction that some of its box is in, by front or rear bumper; NULL: none
    junction_clear_m DOUBLE,          -- what its rear has yet to go to be out of that junction; NULL: none, or not placed on its way {position, heading, size}
    junction_inside_m DOUBLE,         -- how much of its length, a trailer's with it, is in that junction; NULL: none, or not placed on its way {position, heading, size}
    turn VARCHAR,                     -- [turn] the turn that the ego makes there, see junction_passage; NULL: none, or not known {position}
    across BOOLEAN,                   -- see junction_passage {position, heading, velocity}
    junction_m DOUBLE,                -- front bumper to the next junction along its way; infinite: none within the corridor; NULL: not known {position}
    crossing_id VARCHAR,              -- a pedestrian crossing that some of its box is on; NULL: none
    crossing_clear_m DOUBLE,          -- what its rear has yet to go to be off it; NULL: none {position, heading, size}
    stop_line_id VARCHAR,             -- next stop line ahead within 20 m, or at most 3 m behind its front; NULL: none
    stop_line_m DOUBLE,               -- its front to that line; negative: over it {position}
    control VARCHAR,                  -- [control] see stop_line_crossing
    state VARCHAR,                    -- [light_state] the light's state at t_start; NULL: not known, or no light
    ahead_id VARCHAR,                 -- nearest vehicle ahead in its lane at t_start; NULL: nobody, see ahead_known {position}
    ahead_gap_m DOUBLE,               -- gap to it {position, heading, size}
    ahead_speed_mps DOUBLE,           -- its speed {velocity}
    ahead_known BOOLEAN NOT NULL,     -- see lead {position}
    blocking_id VARCHAR,              -- of the vehicles ahead in its lane while it stood the nearest one, one at 1 m/s or less before a quicker one; NULL: nobody, see blocking_known {position}
    blocking_gap_m DOUBLE,            -- the least gap to it {position, heading, size}
    blocking_speed_mps DOUBLE,        -- its speed then {velocity}
    blocking_known BOOLEAN NOT NULL,  -- see lead, at every step {position}
    idle_ns BIGINT NOT NULL,          -- for how long at least it stood with nobody in its way within 10 m who stood or moved up at 1 m/s or less, see in_way {velocity}
    idle_at_most_ns BIGINT NOT NULL   -- for how long at most: as long as that is not known counts too {velocity}
);
