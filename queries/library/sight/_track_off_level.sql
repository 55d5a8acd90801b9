-- Tracks that end or begin on another level: the actor is recorded, but over or under the ego's road, where pair has no row for it. Such an
-- actor is not lost, and it does not appear from nowhere.
-- lifetime: part
CREATE TABLE _track_off_level (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- an actor that has rows in pair, but at the last (or first) sample of its track is over or under the ego's road
    lost BOOLEAN NOT NULL             -- true: at the end of the track; false: at its beginning {position}
);

INSERT INTO _track_off_level BY NAME
WITH drive_with_heights AS (SELECT DISTINCT drive_id FROM state_dynamics WHERE z_m IS NOT NULL),
track_in_pair AS (
    SELECT drive_id, ego_id, object_id, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns
    FROM pair
    SEMI JOIN drive_with_heights USING (drive_id)
    GROUP BY ALL
),
recorded_track AS (
    SELECT drive_id, actor_id AS object_id, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns
    FROM state_dynamics
    SEMI JOIN drive_with_heights USING (drive_id)
    GROUP BY ALL
),
step_off_level AS (
    SELECT m.drive_id, m.ego_id, m.object_id, true AS lost
    FROM track_in_pair m
    JOIN recorded_track r USING (drive_id, object_id)
    JOIN step st ON st.drive_id = m.drive_id AND st.ego_id = m.ego_id AND st.t_ns > m.t_last_ns AND st.t_ns <= r.t_last_ns
    UNION ALL
    SELECT m.drive_id, m.ego_id, m.object_id, false
    FROM track_in_pair m
    JOIN recorded_track r USING (drive_id, object_id)
    JOIN step st ON st.drive_id = m.drive_id AND st.ego_id = m.ego_id AND st.t_ns < m.t_first_ns AND st.t_ns >= r.t_first_ns
)
SELECT DISTINCT drive_id, ego_id, object_id, lost FROM step_off_level
