-- The data for a picture of a finding: the actors and their places around its worst step, and the lanes there. Written beside the verdicts,
-- so that reports can be made from the result folder alone.

-- lifetime: run
CREATE TABLE scene (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the moment: t_worst_ns of findings and near misses, one row for all that share it
    environment_id VARCHAR,           -- the map, for table lane_shape; NULL: no map
    reach_m DOUBLE NOT NULL,          -- range around the ego in which actors and lanes were kept
    lanelets VARCHAR[] NOT NULL,      -- lanelets within reach
    actors STRUCT(actor_id VARCHAR, actor_class VARCHAR, length_m DOUBLE, width_m DOUBLE, x_m DOUBLE, y_m DOUBLE, yaw_rad DOUBLE, speed_mps DOUBLE, path STRUCT(t_ns BIGINT, x_m DOUBLE, y_m DOUBLE, yaw_rad DOUBLE, speed_mps DOUBLE, accel_mps2 DOUBLE, d_m DOUBLE)[])[] NOT NULL -- the ego first, then everybody within reach and placed: box centre at the moment, and the way 5 s before and after it, at most 5 points a second and the moment itself; d_m: offset from the centre line of the ego's running lane, left positive, NULL without a map
);

-- lifetime: run
CREATE TABLE picture (
    drive_id VARCHAR NOT NULL,        -- the drive
    t_ns BIGINT NOT NULL,             -- the moment: t_worst_ns of findings and near misses
    camera VARCHAR NOT NULL,          -- topic of the camera in the log
    camera_no INTEGER NOT NULL,       -- 0.. in the order in which cameras are shown: those that look ahead come first
    shot VARCHAR NOT NULL,            -- [shot] which of the three pictures of the moment
    t_frame_ns BIGINT NOT NULL,       -- time of the frame: the nearest one that the camera has
    width_px INTEGER NOT NULL,        -- of the downscaled picture
    height_px INTEGER NOT NULL,       -- of the downscaled picture
    jpeg BLOB NOT NULL                -- the picture
);

-- lifetime: run
CREATE TABLE lane_shape (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a lanelet near a scene
    lane_type VARCHAR NOT NULL,       -- [lane_type] see lanelet
    drivable BOOLEAN NOT NULL,        -- see lanelet
    in_junction BOOLEAN NOT NULL,     -- a connecting lane of a junction
    left_marking VARCHAR,             -- [marking] of most of the left bound; NULL: the map does not state it
    right_marking VARCHAR,            -- [marking] of most of the right bound; NULL: the map does not state it
    left_x_m DOUBLE[] NOT NULL,       -- left bound in the direction of travel, true to 10 cm
    left_y_m DOUBLE[] NOT NULL,       -- left bound
    right_x_m DOUBLE[] NOT NULL,      -- right bound in the direction of travel
    right_y_m DOUBLE[] NOT NULL       -- right bound
);

-- lifetime: run
CREATE TABLE danger_space (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a moment, or a step of the ego's way around it; only in overtakes
    actor_id VARCHAR NOT NULL,        -- the actor of the danger space: the ego or the oncoming vehicle
    length_m DOUBLE NOT NULL,         -- its stopping distance
    x_m DOUBLE[] NOT NULL,            -- the space swept along the corridor, as in the assertions: a closed ring, true to 10 cm
    y_m DOUBLE[] NOT NULL             -- the same
);

-- lifetime: run
CREATE TABLE course (
    finding_id VARCHAR,               -- a finding; NULL: a near miss, one of the 20 closest of its ego, rule and profile
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    rule_id VARCHAR NOT NULL,         -- the rule
    profile VARCHAR,                  -- the profile; NULL: the rule has none
    object_id VARCHAR,                -- the other road user
    occurrence INTEGER NOT NULL,      -- as in finding; for a near miss as in verdict
    t_ns BIGINT[] NOT NULL,           -- judged steps around it: of the same rule, profile, object and reference point
    observed DOUBLE[] NOT NULL,       -- value at each; NULL: not known, or nothing is measured
    required DOUBLE[] NOT NULL,       -- the value that observed was compared with
    margin DOUBLE[] NOT NULL,         -- signed, positive = kept
    holds BOOLEAN[] NOT NULL,         -- kept there; NULL: unknown
    x_m DOUBLE[] NOT NULL,            -- the ego at each; NULL: not known
    y_m DOUBLE[] NOT NULL             -- the ego at each
);

