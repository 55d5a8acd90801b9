-- The ends and beginnings of tracks, and of their parts between two holes, while the log continues. A recorder may lose an actor in plain
-- view, but not for long. After the end of a track, the recorder may only have lost the object until plain_ns; after plain_ns, the object
-- is out of sight. Before the beginning of a track, the object is out of sight until plain_ns; after plain_ns, the recorder may only not
-- have found it yet. An actor that leaves the recorder's range, or goes behind another box, is out of sight at once.
-- lifetime: part
CREATE TABLE _track_end (
    drive_id VARCHAR NOT NULL,        -- the drive; only where data_log.in_sight holds
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- an actor
    lost BOOLEAN NOT NULL,            -- true: its track, or the part of it before a hole, ends here; false: the track or part begins here {position}
    t_ns BIGINT NOT NULL,             -- the last (or first) sample with a position
    plain_ns BIGINT NOT NULL          -- time limit of plain view: after it (if lost; else before it), an actor without samples is assumed not to be in plain view {position}
);

INSERT INTO _track_end BY NAME
WITH incomplete_track AS (
    SELECT e.drive_id, e.ego_id, e.object_id, c.t_start_ns + c.max_gap_ns AS t_begin_limit_ns, c.t_end_ns - c.max_gap_ns AS t_end_limit_ns
    FROM (
        SELECT drive_id, ego_id, object_id, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns, bool_or(x_m IS NULL OR y_m IS NULL) AS has_holes FROM pair GROUP BY ALL
    ) e
    JOIN clock c USING (drive_id, ego_id)
    JOIN data_log g USING (drive_id)
    WHERE g.in_sight AND (e.has_holes OR e.t_last_ns + c.max_gap_ns < c.t_end_ns OR e.t_first_ns > c.t_start_ns + c.max_gap_ns)
),
-- occasion: incomplete_track
placed_sample AS (
    SELECT
        p.drive_id, p.ego_id, p.object_id, p.t_ns, st.k, p.x_m, p.y_m,
        coalesce(p.speed_mps * cos(p.yaw_rad), 0.0) AS vx_mps, coalesce(p.speed_mps * sin(p.yaw_rad), 0.0) AS vy_mps
    FROM pair p
    SEMI JOIN incomplete_track m ON m.drive_id = p.drive_id AND m.ego_id = p.ego_id AND m.object_id = p.object_id
    JOIN step st USING (drive_id, ego_id, t_ns)
    WHERE p.x_m IS NOT NULL AND p.y_m IS NOT NULL
),
track_edge AS (
    SELECT drive_id, ego_id, object_id, t_ns, x_m, y_m, vx_mps, vy_mps, lost
    FROM (SELECT *, lag(k) OVER w AS k_before, lead(k) OVER w AS k_after, unnest([true, false]) AS lost FROM placed_sample WINDOW w AS (PARTITION BY drive_id, ego_id, object_id ORDER BY k)) o
    JOIN incomplete_track m USING (drive_id, ego_id, object_id)
    -- A track that begins or ends with the log is not lost.
    WHERE CASE WHEN lost THEN k_after IS DISTINCT FROM k + 1 AND t_ns < t_end_limit_ns ELSE k_before IS DISTINCT FROM k - 1 AND t_ns > t_begin_limit_ns END
),
motion_doubt AS (SELECT drive_id, actor_id, t_from_ns, t_to_ns FROM doubt WHERE doubts_place(quantity) OR quantity = 'velocity'),
-- A sample in doubt does not show where the object went.
credible_edge AS (
    FROM track_edge e
    ANTI JOIN motion_doubt d ON d.drive_id = e.drive_id AND d.actor_id = e.object_id AND e.t_ns BETWEEN d.t_from_ns AND d.t_to_ns
    ANTI JOIN motion_doubt o ON o.drive_id = e.drive_id AND o.actor_id = e.ego_id AND e.t_ns BETWEEN o.t_from_ns AND o.t_to_ns
),
-- The extrapolated position of the object soon after its track ends, or just before it begins, at its speed there.
extrapolation AS (
    SELECT
        e.drive_id, e.ego_id, e.object_id, e.lost, e.t_ns, s.t_ns AS t_place_ns,
        e.x_m + e.vx_mps * (s.t_ns - e.t_ns) / 1e9 - s.x_m AS dx_m, e.y_m + e.vy_mps * (s.t_ns - e.t_ns) / 1e9 - s.y_m AS dy_m, s.x_m, s.y_m
    FROM credible_edge e
    JOIN ego_state s ON s.drive_id = e.drive_id AND s.ego_id = e.ego_id
        AND CASE WHEN e.lost THEN s.t_ns > e.t_ns AND s.t_ns <= e.t_ns + track_delay_ns() ELSE s.t_ns < e.t_ns AND s.t_ns >= e.t_ns - track_delay_ns() END
),
occlusion AS (
    SELECT DISTINCT m.drive_id, m.ego_id, m.object_id, m.lost, m.t_ns
    FROM extrapolation m
    JOIN pair o ON o.drive_id = m.drive_id AND o.ego_id = m.ego_id AND o.t_ns = m.t_place_ns AND o.object_id <> m.object_id
    WHERE blocks_sight(o.x_m - m.x_m, o.y_m - m.y_m, m.dx_m, m.dy_m, o.yaw_rad, o.length_m, o.width_m)
)
SELECT
    e.drive_id, e.ego_id, e.object_id, e.lost, e.t_ns,
    CASE
        WHEN e.lost THEN e.t_ns + CASE WHEN x.is_explained THEN 0 ELSE longest_track_gap_ns() END
        ELSE e.t_ns - CASE WHEN x.is_explained THEN track_delay_ns() ELSE longest_track_gap_ns() END
    END AS plain_ns
FROM track_edge e
JOIN data_log g USING (drive_id)
LEFT JOIN (
    SELECT drive_id, ego_id, object_id, lost, t_ns, max(dx_m ** 2 + dy_m ** 2) AS furthest_m2 FROM extrapolation GROUP BY ALL
) f USING (drive_id, ego_id, object_id, lost, t_ns)
LEFT JOIN occlusion b USING (drive_id, ego_id, object_id, lost, t_ns)
CROSS JOIN LATERAL (SELECT b.t_ns IS NOT NULL OR coalesce(f.furthest_m2 > (g.sensor_range_m - sight_error_m()) ** 2, false) AS is_explained) x
