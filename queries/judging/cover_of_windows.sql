-- part of `outcome_of_references.sql`: per reference what keeps its window from being seen whole; NULL: nothing
_window_extent AS (
    SELECT o.ref_id, any_value(o.a_ns) AS a_ns, any_value(o.b_ns) AS b_ns, any_value(s.max_gap_ns) AS max_gap_ns,
        any_value(s.t_start_ns) AS t_start_ns,
        any_value(s.t_end_ns) AS t_end_ns, count(p.t_ns) AS n_points, min(p.t_ns) AS t_min, max(p.t_ns) AS t_max,
            min(p.seg) AS seg_min, max(p.seg) AS seg_max, coalesce(bool_or(g.is_lost), false) AS is_lost
    FROM _occasion o JOIN _subject s ON s.drive_id = o.drive_id AND s.ego_id = o.ego_id
        LEFT JOIN reference_step p ON p.ref_id = o.ref_id
        LEFT JOIN _segment g ON g.drive_id = p.drive_id AND g.ego_id = p.ego_id AND g.seg = p.seg
    GROUP BY o.ref_id
), _cover AS (
    SELECT ref_id, n_points, a_ns AS t_min, b_ns AS t_max, CASE
        WHEN n_points = 0 AND (a_ns < t_start_ns OR b_ns > t_end_ns) THEN 'window_truncated'
        WHEN n_points = 0 THEN 'log_hole'
        WHEN t_min - a_ns > max_gap_ns AND t_min <= t_start_ns THEN 'window_truncated'
        WHEN b_ns - t_max > max_gap_ns AND t_max >= t_end_ns THEN 'window_truncated'
        WHEN t_min - a_ns > max_gap_ns OR b_ns - t_max > max_gap_ns OR seg_min <> seg_max OR is_lost THEN 'log_hole' END AS problem
    FROM _window_extent)
