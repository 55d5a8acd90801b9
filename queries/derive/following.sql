-- Whom the ego follows at every step: lead, without those that it meets, overtakes or goes past inside its lane.
WITH changing AS (
    SELECT DISTINCT drive_id, ego_id, t_ns FROM line_step WHERE manoeuvre
)
SELECT
    s.drive_id, s.ego_id, s.t_ns, l.object_id, l.gap_m, l.ego_speed_mps, l.speed_mps,
    CASE WHEN l.joined THEN l.t_since_ns END AS joined_ns,
    CASE
        WHEN l.t_ns IS NULL THEN NULL
        WHEN l.object_id IS NULL OR c.t_ns IS NOT NULL THEN false
        ELSE l.in_lane AND NOT l.oncoming
            -- one parked at the lane's edge is passed, one in the next lane that reaches over the line is beside: neither is in the ego's way
            AND (abs(p.d_m - e.d_m) < p.lat_half_m + e.lat_half_m OR l.speed_mps > standing_mps() AND abs(p.d_m) <= p.half_width_m)
    END AS follows
FROM step s
LEFT JOIN lead l ON l.drive_id = s.drive_id AND l.ego_id = s.ego_id AND l.t_ns = s.t_ns
LEFT JOIN changing c ON c.drive_id = s.drive_id AND c.ego_id = s.ego_id AND c.t_ns = s.t_ns
LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
LEFT JOIN pair p ON p.drive_id = l.drive_id AND p.ego_id = l.ego_id AND p.t_ns = l.t_ns AND p.object_id = l.object_id
