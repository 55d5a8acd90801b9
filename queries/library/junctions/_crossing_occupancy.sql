-- Actors that may be on foot, on each half of a pedestrian crossing: one row per stretch of samples without a hole. An actor of class
-- object, which stands on the crossing in the whole log, may be a person who waits.
-- lifetime: part
CREATE TABLE _crossing_occupancy (
    drive_id VARCHAR NOT NULL,        -- the drive
    crossing_id VARCHAR NOT NULL,     -- a pedestrian crossing of the map
    object_id VARCHAR NOT NULL,       -- an actor on foot, or of unknown class, with its centre on the crossing
    along_road INTEGER NOT NULL,      -- the half of the crossing: 1 on lanes driven along the road's reference line, -1 on lanes driven against it {position}
    t_from_ns BIGINT NOT NULL,        -- first sample on this half {position}
    t_to_ns BIGINT NOT NULL           -- last sample on this half {position}
);

INSERT INTO _crossing_occupancy BY NAME
WITH walker AS (
    SELECT a.drive_id, a.actor_id, c.max_gap_ns
    FROM road_user a
    JOIN (SELECT drive_id, max(max_gap_ns) AS max_gap_ns FROM _ego_clock GROUP BY drive_id) c USING (drive_id)
    WHERE may_walk(a.actor_class) OR a.actor_class = 'object'
),
crossing_sample AS (
    SELECT DISTINCT o.drive_id, x.crossing_id, o.actor_id AS object_id, n.along_road, o.t_ns, w.max_gap_ns
    FROM lane_occupancy o
    JOIN walker w USING (drive_id, actor_id)
    JOIN data_log g USING (drive_id)
    JOIN crossing x ON x.environment_id = g.environment_id AND x.lanelet_id = o.lanelet_id
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
    WHERE o.s_m >= x.s_start_m AND o.s_m <= x.s_end_m
)
SELECT drive_id, crossing_id, object_id, along_road, min(t_ns) AS t_from_ns, max(t_ns) AS t_to_ns
FROM (
    SELECT *, sum((t_ns - before_ns > max_gap_ns)::INTEGER) OVER (PARTITION BY drive_id, crossing_id, object_id, along_road ORDER BY t_ns) AS n
    FROM (SELECT *, lag(t_ns, 1, t_ns) OVER (PARTITION BY drive_id, crossing_id, object_id, along_road ORDER BY t_ns) AS before_ns FROM crossing_sample)
)
GROUP BY drive_id, crossing_id, object_id, along_road, n
