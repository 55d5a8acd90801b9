-- Tracks whose samples were interpolated between key frames, as data sets annotated by hand do: the places lie on straight lines, and bend
-- at whole multiples of one period only. `first_ns`: a key frame; `every_ns`: the time between two.
CREATE OR REPLACE TEMP TABLE _key_frame AS
WITH place AS (
    SELECT s.drive_id, s.actor_id, s.t_ns, s.x_m, s.y_m, lag(s.t_ns) OVER w AS t0_ns, lag(s.x_m) OVER w AS x0_m, lag(s.y_m) OVER w AS y0_m,
        lead(s.t_ns) OVER w AS t1_ns, lead(s.x_m) OVER w AS x1_m, lead(s.y_m) OVER w AS y1_m
    FROM actor_state s
    JOIN data_log g ON g.drive_id = s.drive_id AND g.sensor_range_m IS NOT NULL
    WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL
    WINDOW w AS (PARTITION BY s.drive_id, s.actor_id ORDER BY s.t_ns)
), bend AS (
    SELECT drive_id, actor_id, t_ns, t_ns - lag(t_ns) OVER (PARTITION BY drive_id, actor_id ORDER BY t_ns) AS gap_ns
    FROM place
    WHERE t0_ns IS NULL OR abs(x_m - x0_m - (x1_m - x0_m) * (t_ns - t0_ns) / (t1_ns - t0_ns)) > bend_m()
        OR abs(y_m - y0_m - (y1_m - y0_m) * (t_ns - t0_ns) / (t1_ns - t0_ns)) > bend_m()
), every AS (
    SELECT drive_id, actor_id, min(t_ns) AS first_ns, min(gap_ns) AS every_ns, list(gap_ns) AS gaps FROM bend GROUP BY drive_id, actor_id
)
SELECT drive_id, actor_id, first_ns, every_ns
FROM every
JOIN (SELECT drive_id, actor_id, median(t_ns - t0_ns) AS period_ns FROM place GROUP BY drive_id, actor_id) USING (drive_id, actor_id)
WHERE every_ns >= 2.5 * period_ns AND len(list_filter(gaps, lambda gap: abs(gap / every_ns - round(gap / every_ns)) > 0.1)) = 0;
