-- Part of other statements (it closes the CTE before it and leaves its last one open): rows of a source numbered by episode.
), _step_with_previous AS (
    SELECT *, lag(t_ns) OVER w AS t_last_ns, lag(seg) OVER w AS seg_last
        FROM ({source}) WINDOW w AS (PARTITION BY drive_id, ego_id, object_id, profile, label ORDER BY t_ns)
), _step_with_episode AS (
    SELECT l.* EXCLUDE (t_last_ns, seg_last), sum(CASE WHEN seg_last = seg AND t_ns - t_last_ns <= s.max_gap_ns THEN 0
        ELSE 1 END)
        OVER (PARTITION BY l.drive_id, l.ego_id, l.object_id, l.profile, l.label
            ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS episode
    FROM _step_with_previous l JOIN _subject s ON s.drive_id = l.drive_id AND s.ego_id = l.ego_id