-- lifetime: run
CREATE TABLE track (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- an ego, or the other road user of a finding or near miss
    part INTEGER NOT NULL,            -- 0.. in time order: a new part begins after each hole of the track
    is_ego BOOLEAN NOT NULL,          -- see actor
    actor_class VARCHAR,              -- [actor_class] see actor
    t_ns BIGINT[] NOT NULL,           -- at most five samples a second, and the last one
    x_m DOUBLE[] NOT NULL,            -- its box centre at each
    y_m DOUBLE[] NOT NULL             -- its box centre at each
);

-- lifetime: run
CREATE TABLE overtake_record (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order, see overtake
    status VARCHAR NOT NULL,          -- [overtake_status]
    opposing BOOLEAN,                 -- the overtaking lane is driven the other way; NULL: not known
    vbp_id VARCHAR NOT NULL,          -- the vehicle being passed
    ov_id VARCHAR,                    -- the oncoming vehicle at t0; NULL: none seen
    begin_seen BOOLEAN NOT NULL,      -- t0 lies in the log
    t0_ns BIGINT NOT NULL,            -- first step with a corner over the boundary
    t1_ns BIGINT,                     -- wholly in the overtaking lane; NULL: never
    t2_ns BIGINT,                     -- turning back; NULL: never
    t3_ns BIGINT,                     -- wholly back; NULL: never
    t_end_ns BIGINT NOT NULL,         -- t3, or the last step of the excursion
    v_av_mps DOUBLE,                  -- ego's speed at t0
    v_vbp_mps DOUBLE,                 -- speed of the vehicle being passed at t0
    v_ov_mps DOUBLE,                  -- oncoming vehicle's speed at t0; without one the speed limit
    l_av_m DOUBLE,                    -- ego's length
    l_vbp_m DOUBLE,                   -- length of the vehicle being passed
    lane_width_m DOUBLE,              -- width of the running lane at t0
    da_m DOUBLE,                      -- distance ahead at t0; without an oncoming vehicle how far the road was free
    profiles STRUCT(profile VARCHAR, style INTEGER, da_m DOUBLE, at_least BOOLEAN, nobody BOOLEAN, sda_m DOUBLE, spare_m DOUBLE, spare_s DOUBLE, "zone" VARCHAR, reason VARCHAR)[] NOT NULL, -- per profile, selected or not: see overtake_sda
    stretches STRUCT(stage VARCHAR, t_start_ns BIGINT, t_end_ns BIGINT, n BIGINT, said VARCHAR[], worst_m DOUBLE[])[] NOT NULL -- runs of steps in which the four danger-space assertions say the same, in the order VBP outside DS_AV, OV outside DS_AV, AV outside DS_OV, DS_AV and DS_OV apart: pass, fail, unknown, nobody; and how far inside at worst (negative: clear of it)
);

-- lifetime: run
CREATE TABLE opportunity_record (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- 0.. in time order, see opportunity
    object_id VARCHAR NOT NULL,       -- the slower vehicle ahead
    profile VARCHAR NOT NULL,         -- see profile (not observed)
    style INTEGER NOT NULL,           -- 0 = least aggressive
    t_start_ns BIGINT NOT NULL,       -- held up from here
    t_end_ns BIGINT NOT NULL,         -- to here
    t_best_ns BIGINT,                 -- the step with the most spare distance; NULL: never known
    da_m DOUBLE,                      -- distance ahead there, or how far it was free; NULL: unknown
    sda_m DOUBLE,                     -- safe distance ahead there
    spare_s DOUBLE,                   -- time in which the spare distance closes
    zone VARCHAR,                     -- [zone] at that step; NULL: unknown
    taken BOOLEAN NOT NULL            -- an overtake of that vehicle began in it
);
