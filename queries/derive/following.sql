-- Whom the ego follows at every step: of those ahead, without those that it meets, overtakes or goes past inside its lane, the nearest; who is
-- beside it is not ahead.
WITH changing AS (
    SELECT drive_id, ego_id, t_ns, bool_or(sure) AS sure
    FROM (
        -- astride for longer than a lane change takes, and round nobody, the ego is in its lane and in the next
        SELECT *, t_astride_ns IS NULL OR t_ns - t_astride_ns <= longest_change_ns() OR passing_id IS NOT NULL OR overtaking AS sure
        FROM line_step
        WHERE manoeuvre
    )
    WHERE sure IS DISTINCT FROM false
    GROUP BY ALL
),
judged AS (
    SELECT
        s.drive_id, s.ego_id, s.t_ns, l.object_id, l.gap_m, l.ego_speed_mps, l.speed_mps, l.joined_ns, l.let_in_ns, l.nearest, l.free_m,
        CASE
            WHEN l.t_ns IS NULL OR NOT l.known THEN NULL
            WHEN l.object_id IS NULL OR c.sure THEN false
            ELSE CASE WHEN c.t_ns IS NULL THEN true END AND l.in_lane AND l.gap_m >= 0 AND NOT l.oncoming AND (
                -- one that stands is in the ego's way, now and when the ego is there: else the ego steers round it, or passes it at the lane's edge
                l.across_m < 0 AND (l.speed_mps > standing_mps() OR l.passes_by IS DISTINCT FROM true AND on_course(
                    l.gap_m, ttc_s(l.gap_m, l.ego_speed_mps), e.d_m, e.lat_half_m, e.speed_mps * sin(e.heading_diff_rad), p.d_m, p.lat_half_m, 0.0
                ))
                -- one that moves beside the ego's way has its centre in the lane, and is not about to be passed
                OR l.speed_mps > standing_mps() AND abs(p.d_m) <= p.half_width_m AND l.gap_m >= drift_s() * (l.ego_speed_mps - l.speed_mps)
            )
        END AS follows
    FROM step s
    LEFT JOIN vehicle_ahead l ON l.drive_id = s.drive_id AND l.ego_id = s.ego_id AND l.t_ns = s.t_ns
    LEFT JOIN changing c ON c.drive_id = s.drive_id AND c.ego_id = s.ego_id AND c.t_ns = s.t_ns
    LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
    LEFT JOIN pair p ON p.drive_id = l.drive_id AND p.ego_id = l.ego_id AND p.t_ns = l.t_ns AND p.object_id = l.object_id
)
SELECT drive_id, ego_id, t_ns, object_id, gap_m, ego_speed_mps, speed_mps, joined_ns, let_in_ns, follows, free_m
FROM (
    SELECT *, row_number() OVER (
        PARTITION BY drive_id, ego_id, t_ns
        -- nobody is nearer than the lead; whom of the others it follows is known only where it may not follow one of whom that is not known
        ORDER BY CASE WHEN follows AND nearest THEN 0 WHEN follows IS NULL THEN 1 WHEN follows THEN 2 ELSE 3 END, nearest DESC, gap_m, object_id
    ) AS n
    FROM judged
)
WHERE n = 1
