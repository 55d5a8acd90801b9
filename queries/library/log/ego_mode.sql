-- The modes of the automated driver that the log declares, at every step of the ego. A declaration applies until the next one. A mode is an
-- event that the ego declares on or off at least once. The mode is not known after any other value or two different values at once, or if
-- the log has lost data since the declaration: the lost part may contain another declaration.
-- lifetime: part
CREATE TABLE ego_mode (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    mode VARCHAR NOT NULL,            -- [mode] a declared event whose values are on and off; one row per step for each mode that the ego ever declared
    is_on BOOLEAN                     -- the mode is on, by the last declaration before the step; NULL: none yet, or not known
);

INSERT INTO ego_mode BY NAME
WITH declaration AS (
    SELECT
        drive_id, actor_id AS ego_id, event AS mode, t_ns,
        CASE WHEN bool_and(word IN ('on', 'true')) THEN true WHEN bool_and(word IN ('off', 'false')) THEN false END AS is_on
    FROM (SELECT drive_id, actor_id, event, t_ns, coalesce(lower(trim(value)), '') AS word FROM declared_event)
    GROUP BY ALL
),
mode AS (
    SELECT drive_id, ego_id, mode FROM declaration GROUP BY ALL HAVING count(is_on) > 0
)
SELECT s.drive_id, s.ego_id, s.t_ns, s.mode, CASE WHEN l.t_to_ns IS NULL OR l.t_to_ns <= d.t_ns THEN d.is_on END AS is_on
FROM (SELECT st.drive_id, st.ego_id, st.t_ns, m.mode FROM step st JOIN mode m ON m.drive_id = st.drive_id AND m.ego_id = st.ego_id) s
ASOF LEFT JOIN declaration d ON d.drive_id = s.drive_id AND d.ego_id = s.ego_id AND d.mode = s.mode AND d.t_ns <= s.t_ns
-- The last loss that began before the step.
ASOF LEFT JOIN lost_time l ON l.drive_id = s.drive_id AND l.t_from_ns < s.t_ns
