-- The nearest vehicle ahead in the running lane, or the certainty that there is none: a step at which somebody cannot be placed, or the
-- ego itself cannot, has no row.
WITH ahead AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns,
        min({'gap_m': p.rear_s_m - e.front_s_m, 'object_id': p.object_id, 'speed_mps': p.speed_mps}) AS near
    FROM pair p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    WHERE may_be_vehicle(p.actor_class) AND p.s_m > e.s_m AND abs(p.d_m) - p.lat_half_m < p.half_width_m - over_boundary_m()
        -- what stands the wrong way round is in the way all the same
        AND (abs(p.heading_diff_rad) < 2 * pi() / 3 OR p.speed_mps <= standing_mps())
    GROUP BY ALL
)
SELECT e.drive_id, e.ego_id, e.t_ns, a.near.object_id AS object_id, a.near.gap_m AS gap_m, a.near.speed_mps AS speed_mps
FROM ego_state e
LEFT JOIN ahead a USING (drive_id, ego_id, t_ns)
ANTI JOIN unplaced u ON u.drive_id = e.drive_id AND u.ego_id = e.ego_id AND u.t_ns = e.t_ns
WHERE e.front_s_m IS NOT NULL
