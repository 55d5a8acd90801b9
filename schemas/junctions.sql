-- The derived tables, third part: junctions, stop lines, crossings, conflict areas and standstills.
-- As in derived.sql, an actor that is present without a known position has a row with NULL, never an absent row.

-- lifetime: part
CREATE TABLE meeting (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    actor_id VARCHAR NOT NULL,        -- the ego, or a trailer of the ego, whose box this visit belongs to
    cell_m DOUBLE NOT NULL,           -- width of the drive's grid cells: the greatest distance between the centres of two boxes that touch {position}
    cell BIGINT NOT NULL,             -- visit of that box: the grid cell of its centre {position}
    slot INTEGER NOT NULL,            -- visit of that box: number of the 10 s slot {position}
    heading INTEGER NOT NULL,         -- visit of that box: number of the 5-degree heading step {heading}
    object_id VARCHAR NOT NULL,       -- another actor, which moves at some time
    object_cell BIGINT NOT NULL,      -- visit of the object: the grid cell; the boxes around both visits overlap, and the headings may differ by more than 20 degrees {position}
    object_slot INTEGER NOT NULL,     -- visit of the object: number of the 10 s slot {position}
    object_heading INTEGER NOT NULL   -- visit of the object: number of the 5-degree heading step {heading}
);

-- lifetime: part
CREATE TABLE swept_box (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- an actor of meeting, ego or not; only in the cells of its visits and the cells around them
    t_ns BIGINT NOT NULL,             -- a sample with position, heading and size, or an interpolated moment between two continuous samples
    t_sample_ns BIGINT NOT NULL,      -- time of the nearest sample {position}
    cell BIGINT NOT NULL,             -- visit of that sample, see meeting: the grid cell {position}
    slot INTEGER NOT NULL,            -- visit of that sample: number of the 10 s slot {position}
    heading INTEGER NOT NULL,         -- visit of that sample: number of the 5-degree heading step {heading}
    ix INTEGER NOT NULL,              -- column of the drive's grid that contains the box centre {position}
    iy INTEGER NOT NULL,              -- row of the drive's grid that contains the box centre {position}
    cell_m DOUBLE NOT NULL,           -- width of the drive's grid cells {position}
    x_m DOUBLE NOT NULL,              -- box centre, x {position}
    y_m DOUBLE NOT NULL,              -- box centre, y {position}
    z_m DOUBLE,                       -- height of the box centre, see state_dynamics {position}
    travel_rad DOUBLE NOT NULL,       -- direction of travel, see state_dynamics {heading}
    half_length_m DOUBLE NOT NULL,    -- half the box's length {size}
    half_width_m DOUBLE NOT NULL,     -- half the box's width {size}
    cos_yaw DOUBLE NOT NULL,          -- cosine of the heading {heading}
    sin_yaw DOUBLE NOT NULL,          -- sine of the heading {heading}
    t_before_ns BIGINT,               -- the previous moment; NULL: the track begins, or there was a hole {position}
    t_after_ns BIGINT                 -- the next moment; NULL: the track ends, or there is a hole {position}
);

-- lifetime: part
CREATE TABLE common_ground (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    actor_id VARCHAR NOT NULL,        -- the ego, or a trailer of the ego
    object_id VARCHAR NOT NULL,       -- another actor
    t_ego_ns BIGINT NOT NULL,         -- a moment of the box of actor_id, see swept_box
    t_object_ns BIGINT NOT NULL       -- a moment of the object's box, at most 10 s before or after, at which it covers the same ground at more than 20 degrees
);

