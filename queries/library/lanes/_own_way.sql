-- The recorded path of the ego's box centre, as segments of some 2 m, extrapolated beyond its end with the last curvature. A hole in the
-- log begins a new piece, because the path across the hole is not recorded.
-- lifetime: part
CREATE TABLE _own_way (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    seg INTEGER NOT NULL,             -- see step: a new piece of the path begins after a hole
    k INTEGER NOT NULL,               -- number of the segment along the piece, from 0
    t_from_ns BIGINT,                 -- time at which the ego's centre was at the segment's start; NULL: it is beyond the recorded end
    s0_m DOUBLE NOT NULL,             -- path length from the start of the piece to the start of the segment {position}
    len_m DOUBLE NOT NULL,            -- length of the segment {position}
    driven_m DOUBLE NOT NULL,         -- driven length of the piece; beyond it, the path is extrapolated with the same curvature for 3 s at the last speed, at least 25 m {position}
    x0_m DOUBLE NOT NULL,             -- start, x {position}
    y0_m DOUBLE NOT NULL,             -- start, y {position}
    tx0 DOUBLE NOT NULL,              -- unit tangent at the start, x {position}
    ty0 DOUBLE NOT NULL,              -- unit tangent at the start, y {position}
    x1_m DOUBLE NOT NULL,             -- end, x {position}
    y1_m DOUBLE NOT NULL,             -- end, y {position}
    tx1 DOUBLE NOT NULL,              -- unit tangent at the end, x {position}
    ty1 DOUBLE NOT NULL,              -- unit tangent at the end, y {position}
    bend_per_m DOUBLE NOT NULL        -- curvature, 1 / radius, left positive {position}
);

