-- The data for a picture of a finding: the actors and their places around its worst step, and the lanes there. Written beside the verdicts,
-- so that reports can be made from the result folder alone.

-- lifetime: run
CREATE TABLE scene (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the moment: t_worst_ns of findings and near misses; one row for all that have the same moment
    environment_id VARCHAR,           -- the map, for table lane_shape; NULL: no map
    reach_m DOUBLE NOT NULL,          -- range around the ego within which actors and lanes were stored
    lanelets VARCHAR[] NOT NULL,      -- lanelets within reach_m
    actors STRUCT(actor_id VARCHAR, actor_class VARCHAR, length_m DOUBLE, width_m DOUBLE, x_m DOUBLE, y_m DOUBLE, yaw_rad DOUBLE, speed_mps DOUBLE, path STRUCT(t_ns BIGINT, x_m DOUBLE, y_m DOUBLE, yaw_rad DOUBLE, speed_mps DOUBLE, accel_mps2 DOUBLE, d_m DOUBLE)[])[] NOT NULL -- the ego first, then every actor within reach_m with a position: box centre at the moment, and its path from 5 s before to 5 s after it (at most 5 points a second, and the moment itself); d_m: offset from the centre line of the ego's running lane, left positive, NULL without a map
);

-- lifetime: run
CREATE TABLE picture (
    drive_id VARCHAR NOT NULL,        -- the drive
    t_ns BIGINT NOT NULL,             -- the moment: t_worst_ns of findings and near misses
    camera VARCHAR NOT NULL,          -- the camera's topic in the log
    camera_no INTEGER NOT NULL,       -- number of the camera in display order, from 0: those that look ahead come first
    shot VARCHAR NOT NULL,            -- [shot] which of the three pictures of the moment this is
    t_frame_ns BIGINT NOT NULL,       -- time of the frame: the camera's nearest to the moment, or to a second before or after it
    width_px INTEGER NOT NULL,        -- width of the downscaled picture
    height_px INTEGER NOT NULL,       -- height of the downscaled picture
    jpeg BLOB NOT NULL                -- the picture, as JPEG
);

-- lifetime: run
CREATE TABLE lane_shape (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a lanelet near a scene
    lane_type VARCHAR NOT NULL,       -- [lane_type] see lanelet
    drivable BOOLEAN NOT NULL,        -- see lanelet
    in_junction BOOLEAN NOT NULL,     -- a connecting lane of a junction
    left_marking VARCHAR,             -- [marking] marking of most of the left bound; NULL: the map does not state it
    right_marking VARCHAR,            -- [marking] marking of most of the right bound; NULL: the map does not state it
    left_x_m DOUBLE[] NOT NULL,       -- left bound in the direction of travel, x, accurate to 10 cm
    left_y_m DOUBLE[] NOT NULL,       -- left bound, y
    right_x_m DOUBLE[] NOT NULL,      -- right bound in the direction of travel, x
    right_y_m DOUBLE[] NOT NULL       -- right bound, y
);

-- lifetime: run
CREATE TABLE danger_space (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the moment of a scene, or a step of the ego's path around it; only in overtakes
    actor_id VARCHAR NOT NULL,        -- the actor whose danger space it is: the ego or the oncoming vehicle
    length_m DOUBLE NOT NULL,         -- stopping distance of the actor
    x_m DOUBLE[] NOT NULL,            -- outline of the space swept along the corridor, as in the assertions: x of a closed ring, accurate to 10 cm
    y_m DOUBLE[] NOT NULL             -- y of this ring
);

-- lifetime: run
CREATE TABLE course (
    finding_id VARCHAR,               -- a finding; NULL: a near miss, one of the 20 closest of its ego, rule and profile
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    rule_id VARCHAR NOT NULL,         -- the rule
    profile VARCHAR,                  -- the profile; NULL: the rule has none
    object_id VARCHAR,                -- the other road user; NULL: none
    occurrence INTEGER NOT NULL,      -- number of the finding, as in finding; for a near miss, that of its verdict
    t_ns BIGINT[] NOT NULL,           -- judged steps around the finding or near miss, of the same rule, profile, object and reference point
    observed DOUBLE[] NOT NULL,       -- measured value at each step; NULL: not known, or nothing is measured
    required DOUBLE[] NOT NULL,       -- the value with which observed was compared
    margin DOUBLE[] NOT NULL,         -- signed distance to the threshold, positive if the rule is kept
    holds BOOLEAN[] NOT NULL,         -- the rule is kept at the step; NULL: unknown
    x_m DOUBLE[] NOT NULL,            -- x of the ego at each step; NULL: not known
    y_m DOUBLE[] NOT NULL             -- y of the ego at each step; NULL: not known
);

