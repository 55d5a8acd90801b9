-- The nearest vehicle behind that heads as the ego does, in the running lane and in the strip of one lane's width on either side, within
-- 200 m; or the certainty that there is none: where somebody without a place, or of no known class, may be nearer, or the ego itself has
-- no place, there is no row.
WITH near AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, {'gap_m': e.rear_s_m - p.front_s_m, 'object_id': p.object_id, 'speed_mps': p.speed_mps} AS o,
        p.d_m, p.lat_half_m, p.half_width_m, is_vehicle(p.actor_class) AS vehicle
    FROM pair p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    WHERE may_be_vehicle(p.actor_class) AND p.s_m <= e.s_m AND abs(p.heading_diff_rad) < pi() / 2
        AND e.rear_s_m - p.front_s_m <= follower_m()
),
behind AS (
    SELECT drive_id, ego_id, t_ns, lane, min(o) FILTER (vehicle) AS near, min(o.gap_m) FILTER (vehicle IS NULL) AS unsure_m
    FROM (
        SELECT *, 'own' AS lane FROM near WHERE in_lane(d_m, lat_half_m, half_width_m)
        UNION ALL
        SELECT *, 'left' FROM near WHERE in_lane(d_m - 2 * half_width_m, lat_half_m, half_width_m)
        UNION ALL
        SELECT *, 'right' FROM near WHERE in_lane(d_m + 2 * half_width_m, lat_half_m, half_width_m)
    )
    GROUP BY ALL
),
doubt AS (
    SELECT drive_id, ego_id, t_ns, min(least_m) FILTER (NOT late) AS least_m, min(least_m) AS any_m FROM hidden WHERE vehicle AND ahead IS DISTINCT FROM true GROUP BY ALL
)
SELECT
    e.drive_id, e.ego_id, e.t_ns, v.lane, b.near.object_id AS object_id, b.near.gap_m AS gap_m, b.near.speed_mps AS speed_mps,
    b.near.speed_mps - e.speed_mps AS closing_mps
FROM ego_state e
CROSS JOIN (VALUES ('own'), ('left'), ('right')) AS v(lane)
LEFT JOIN behind b ON b.drive_id = e.drive_id AND b.ego_id = e.ego_id AND b.t_ns = e.t_ns AND b.lane = v.lane
LEFT JOIN doubt d ON d.drive_id = e.drive_id AND d.ego_id = e.ego_id AND d.t_ns = e.t_ns
WHERE e.rear_s_m IS NOT NULL AND coalesce(least(CASE WHEN b.near IS NULL THEN d.any_m ELSE d.least_m END, b.unsure_m) >= coalesce(b.near.gap_m, follower_m()), true)
