-- Vehicles and things ahead of the ego in its running lane, or in its way there; lead is the nearest vehicle of them. An ego that is out of its
-- lane also has ahead of it whatever is turned towards it, in its way beside the lane (`outside`).
WITH
-- who follows a junction's lane of his own that leads across the ego's way crosses it: see conflict
crossing AS (
    SELECT DISTINCT o.drive_id, o.actor_id AS object_id, o.t_ns
    FROM lane_occupancy o
    JOIN data_log g USING (drive_id)
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
    WHERE n.drivable AND n.junction_id IS NOT NULL AND abs(o.heading_diff_rad) < own_way_rad()
),
placed AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, p.object_id, p.actor_class, p.rear_s_m - e.front_s_m AS gap_m, along_lane_mps(p.speed_mps, p.heading_diff_rad) AS speed_mps,
        abs(p.heading_diff_rad) > pi() / 2 AS oncoming, abs(p.d_m - e.d_m) - p.lat_half_m - e.lat_half_m AS across_m,
        sign(p.d_m - e.d_m) * e.speed_mps * sin(e.heading_diff_rad) AS ego_across_mps, sign(e.d_m - p.d_m) * p.speed_mps * sin(p.heading_diff_rad) AS across_mps,
        abs(p.d_m) <= p.half_width_m AS centre_in, NOT in_lane(p.d_m, p.lat_half_m, p.half_width_m) AS outside,
        -- now or soon at the present speeds across (who comes towards the ego: now)
        abs(p.d_m - e.d_m) - p.lat_half_m - e.lat_half_m
        < CASE WHEN abs(p.heading_diff_rad) < 2 * pi() / 3 THEN
            drift_s() * greatest(0.0, sign(p.d_m - e.d_m) * (e.speed_mps * sin(e.heading_diff_rad) - p.speed_mps * sin(p.heading_diff_rad)))
        ELSE 0.0 END AS soon
    FROM pair p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    LEFT JOIN crossing c ON c.drive_id = p.drive_id AND c.object_id = p.object_id AND c.t_ns = p.t_ns
    WHERE may_be_ahead(p.actor_class, p.d_m - e.d_m, p.lat_half_m + e.lat_half_m) AND p.s_m > e.s_m
        AND (
            in_lane(p.d_m, p.lat_half_m, p.half_width_m)
            OR abs(p.heading_diff_rad) > 2 * pi() / 3 AND abs(p.d_m - e.d_m) < p.lat_half_m + e.lat_half_m
                -- the ego's front alone comes to what stands there; the rest of its box follows the front
                AND (
                    (p.speed_mps <= standing_mps()) IS NOT true
                    OR abs(p.d_m - e.d_m - e.length_m / 2 * sin(e.heading_diff_rad)) < p.lat_half_m + e.width_m / 2 * cos(e.heading_diff_rad)
                )
        )
        -- one beside the ego's box is not ahead, whatever of it is in the lane; where the two overlap they have met
        AND (p.rear_s_m >= e.front_s_m OR abs(p.d_m - e.d_m) < p.lat_half_m + e.lat_half_m)
        AND (c.t_ns IS NULL OR abs(p.heading_diff_rad) < pi() / 4 OR p.speed_mps <= standing_mps())
)
-- in the lane with its centre, or in the ego's way: a vehicle that only reaches over the line must not hide whom the ego follows
SELECT drive_id, ego_id, t_ns, object_id, actor_class, gap_m, speed_mps, oncoming, across_m, ego_across_mps, across_mps, soon, outside
FROM placed
WHERE centre_in OR soon
