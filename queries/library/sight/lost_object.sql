-- Actors whose track ends before the log does, where they could still have been seen: near the ego, or within the sensor's range. If the
-- log is assumed to record every actor in plain view (data_log.in_sight), only tracks that end near the ego count, and only until the
-- recorder would have found the actor again. A track that ends further away counts if the actor may have touched the ego later: see hidden.
-- lifetime: part
CREATE TABLE lost_object (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- an actor whose track ends although it may still have been there
    t_from_ns BIGINT NOT NULL,        -- the actor's position is unknown from this time on {position}
    t_to_ns BIGINT NOT NULL,          -- the actor's position is unknown until this time: the log's end or, if data_log.in_sight holds and the track ended near the ego, the time at which the recorder would have found it again {position}
    code VARCHAR NOT NULL             -- [loss]
);

INSERT INTO lost_object BY NAME
WITH last_sample AS (
    SELECT p.drive_id, p.ego_id, p.object_id, max(p.t_ns) AS t_last_ns FROM pair p GROUP BY ALL
),
ended_track AS (
    SELECT n.drive_id, n.ego_id, n.object_id, n.t_last_ns, c.t_end_ns, g.sensor_range_m, g.in_sight, r.plain_ns
    FROM last_sample n
    JOIN clock c USING (drive_id, ego_id)
    JOIN data_log g USING (drive_id)
    LEFT JOIN _track_end r ON r.drive_id = n.drive_id AND r.ego_id = n.ego_id AND r.object_id = n.object_id AND r.t_ns = n.t_last_ns AND r.lost
    ANTI JOIN (FROM _track_off_level WHERE lost) l ON l.drive_id = n.drive_id AND l.ego_id = n.ego_id AND l.object_id = n.object_id
    WHERE n.t_last_ns + c.max_gap_ns < c.t_end_ns
        -- An actor that leaves the recorder's view, behind another box or out of range, does not come near unseen.
        AND (r.plain_ns IS NULL OR r.plain_ns > n.t_last_ns)
),
lost_in_reach AS (
    SELECT e.drive_id, e.ego_id, e.object_id, e.t_last_ns + 1 AS t_from_ns, coalesce(least(e.plain_ns, e.t_end_ns), e.t_end_ns) AS t_to_ns,
        CASE WHEN p.distance_m < x.near_m OR p.distance_m IS NULL THEN 'lost_near_ego' ELSE 'lost_in_range' END AS code
    FROM ended_track e
    JOIN pair p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.object_id = e.object_id AND p.t_ns = e.t_last_ns
    JOIN ego_state s ON s.drive_id = e.drive_id AND s.ego_id = e.ego_id AND s.t_ns = e.t_last_ns
    -- Two vehicles that come towards each other meet soon.
    CROSS JOIN LATERAL (
        SELECT CASE WHEN abs(p.heading_diff_rad) > pi() / 2 AND p.front_s_m > s.rear_s_m THEN greatest(lost_near_m(), 2 * (p.speed_mps + s.speed_mps)) ELSE lost_near_m() END AS near_m
    ) x
    WHERE p.distance_m IS NULL OR p.distance_m < x.near_m OR NOT e.in_sight AND p.distance_m < e.sensor_range_m
)
SELECT * FROM lost_in_reach
UNION ALL
SELECT e.drive_id, e.ego_id, e.object_id, e.t_last_ns + 1, e.t_end_ns, 'lost_on_road'
FROM ended_track e
SEMI JOIN hidden h ON h.drive_id = e.drive_id AND h.ego_id = e.ego_id AND h.object_id = e.object_id AND h.t_ns > e.t_last_ns AND h.least_m <= 0
ANTI JOIN lost_in_reach l ON l.drive_id = e.drive_id AND l.ego_id = e.ego_id AND l.object_id = e.object_id
