-- What a picture of a finding needs: who was where around its worst step, and the lanes there. Written beside the verdicts, so that
-- reports can be made from the result folder alone.

CREATE TABLE scene (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the moment: t_worst_ns of findings and near misses, one row for all that share it
    environment_id VARCHAR,           -- the map, for table lane_shape; NULL: no map
    reach_m DOUBLE NOT NULL,          -- how far around the ego actors and lanes were kept
    lanelets VARCHAR[] NOT NULL,      -- lanelets within reach
    actors STRUCT(actor_id VARCHAR, actor_class VARCHAR, length_m DOUBLE, width_m DOUBLE, x_m DOUBLE, y_m DOUBLE, yaw_rad DOUBLE, speed_mps DOUBLE, path STRUCT(t_ns BIGINT, x_m DOUBLE, y_m DOUBLE, yaw_rad DOUBLE)[])[] NOT NULL, -- the ego first, then everybody within reach and placed: box centre at the moment, and the way 5 s before and after it, at most 5 points a second
    spaces STRUCT(actor_id VARCHAR, length_m DOUBLE, x_m DOUBLE[], y_m DOUBLE[])[] NOT NULL -- danger spaces of ego and OV, swept along the corridor: a closed ring; only in overtakes
);

CREATE TABLE lane_shape (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a lanelet near a scene
    lane_type VARCHAR NOT NULL,       -- see lanelet
    drivable BOOLEAN NOT NULL,        -- see lanelet
    in_junction BOOLEAN NOT NULL,     -- a connecting lane of a junction
    left_marking VARCHAR,             -- marking of most of the left bound; NULL: the map does not say
    right_marking VARCHAR,            -- marking of most of the right bound
    left_x_m DOUBLE[] NOT NULL,       -- left bound in the direction of travel, true to 10 cm
    left_y_m DOUBLE[] NOT NULL,       -- left bound
    right_x_m DOUBLE[] NOT NULL,      -- right bound in the direction of travel
    right_y_m DOUBLE[] NOT NULL       -- right bound
);
