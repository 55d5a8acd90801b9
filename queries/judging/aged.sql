-- Part of `judged_of_grid.sql`: the steps without those of a young episode, which are exempt. An episode whose beginning was not seen
-- (the log's start, a hole) has no known age: none of it is exempt.
{walked}
), _aged AS (
    SELECT *, first_value(t_ns) OVER w AS t_begin_ns, first_value(k) OVER w AS k_begin FROM _walked
    WINDOW w AS (PARTITION BY drive_id, ego_id, object_id, profile, label, episode ORDER BY t_ns))
SELECT a.* EXCLUDE (t_begin_ns, k_begin, episode) FROM _aged a
LEFT JOIN _segment s ON s.drive_id = a.drive_id AND s.ego_id = a.ego_id AND s.seg = a.seg
WHERE s.seg IS NULL OR k_begin = s.k_first OR t_ns - t_begin_ns >= $_exempt_ns