-- lifetime: part
CREATE TABLE conflict (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the conflict, from 0, in time order: the areas swept by the ego (with its trailer) and another actor cross or merge, at more than 20 degrees between the two paths and at most 10 s apart. There is no conflict with an actor that stands all the time on the common ground, has no position, heading or size, or takes the same course within 20 degrees; see passage_conflict
    object_id VARCHAR NOT NULL,       -- the other actor
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    t_ego_in_ns BIGINT NOT NULL,      -- first step with the ego's box on the conflict area: the ground that the object's box was or will be on {position}
    t_ego_out_ns BIGINT NOT NULL,     -- last step with the ego's box on it {position}
    t_object_in_ns BIGINT NOT NULL,   -- first sample of the object on ground that the ego's box was or will be on {position}
    t_object_out_ns BIGINT NOT NULL,  -- last sample of the object on it {position}
    pet_s DOUBLE NOT NULL,            -- post-encroachment time (PET): later entry minus earlier exit, both interpolated between samples, as near to each other as the speeds allow; negative: both were on the area at once {position, velocity}
    pet_at_most BOOLEAN NOT NULL,     -- pet_s is only an upper bound: the later actor's track begins, or continues after a hole, where it enters, or the earlier actor's track ends where it leaves {position}
    ego_first BOOLEAN NOT NULL,       -- the ego entered first, or both at the same time {position}
    angle_rad DOUBLE NOT NULL,        -- the object's heading relative to the ego's path, where the later of the two enters, -pi..pi: near pi oncoming, negative: it comes from the left {heading}
    ego_speed_mps DOUBLE,             -- speed of the ego when it enters {velocity}
    speed_mps DOUBLE,                 -- speed of the object when it enters {velocity}
    decel_mps2 DOUBLE,                -- the object's strongest mean deceleration over 0.5 s, from 4 s before the ego's entry until its own entry (positive: it slowed), without an impact with the ego; NULL: not completely seen, or it entered before that {velocity}
    junction_id VARCHAR,              -- the junction in which the ego's front is when the ego enters the area; NULL: none, or no map
    crossing_id VARCHAR               -- the pedestrian crossing on which the ego's box is then; NULL: none, or no map
);

-- lifetime: part
CREATE TABLE impact (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- another actor
    t_ns BIGINT NOT NULL              -- first step with an impact: the boxes are 0.5 m or less apart, and the object or the ego has lost or gained speed by 12 m/s2 or more since the step before. For an actor that may be on foot, only a loss counts. If the change began up to 0.5 s before, it is that earlier step
);

-- lifetime: part
CREATE TABLE forced_braking (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- another actor that slowed by more than 1.5 m/s2 (mean over 0.5 s, or one period). Its path led at more than 20 degrees onto ground that the ego took first, see conflict. It began to brake at most 4 s before the ego was there; or earlier, if it came head on (within 30 degrees) and stood before the ego left (while the ego was out in the opposing lane, also after gentle braking). At its earlier speed it would have come there within 4 s of the ego: on its driven path, and straight on from its end
    actor_class VARCHAR,              -- [actor_class] see actor {class}
    t_from_ns BIGINT NOT NULL,        -- time at which the object begins to brake {position}
    t_to_ns BIGINT NOT NULL,          -- last sample at which the object still brakes {position}
    t_ego_in_ns BIGINT NOT NULL,      -- first step of the ego on the common ground, from t_from_ns on {position}
    t_ego_out_ns BIGINT NOT NULL,     -- last step of the ego on it {position}
    speed_mps DOUBLE NOT NULL,        -- speed of the object at t_from_ns {velocity}
    decel_mps2 DOUBLE NOT NULL,       -- the object's strongest mean deceleration over 0.5 s (or one period) until the ego has left, and before an impact of the two {velocity}
    pet_s DOUBLE NOT NULL,            -- post-encroachment time that would have resulted at speed_mps; negative: both there at once {position, velocity}
    angle_rad DOUBLE NOT NULL,        -- the object's path relative to the ego's, where the object would first have reached it, see conflict {heading}
    other_cause VARCHAR,              -- [braking_cause] another possible cause of the braking; NULL: none is seen
    waited BOOLEAN                   -- the object stood before the ego left the common ground, and moved off (faster than 1.5 m/s) at most 2 s before or 5 s after that; false: it did not stand, or stayed; NULL: it moved off earlier, or its moving off was not seen {position, velocity}
);

