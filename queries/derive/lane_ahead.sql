-- Vehicles and objects ahead of the ego in its running lane: with their centre in the lane, or partly in the lane and in the ego's way. The
-- table lead has the nearest vehicle of them. For an ego that is out of its lane, an object beside the lane that faces the ego and is in
-- its way is ahead, too (`outside`).
WITH
-- Actors that follow a lane of a junction. If such an actor comes across the ego's path, it crosses that path and is not ahead: see
-- conflict.
actor_on_junction_lane AS (
    SELECT DISTINCT o.drive_id, o.actor_id AS object_id, o.t_ns
    FROM lane_occupancy o
    JOIN data_log g USING (drive_id)
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
    WHERE n.drivable AND n.junction_id IS NOT NULL AND abs(o.heading_diff_rad) < along_lane_rad()
),
object_ahead AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, p.object_id, p.actor_class, p.rear_s_m - e.front_s_m AS gap_m, along_lane_mps(p.speed_mps, p.heading_diff_rad) AS speed_mps,
        abs(p.heading_diff_rad) > pi() / 2 AS oncoming, abs(p.d_m - e.d_m) - p.lat_half_m - e.lat_half_m AS across_m,
        sign(p.d_m - e.d_m) * e.speed_mps * sin(e.heading_diff_rad) AS ego_across_mps, sign(e.d_m - p.d_m) * p.speed_mps * sin(p.heading_diff_rad) AS across_mps,
        abs(p.d_m) <= p.half_width_m AS is_centre_in_lane, NOT in_lane(p.d_m, p.lat_half_m, p.half_width_m) AS outside,
        -- In the ego's way now, or soon at the present speeds across the lane. For an oncoming object only its present place counts.
        abs(p.d_m - e.d_m) - p.lat_half_m - e.lat_half_m
        < CASE WHEN abs(p.heading_diff_rad) < 2 * pi() / 3 THEN
            drift_s() * greatest(0.0, sign(p.d_m - e.d_m) * (e.speed_mps * sin(e.heading_diff_rad) - p.speed_mps * sin(p.heading_diff_rad)))
        ELSE 0.0 END AS soon
    FROM pair p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    LEFT JOIN actor_on_junction_lane c ON c.drive_id = p.drive_id AND c.object_id = p.object_id AND c.t_ns = p.t_ns
    WHERE may_be_vehicle_or_obstacle(p.actor_class, p.d_m - e.d_m, p.lat_half_m + e.lat_half_m) AND p.s_m > e.s_m
        AND (
            in_lane(p.d_m, p.lat_half_m, p.half_width_m)
            OR abs(p.heading_diff_rad) > 2 * pi() / 3 AND abs(p.d_m - e.d_m) < p.lat_half_m + e.lat_half_m
                -- Only the ego's front reaches an object that stands there. The rest of its box follows the front.
                AND (
                    (p.speed_mps <= standing_mps()) IS NOT true
                    OR abs(p.d_m - e.d_m - e.length_m / 2 * sin(e.heading_diff_rad)) < p.lat_half_m + e.width_m / 2 * cos(e.heading_diff_rad)
                )
        )
        -- An object beside the ego's box is not ahead, even if part of it is in the lane. If the two boxes overlap, they have met.
        AND (p.rear_s_m >= e.front_s_m OR abs(p.d_m - e.d_m) < p.lat_half_m + e.lat_half_m)
        AND (c.t_ns IS NULL OR abs(p.heading_diff_rad) < pi() / 4 OR p.speed_mps <= standing_mps())
)
-- The object's centre is in the lane, or the object is in the ego's way. A vehicle that only reaches over the line must not hide the
-- vehicle that the ego follows.
SELECT drive_id, ego_id, t_ns, object_id, actor_class, gap_m, speed_mps, oncoming, across_m, ego_across_mps, across_mps, soon, outside
FROM object_ahead
WHERE is_centre_in_lane OR soon
