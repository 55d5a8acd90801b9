-- The clocks of the egos that are judged in this part of the run.
-- lifetime: part
CREATE TABLE clock (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    period_ns BIGINT NOT NULL,        -- median time between the ego's samples
    max_gap_ns BIGINT NOT NULL,       -- samples closer than this are continuous (2.5 periods by default)
    t_start_ns BIGINT NOT NULL,       -- the ego's first sample
    t_end_ns BIGINT NOT NULL          -- the ego's last sample
);

INSERT INTO clock BY NAME
SELECT c.* FROM _ego_clock c ANTI JOIN deferred_ego USING (drive_id, ego_id)