-- lifetime: part
CREATE TABLE way_mark (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- a running chain, see chain
    kind VARCHAR NOT NULL,            -- [mark_kind]
    mark_id VARCHAR NOT NULL,         -- id in the map; a traffic light without a stop line within 30 m counts as a stop line at its own position (inside a junction: at the junction's start), with the light's id
    lanelet_id VARCHAR NOT NULL,      -- the first lanelet of the chain on which the mark lies
    seq_first INTEGER NOT NULL,       -- seq of lanelet_id in the chain
    seq_last INTEGER NOT NULL,        -- seq of the last lanelet of the chain on which the mark lies
    s_start_m DOUBLE NOT NULL,        -- chain station of the mark's start
    s_end_m DOUBLE NOT NULL,          -- chain station of the mark's end
    control VARCHAR,                  -- [control] the first of these that governs the mark: of a junction, from 50 m before it to its connecting lanelets; of a stop line, within 30 m; of a crossing (lights only), from 15 m before to 30 m after it; never beyond another junction; NULL: none
    signal_id VARCHAR,                -- the signal of control. Of several, the first by: not for another turn, states recorded, for the ego's turn, nearest; NULL: none
    lights STRUCT(signal_id VARCHAR, fit VARCHAR)[] -- [fit: light_fit] for a traffic light, all its heads by id, and for which turn each is: own by its connecting lanelet or its arrow; maybe if the ego did not drive the whole turn, or if the turn has two possible names
);

-- lifetime: part
CREATE TABLE near_mark (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- a chain whose strip contains the ego
    kind VARCHAR NOT NULL,            -- [mark_kind] see way_mark
    mark_id VARCHAR NOT NULL,         -- see way_mark
    s_start_m DOUBLE NOT NULL,        -- see way_mark
    t_ns BIGINT NOT NULL,             -- a step with the front bumper at most 10 m before the mark or beyond, and the rear bumper (at this step or the last one before) at most 10 m past it
    k INTEGER NOT NULL,               -- see step
    seg INTEGER NOT NULL,             -- see step
    front_m DOUBLE NOT NULL,          -- distance of the front bumper beyond the mark's start; negative: before it
    rear_m DOUBLE NOT NULL,           -- distance of the rear bumper (or the trailer's) beyond the mark's end; negative: before it
    front_before_m DOUBLE,            -- front_m at the last step before with a position on this chain; NULL: none
    rear_before_m DOUBLE,             -- rear_m at that step; NULL: none
    joined BOOLEAN NOT NULL,          -- that step is the one directly before this step, without a hole
    running BOOLEAN NOT NULL          -- the chain is the ego's running chain at this step, and the ego is at most 4 m beside the lane
);

-- lifetime: part
CREATE TABLE signal_phase (
    drive_id VARCHAR NOT NULL,        -- the drive
    signal_id VARCHAR NOT NULL,       -- see signal_state
    t_from_ns BIGINT NOT NULL,        -- start of the phase
    t_to_ns BIGINT,                   -- end of the phase (excluded); NULL: no end
    state VARCHAR                     -- [light_state] see signal_state; NULL: not known, as after the last sample of a light that was recorded at least once a second
);

-- lifetime: part
CREATE TABLE mark_phase (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- see way_mark
    kind VARCHAR NOT NULL,            -- [mark_kind] see way_mark
    mark_id VARCHAR NOT NULL,         -- see way_mark
    s_start_m DOUBLE NOT NULL,        -- see way_mark
    t_from_ns BIGINT NOT NULL,        -- start of the phase
    t_to_ns BIGINT,                   -- end of the phase (excluded); NULL: no end
    state VARCHAR,                    -- [light_state] the state that the lights show for the ego's turn, see signal_state: that of its arrow, or of the full light if the arrow is dark; NULL: not known, or the heads that may be for this turn differ
    state_before VARCHAR,             -- [light_state] the state before this phase; NULL: not known
    begin_seen BOOLEAN NOT NULL,      -- both states are known: the change was seen
    t_before_ns BIGINT                -- start of the state before; NULL: not seen
);

-- lifetime: part
CREATE TABLE junction_passage (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the passage, from 0, in time order: the ego drives through a junction, which it enters by a lane that ends there
    junction_id VARCHAR NOT NULL,     -- the junction
    t_in_ns BIGINT,                   -- first step with the ego's front bumper in the junction; NULL: the log or a part after a hole begins inside {position}
    t_out_ns BIGINT,                  -- first step with the ego's rear bumper, or that of its trailer, past the junction; NULL: the log or the part before a hole ends inside, or the trailer is not seen then {position}
    t_first_ns BIGINT NOT NULL,       -- first step with the ego's centre on a connecting lanelet {position}
    t_last_ns BIGINT NOT NULL,        -- last step with the ego's centre on a connecting lanelet {position}
    from_lanelet_id VARCHAR,          -- the lanelet before the junction
    via_lanelet_id VARCHAR NOT NULL,  -- the (first) connecting lanelet
    to_lanelet_id VARCHAR,            -- the lanelet after the junction
    turn VARCHAR,                     -- [turn] by the change of heading from from_lanelet_id to to_lanelet_id (straight within 30 degrees, u_turn beyond 150); NULL: not seen from the entry of the ego's front until its centre was on the lane after the junction {position}
    turn_rad DOUBLE,                  -- this change of heading, left positive {heading}
    straightest_rad DOUBLE,           -- change of heading to the straightest of all ways out of the junction from the ego's road, left positive; NULL: that road is not known {heading}
    across BOOLEAN,                   -- the turn crosses the oncoming traffic (a right turn in left-hand traffic; any u_turn); NULL: handedness or turn not known {position, heading, velocity}
    branches INTEGER NOT NULL,        -- number of roads that meet in the junction; with 2, it is no junction for a driver
    control VARCHAR,                  -- [control + none] the sign or light that governs the ego's entry, see way_mark; NULL: not known, because the map has no such signals at all or begins less than 50 m before the junction
    minor BOOLEAN                     -- the ego must give way: control is stop or give_way; NULL: control not known {position}
);

-- lifetime: part
CREATE TABLE passage_conflict (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- see junction_passage; one row for each relation
    relation VARCHAR NOT NULL,        -- [relation] the direction from which the actor came, by its heading 2 s before, relative to the ego's at its entry. oncoming: from the road ahead (if that road leads off at an angle and no other is as straight, also from_left or from_right). ahead_going: a cyclist, animal or vehicle along the ego's own road that continues while the ego turns. pedestrian: on foot, in the junction or within 12 m before or after it. An actor without a class may be any {position}
    object_id VARCHAR,                -- the actor with the least PET, of the actors that the ego went ahead of or drove into. Driven into: a pedestrian who was still there, or a vehicle that had not yet passed the ego's front; NULL: none
    actor_class VARCHAR,              -- [actor_class] see road_user; it decides whether a low PET breaks a rule {class}
    pet_s DOUBLE,                     -- PET (post-encroachment time) of object_id, also if by reason another actor may have a lower one; infinite: no actor within 10 s, or until the log's end at least 4 s later; NULL: not known {position, velocity}
    decel_mps2 DOUBLE,                -- see conflict; 0 if there is no actor; NULL: not known {velocity}
    braked_id VARCHAR,                -- an actor of this relation (by its heading when it began to brake) that braked where its path led onto the ego's, whether it came or not, see forced_braking. Of several, first one without another cause, then the hardest braking; NULL: none {position, velocity}
    braked_pet_s DOUBLE,              -- PET that would have resulted at the speed of braked_id before the braking {position, velocity}
    braked_mps2 DOUBLE,               -- deceleration of braked_id {velocity}
    braked_cause VARCHAR,             -- [braking_cause] another possible cause of the braking, see forced_braking; NULL: none
    reason VARCHAR                    -- why another actor cannot be excluded, as JSON from the macro why: an actor has no position, heading or size; a track begins or ends within 30 m, or as near as the actor can drive in that time; the log, a hole or the sensor's range ends too soon; NULL: no other actor
);

-- lifetime: part
CREATE TABLE stop_line_crossing (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the crossing, from 0, in time order: the ego's front goes over a stop line of its running lane; again only if it was 0.5 m back in between
    stop_line_id VARCHAR NOT NULL,    -- the line; for a light without a line, the light itself, see way_mark (no row for a stop or give-way sign without a line, see junction_passage)
    lanelet_id VARCHAR NOT NULL,      -- the lanelet that the line crosses
    control VARCHAR,                  -- [control] the kind of the signal that belongs to the line, see way_mark; NULL: the map has none
    signal_id VARCHAR,                -- that signal; NULL: the map has none
    t_ns BIGINT NOT NULL,             -- first step with the ego's front past the line
    begin_seen BOOLEAN NOT NULL,      -- the step before t_ns exists, with the front before the line {position}
    speed_mps DOUBLE,                 -- speed of the ego at t_ns {velocity}
    state VARCHAR,                    -- [light_state] the light's state for the ego's turn at t_ns, see mark_phase; NULL: not known
    state_before VARCHAR,             -- [light_state] the light's state before the present one; NULL: not known
    t_state_ns BIGINT,                -- start of the present state; NULL: not known {position}
    amber_front_m DOUBLE,             -- distance from the ego's front to the line at the onset of the amber: of the amber in which it crossed, or of the one before the red; NULL: none seen {position, heading, size}
    amber_speed_mps DOUBLE,           -- speed of the ego at that onset {velocity}
    slowest_mps DOUBLE,               -- least speed of the ego with its front 0 to 3 m before the line, or at the last step before the line if none was there; NULL: never seen there, or the speed is not known {velocity}
    slowest_front_m DOUBLE,           -- distance from the ego's front to the line at that step {position, heading, size}
    stood_s DOUBLE                    -- longest time for which the ego stood (at most 0.1 m/s) with its front 0 to 1 m before the line, as far as seen; 0: it did not stand; NULL: the speed there is not known {position, velocity}
);

-- lifetime: part
CREATE TABLE crossing_occupancy (
    drive_id VARCHAR NOT NULL,        -- the drive
    crossing_id VARCHAR NOT NULL,     -- a pedestrian crossing of the map
    object_id VARCHAR NOT NULL,       -- an actor on foot, or of unknown class, with its centre on the crossing
    along_road INTEGER NOT NULL,      -- the half of the crossing: 1 on lanes driven along the road's reference line, -1 on lanes driven against it {position}
    t_from_ns BIGINT NOT NULL,        -- first sample on this half {position}
    t_to_ns BIGINT NOT NULL           -- last sample on this half {position}
);

-- lifetime: part
CREATE TABLE crossing_passage (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the passage, from 0, in time order: the ego drives over a pedestrian crossing, or reverses onto it
    crossing_id VARCHAR NOT NULL,     -- the crossing
    kind VARCHAR,                     -- [crossing_kind] as the map states, or signalled if a light governs the crossing; NULL: the map does not state it
    t_in_ns BIGINT,                   -- first step with the ego's front (reversing: its rear) on the crossing; NULL: the log or a part after a hole begins with the ego on it {position}
    t_out_ns BIGINT,                  -- first step with the ego's rear past the crossing, or, if it came reversing, its front back before it; NULL: the log or the part before a hole ends with the ego on it {position}
    on_id VARCHAR,                    -- the first pedestrian on the ego's half at any time from t_in_ns to t_out_ns; also on the other half, if the ego's centre was over that half; NULL: none {position}
    t_on_ns BIGINT,                   -- time since which on_id is there; NULL: none {position}
    coming_id VARCHAR,                -- a pedestrian on the other half at t_in_ns who goes straight on to the ego's half within 3 s (a longer time is a wait on an island); NULL: none {position}
    coming_known BOOLEAN NOT NULL,    -- for every pedestrian on the other half at t_in_ns, it is known whether they came from the ego's half, leave the crossing, or come to the ego's half; not known if the ego's side was over the other half {position}
    waiting_id VARCHAR,               -- a pedestrian who stands (at most 0.5 m/s) beside the lanes, within 2 m of the crossing's end on the ego's side, during the whole 2 s before t_in_ns; NULL: none {position}
    waiting_known BOOLEAN NOT NULL,   -- no actor of unknown class waits there {position}
    known BOOLEAN NOT NULL,           -- all pedestrians nearby have a position from 2 s before t_in_ns to t_out_ns: no track has a hole then, or begins or ends within 30 m; and no actor of unknown class is on the crossing {position}
    signal_id VARCHAR,                -- the light for vehicles, see way_mark; NULL: the map has none
    state VARCHAR,                    -- [light_state] the light's state at t_in_ns; NULL: not known
    stood_before BOOLEAN              -- the ego stood within 5 m before the crossing during the 10 s before t_in_ns; NULL: not seen, or it came reversing {position, velocity}
);

-- lifetime: part
CREATE TABLE standstill (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the standstill, from 0, in time order: the ego stands (below 0.1 m/s; without a speed in the log, by the distance from step to step) for at least 1 s
    t_start_ns BIGINT NOT NULL,       -- first step of the standstill {velocity}
    t_end_ns BIGINT NOT NULL,         -- last step of the standstill {velocity}
    begin_seen BOOLEAN NOT NULL,      -- the stop was seen: the step before exists, and the ego moves there {position}
    end_seen BOOLEAN NOT NULL,        -- the start after the standstill was seen {position}
    road_type VARCHAR,                -- [road_type] see ego_state
    lanelet_id VARCHAR,               -- see ego_lane; NULL: on no lanelet
    junction_id VARCHAR,              -- the junction that contains the ego's front or rear bumper; NULL: none
    junction_clear_m DOUBLE,          -- distance that the ego's rear has to drive to leave this junction; NULL: none, or no position on the ego's chain {position, heading, size}
    junction_inside_m DOUBLE,         -- length of the ego, with its trailer, that is inside this junction; NULL: none, or no position on the ego's chain {position, heading, size}
    turn VARCHAR,                     -- [turn] the ego's turn in this junction, see junction_passage; NULL: none, or not known {position}
    across BOOLEAN,                   -- see junction_passage {position, heading, velocity}
    junction_m DOUBLE,                -- distance from the front bumper to the next junction along the ego's chain; infinite: none within the corridor; NULL: not known {position}
    crossing_id VARCHAR,              -- a pedestrian crossing on which part of the ego's box is; NULL: none
    crossing_clear_m DOUBLE,          -- distance that the ego's rear has to drive to leave the crossing; NULL: none {position, heading, size}
    stop_line_id VARCHAR,             -- the next stop line, at most 20 m ahead of the ego's front or 3 m behind it; NULL: none
    stop_line_m DOUBLE,               -- distance from the ego's front to this line; negative: the front is over it {position}
    control VARCHAR,                  -- [control] see stop_line_crossing
    state VARCHAR,                    -- [light_state] the light's state at t_start_ns; NULL: not known, or no light
    ahead_id VARCHAR,                 -- the nearest vehicle ahead in the ego's lane at t_start_ns; NULL: none, see ahead_known {position}
    ahead_gap_m DOUBLE,               -- gap from the ego to this vehicle {position, heading, size}
    ahead_speed_mps DOUBLE,           -- speed of this vehicle {velocity}
    ahead_known BOOLEAN NOT NULL,     -- it is known which vehicle is ahead, see lead {position}
    blocking_id VARCHAR,              -- the nearest of the vehicles ahead in the ego's lane while the ego stood; vehicles at 1 m/s or less come before faster ones; NULL: none, see blocking_known {position}
    blocking_gap_m DOUBLE,            -- the least gap from the ego to this vehicle {position, heading, size}
    blocking_speed_mps DOUBLE,        -- speed of this vehicle at that gap {velocity}
    blocking_known BOOLEAN NOT NULL,  -- it is known at every step which vehicle is ahead, see lead {position}
    idle_ns BIGINT NOT NULL,          -- lower bound of the time for which the ego stood without an actor in its way within 10 m that stood or moved up at 1 m/s or less, see in_way {velocity}
    idle_at_most_ns BIGINT NOT NULL   -- upper bound of that time: it includes the time in which this is not known {velocity}
);