INSERT INTO _own_way BY NAME
WITH placed_step AS (
    SELECT
        st.drive_id, st.ego_id, st.seg, st.t_ns, s.x_m, s.y_m, s.yaw_rad, s.speed_mps,
        -- The positions of a standing ego jitter, which adds no distance.
        floor(from_picometres(sum(CASE WHEN s.speed_mps > standing_mps() THEN to_picometres(coalesce(st.travel_m - lag_m, 0.0)) ELSE 0 END) OVER w) / way_point_m())::INTEGER AS bucket
    FROM (SELECT *, lag(travel_m) OVER (PARTITION BY drive_id, ego_id, seg ORDER BY t_ns) AS lag_m FROM step) st
    JOIN state_dynamics s ON s.drive_id = st.drive_id AND s.actor_id = st.ego_id AND s.t_ns = st.t_ns
    WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL
    WINDOW w AS (PARTITION BY st.drive_id, st.ego_id, st.seg ORDER BY st.t_ns ROWS UNBOUNDED PRECEDING)
),
first_of_bucket AS (
    SELECT drive_id, ego_id, seg, min({'t_ns': t_ns, 'x_m': x_m, 'y_m': y_m}) AS p FROM placed_step GROUP BY drive_id, ego_id, seg, bucket
),
last_step AS (
    SELECT drive_id, ego_id, seg, max({'t_ns': t_ns, 'x_m': x_m, 'y_m': y_m, 'yaw_rad': yaw_rad, 'speed_mps': speed_mps}) AS p FROM placed_step GROUP BY drive_id, ego_id, seg
),
way_point AS (
    SELECT
        drive_id, ego_id, seg, p.t_ns AS t_ns, p.x_m AS x_m, p.y_m AS y_m, lead(p) OVER w AS next_point, lag(p) OVER w AS point_before
    FROM (
        FROM first_of_bucket
        UNION ALL
        -- The path ends at the ego's last step, not at the beginning of the last whole bucket.
        SELECT l.drive_id, l.ego_id, l.seg, {'t_ns': l.p.t_ns, 'x_m': l.p.x_m, 'y_m': l.p.y_m}
        FROM last_step l
        JOIN (SELECT drive_id, ego_id, seg, max(p) AS p FROM first_of_bucket GROUP BY drive_id, ego_id, seg) b USING (drive_id, ego_id, seg)
        WHERE sqrt((l.p.x_m - b.p.x_m) ** 2 + (l.p.y_m - b.p.y_m) ** 2) > way_point_m() / 4
    )
    WINDOW w AS (PARTITION BY drive_id, ego_id, seg ORDER BY p.t_ns)
),
turned_point AS (
    SELECT
        * EXCLUDE (point_before),
        atan2(coalesce(next_point.y_m, y_m) - coalesce(point_before.y_m, y_m), coalesce(next_point.x_m, x_m) - coalesce(point_before.x_m, x_m)) AS heading_rad,
        coalesce(next_point, point_before) IS NOT NULL AS is_driven,
        from_picometres(sum(to_picometres(coalesce(sqrt((x_m - point_before.x_m) ** 2 + (y_m - point_before.y_m) ** 2), 0.0))) OVER w) AS s_m
    FROM way_point
    WINDOW w AS (PARTITION BY drive_id, ego_id, seg ORDER BY t_ns ROWS UNBOUNDED PRECEDING)
),
-- The end of each piece. Its direction is the ego's heading, if that agrees with the driven path; its curvature is that of the last metres.
way_end AS (
    SELECT
        p.drive_id, p.ego_id, p.seg, p.t_ns, p.x_m, p.y_m, p.s_m, l.p.speed_mps AS speed_mps,
        CASE WHEN NOT p.is_driven OR cos(l.p.yaw_rad - p.heading_rad) > cos(pi() / 4) THEN l.p.yaw_rad WHEN p.is_driven THEN p.heading_rad END AS heading_rad,
        coalesce(CASE WHEN p.is_driven THEN greatest(-sharpest_bend_per_m(), least(sharpest_bend_per_m(), coalesce(wrap_rad(p.heading_rad - p.earlier.heading_rad) / nullif(p.heading_at_m - p.earlier.heading_at_m, 0), 0.0))) END, 0.0) AS bend_per_m
    FROM (
        SELECT *, first_value({'heading_rad': heading_rad, 'heading_at_m': heading_at_m}) OVER (PARTITION BY drive_id, ego_id, seg ORDER BY t_ns ROWS BETWEEN 3 PRECEDING AND CURRENT ROW) AS earlier
        FROM (
            -- The heading is that of the chord from the point before to the next one, and so the heading in the middle between these.
            SELECT *, (coalesce(lead(s_m) OVER w, s_m) + coalesce(lag(s_m) OVER w, s_m)) / 2 AS heading_at_m
            FROM turned_point
            WINDOW w AS (PARTITION BY drive_id, ego_id, seg ORDER BY t_ns)
        )
    ) p
    JOIN last_step l USING (drive_id, ego_id, seg)
    WHERE p.next_point IS NULL
),
vertex AS (
    SELECT p.drive_id, p.ego_id, p.seg, p.t_ns, p.x_m, p.y_m, p.s_m, CASE WHEN p.next_point IS NULL THEN e.heading_rad ELSE p.heading_rad END AS heading_rad, e.s_m AS driven_m
    FROM turned_point p
    JOIN way_end e USING (drive_id, ego_id, seg)
    UNION ALL
    SELECT
        drive_id, ego_id, seg, NULL, x_m + chord_m * cos(heading_rad + bend_per_m * on_m / 2), y_m + chord_m * sin(heading_rad + bend_per_m * on_m / 2), s_m + on_m,
        heading_rad + bend_per_m * on_m, s_m
    FROM (
        SELECT *, CASE WHEN abs(bend_per_m * on_m) < 1e-6 THEN on_m ELSE 2 * sin(bend_per_m * on_m / 2) / bend_per_m END AS chord_m
        FROM (SELECT *, unnest(range(1, 11)) * way_on_m(speed_mps) / 10 AS on_m FROM way_end WHERE heading_rad IS NOT NULL)
    )
)
SELECT
    drive_id, ego_id, seg, (row_number() OVER w - 1)::INTEGER AS k, t_ns AS t_from_ns, s_m AS s0_m, next.s_m - s_m AS len_m, driven_m,
    x_m AS x0_m, y_m AS y0_m, cos(heading_rad) AS tx0, sin(heading_rad) AS ty0, next.x_m AS x1_m, next.y_m AS y1_m, cos(next.heading_rad) AS tx1, sin(next.heading_rad) AS ty1,
    wrap_rad(next.heading_rad - heading_rad) / (next.s_m - s_m) AS bend_per_m
FROM (SELECT *, lead({'s_m': s_m, 'x_m': x_m, 'y_m': y_m, 'heading_rad': heading_rad}) OVER w AS next FROM vertex WINDOW w AS (PARTITION BY drive_id, ego_id, seg ORDER BY s_m))
WHERE next IS NOT NULL AND next.s_m > s_m AND heading_rad IS NOT NULL
WINDOW w AS (PARTITION BY drive_id, ego_id, seg ORDER BY s_m)