-- lifetime: run
CREATE TABLE track (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- an ego, or the other road user of a finding or near miss
    part INTEGER NOT NULL,            -- number of the part, from 0, in time order: a new part begins after each hole of the track
    is_ego BOOLEAN NOT NULL,          -- see actor
    actor_class VARCHAR,              -- [actor_class] see actor
    t_ns BIGINT[] NOT NULL,           -- times of at most five samples a second, and of the last sample
    x_m DOUBLE[] NOT NULL,            -- x of the box centre at each time
    y_m DOUBLE[] NOT NULL             -- y of the box centre at each time
);

-- lifetime: run
CREATE TABLE overtake_record (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the overtake, from 0, in time order, see overtake
    status VARCHAR NOT NULL,          -- [overtake_status]
    opposing BOOLEAN,                 -- the overtaking lane is driven in the opposite direction; NULL: not known
    vbp_id VARCHAR NOT NULL,          -- the vehicle being passed
    ov_id VARCHAR,                    -- the oncoming vehicle at t0; NULL: none seen
    begin_seen BOOLEAN NOT NULL,      -- t0 lies in the log
    t0_ns BIGINT NOT NULL,            -- first step with a corner over the boundary
    t1_ns BIGINT,                     -- first step wholly in the overtaking lane; NULL: never
    t2_ns BIGINT,                     -- step at which the ego turns back; NULL: never
    t3_ns BIGINT,                     -- first step wholly back in the running lane; NULL: never
    t_end_ns BIGINT NOT NULL,         -- t3_ns, or the last step over the boundary
    v_av_mps DOUBLE,                  -- speed of the ego at t0
    v_vbp_mps DOUBLE,                 -- speed of the vehicle being passed at t0
    v_ov_mps DOUBLE,                  -- speed of the oncoming vehicle at t0; without one, the speed limit
    l_av_m DOUBLE,                    -- length of the ego, with its trailer
    l_vbp_m DOUBLE,                   -- length of the vehicle being passed
    lane_width_m DOUBLE,              -- width of the running lane at t0
    da_m DOUBLE,                      -- distance ahead at t0; without an oncoming vehicle, the free distance
    profiles STRUCT(profile VARCHAR, style INTEGER, da_m DOUBLE, at_least BOOLEAN, nobody BOOLEAN, sda_m DOUBLE, spare_m DOUBLE, spare_s DOUBLE, "zone" VARCHAR, reason VARCHAR)[] NOT NULL, -- per profile, selected or not: the columns of overtake_sda
    stretches STRUCT(stage VARCHAR, t_start_ns BIGINT, t_end_ns BIGINT, n BIGINT, said VARCHAR[], worst_m DOUBLE[])[] NOT NULL -- runs of steps with the same results of the four danger-space assertions. Their order: VBP outside DS_AV, OV outside DS_AV, AV outside DS_OV, DS_AV and DS_OV apart. (VBP: vehicle being passed; OV: oncoming vehicle; AV: ego; DS_AV, DS_OV: danger spaces.) said: pass, fail, unknown or nobody (no such vehicle); worst_m: the greatest depth inside (negative: distance from it)
);

-- lifetime: run
CREATE TABLE opportunity_record (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the opportunity, from 0, in time order, see opportunity
    object_id VARCHAR NOT NULL,       -- the slower vehicle ahead, which holds up the ego
    profile VARCHAR NOT NULL,         -- see profile (not observed)
    style INTEGER NOT NULL,           -- rank of aggressiveness, 0 = least aggressive
    t_start_ns BIGINT NOT NULL,       -- first step at which the ego is held up
    t_end_ns BIGINT NOT NULL,         -- last step at which the ego is held up
    t_best_ns BIGINT,                 -- the step with the most spare distance; NULL: never known
    da_m DOUBLE,                      -- distance ahead at t_best_ns, or the free distance; NULL: unknown
    sda_m DOUBLE,                     -- safe distance ahead at t_best_ns
    spare_s DOUBLE,                   -- time in which the spare distance (da_m minus sda_m) closes
    zone VARCHAR,                     -- [zone] at t_best_ns; NULL: unknown
    taken BOOLEAN NOT NULL            -- an overtake of this vehicle began in this time
);
