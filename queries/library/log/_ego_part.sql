-- Actors of the log that belong to the ego: the trailer that it tows, and the same vehicle under another id before or after the ego's own
-- track.
-- lifetime: part
CREATE TABLE _ego_part (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- an actor of the log that belongs to the ego and is no other road user
    part VARCHAR NOT NULL             -- [part_of_ego]
);

INSERT INTO _ego_part BY NAME
WITH track AS (
    SELECT drive_id, actor_id, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns FROM state_dynamics GROUP BY drive_id, actor_id
),
-- In time: one track ends when the other begins.
handover AS (
    SELECT c.drive_id, c.ego_id, o.actor_id AS object_id, 'successor' AS part, c.ego_id AS early_id, c.t_end_ns AS t_ends_ns, o.actor_id AS late_id, o.t_first_ns AS t_begins_ns
    FROM clock c
    JOIN track o ON o.drive_id = c.drive_id AND o.actor_id <> c.ego_id
    WHERE abs(o.t_first_ns - c.t_end_ns) <= c.max_gap_ns AND o.t_first_ns > c.t_start_ns AND o.t_last_ns > c.t_end_ns
    UNION ALL
    SELECT c.drive_id, c.ego_id, o.actor_id, 'predecessor', o.actor_id, o.t_last_ns, c.ego_id, c.t_start_ns
    FROM clock c
    JOIN track o ON o.drive_id = c.drive_id AND o.actor_id <> c.ego_id
    WHERE abs(o.t_last_ns - c.t_start_ns) <= c.max_gap_ns AND o.t_first_ns < c.t_start_ns AND o.t_last_ns < c.t_end_ns
),
-- In place: one track ends where the other begins, so closely that two vehicles have no room.
renamed_ego AS (
    SELECT h.drive_id, h.ego_id, h.object_id, h.part
    FROM handover h
    JOIN state_dynamics a ON a.drive_id = h.drive_id AND a.actor_id = h.early_id AND a.t_ns = h.t_ends_ns
    JOIN state_dynamics b ON b.drive_id = h.drive_id AND b.actor_id = h.late_id AND b.t_ns = h.t_begins_ns
    CROSS JOIN LATERAL (SELECT (b.t_ns - a.t_ns) / 1e9 AS dt_s) d
    WHERE sqrt((b.x_m - a.x_m - a.vx_mps * dt_s) ** 2 + (b.y_m - a.y_m - a.vy_mps * dt_s) ** 2) <= same_place_m()
        AND abs(wrap_rad(b.yaw_rad - a.yaw_rad)) <= same_heading_rad() AND same_size(a.length_m, b.length_m) AND same_size(a.width_m, b.width_m)
        AND may_be_vehicle(a.actor_class) AND may_be_vehicle(b.actor_class)
),
-- Actors close behind the ego at the first moment at which both are present. Only for these few actors is the whole track examined.
actor_behind AS (
    SELECT w.drive_id, w.ego_id, w.object_id, w.is_called_trailer
    FROM (
        SELECT c.drive_id, c.ego_id, o.actor_id AS object_id, a.actor_class IS NOT DISTINCT FROM 'trailer' AS is_called_trailer, greatest(c.t_start_ns, o.t_first_ns) AS t_ns
        FROM clock c
        JOIN track o ON o.drive_id = c.drive_id AND o.actor_id <> c.ego_id
        JOIN actor a ON a.drive_id = o.drive_id AND a.actor_id = o.actor_id
        WHERE coalesce(a.actor_class IN ('trailer', 'vehicle', 'truck', 'object'), true)
    ) w
    JOIN state_dynamics e ON e.drive_id = w.drive_id AND e.actor_id = w.ego_id AND e.t_ns = w.t_ns
    JOIN state_dynamics o ON o.drive_id = w.drive_id AND o.actor_id = w.object_id AND o.t_ns = w.t_ns
    WHERE (o.x_m - e.x_m) ** 2 + (o.y_m - e.y_m) ** 2 <= ((e.length_m + o.length_m) / 2 + drawbar_m()) ** 2
        AND (o.x_m - e.x_m) * cos(e.yaw_rad) + (o.y_m - e.y_m) * sin(e.yaw_rad) < 0
),
-- occasion: handover, actor_behind
shared_sample AS (
    SELECT
        b.*, o.t_ns, e.length_m / 2 AS ego_half_length_m, sqrt((e.x_m - lag(e.x_m) OVER w) ** 2 + (e.y_m - lag(e.y_m) OVER w) ** 2) AS moved_m,
        e.x_m - o.x_m AS dx, e.y_m - o.y_m AS dy, e.yaw_rad AS ego_yaw_rad, o.yaw_rad,
        box_clearance(
            (o.x_m - e.x_m) * cos(e.yaw_rad) + (o.y_m - e.y_m) * sin(e.yaw_rad), (o.y_m - e.y_m) * cos(e.yaw_rad) - (o.x_m - e.x_m) * sin(e.yaw_rad),
            cos(o.yaw_rad - e.yaw_rad), sin(o.yaw_rad - e.yaw_rad), e.length_m / 2, e.width_m / 2, o.length_m / 2, o.width_m / 2
        ) AS clearance_m
    FROM actor_behind b
    JOIN state_dynamics o ON o.drive_id = b.drive_id AND o.actor_id = b.object_id
    JOIN state_dynamics e ON e.drive_id = b.drive_id AND e.actor_id = b.ego_id AND e.t_ns = o.t_ns
    -- box_clearance needs all of these values.
    WHERE o.x_m + o.y_m + o.yaw_rad + o.length_m + o.width_m + e.x_m + e.y_m + e.yaw_rad + e.length_m + e.width_m IS NOT NULL
    WINDOW w AS (PARTITION BY b.drive_id, b.ego_id, b.object_id ORDER BY o.t_ns)
),
-- The hitch is the point about which the trailer turns, hitch_m behind the ego's rear (negative for a fifth wheel, which lies before it).
hitched_trailer AS (
    SELECT drive_id, ego_id, object_id
    FROM (
        SELECT t.*, h.rearward_m AS hitch_m, dx - (ego_half_length_m + h.rearward_m) * cos(ego_yaw_rad) AS hitch_x_m, dy - (ego_half_length_m + h.rearward_m) * sin(ego_yaw_rad) AS hitch_y_m
        FROM shared_sample t CROSS JOIN (SELECT unnest(range(-10, 7)) / 4 AS rearward_m) h
    )
    GROUP BY drive_id, ego_id, object_id, is_called_trailer, hitch_m
    HAVING max(sqrt(hitch_x_m ** 2 + hitch_y_m ** 2)) - min(sqrt(hitch_x_m ** 2 + hitch_y_m ** 2)) <= hitch_m()
        AND max(abs(wrap_rad(atan2(hitch_y_m, hitch_x_m) - yaw_rad))) <= hitch_rad()
        AND max(clearance_m) <= CASE WHEN is_called_trailer THEN drawbar_m() ELSE touching_m() END
        AND (is_called_trailer OR sum(moved_m) >= towed_m())
)
SELECT drive_id, ego_id, object_id, min(part) AS part
FROM (SELECT * FROM renamed_ego UNION ALL SELECT DISTINCT *, 'trailer' FROM hitched_trailer)
GROUP BY ALL
