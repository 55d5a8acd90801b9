-- Part of `judged_of_grid.sql`: leaves out the steps in the first exempt_after_s seconds of each episode. They are exempt. If the beginning
-- of
-- an episode was not seen (the log's start, a hole), its age is not known and none of its steps is exempt.
{steps_with_episode}
), _step_with_episode_begin AS (
    SELECT *, first_value(t_ns) OVER w AS t_begin_ns, first_value(k) OVER w AS k_begin FROM _step_with_episode
    WINDOW w AS (PARTITION BY drive_id, ego_id, object_id, profile, label, episode ORDER BY t_ns))
SELECT a.* EXCLUDE (t_begin_ns, k_begin, episode) FROM _step_with_episode_begin a
LEFT JOIN _segment s ON s.drive_id = a.drive_id AND s.ego_id = a.ego_id AND s.seg = a.seg
WHERE s.seg IS NULL OR k_begin = s.k_first OR t_ns - t_begin_ns >= $_exempt_ns
