-- Actors that the ego passed, or that passed it, while the log has a hole: along the ego's corridor, the actor is wholly ahead of the ego at the
-- last step before the hole and wholly behind it at the first step after it, or the other way round. How near the two came is not known.
-- lifetime: part
CREATE TABLE hole_passing (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the last step before the hole
    t_next_ns BIGINT NOT NULL,        -- the first step after the hole
    object_id VARCHAR NOT NULL,       -- an actor that is ahead of the ego on one side of the hole, and behind it on the other {position, heading, size}
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    along BOOLEAN                     -- the object heads in the corridor's direction, within 45 degrees; NULL: on one side of the hole only {heading}
);

INSERT INTO hole_passing BY NAME
WITH log_hole AS (
    SELECT drive_id, ego_id, t_before_ns, t_ns
    FROM (SELECT drive_id, ego_id, t_ns, seg, lag(t_ns) OVER w AS t_before_ns, lag(seg) OVER w AS seg_before FROM step WINDOW w AS (PARTITION BY drive_id, ego_id ORDER BY t_ns))
    WHERE seg > seg_before
),
-- occasion: log_hole
object_order AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, p.object_id, p.actor_class, p.rear_s_m > e.front_s_m AS is_ahead, p.front_s_m < e.rear_s_m AS is_behind, abs(p.heading_diff_rad) < pi() / 4 AS is_along
    FROM (SELECT drive_id, ego_id, t_ns FROM log_hole UNION SELECT drive_id, ego_id, t_before_ns FROM log_hole) h
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    JOIN pair p USING (drive_id, ego_id, t_ns)
)
SELECT
    h.drive_id, h.ego_id, h.t_before_ns AS t_ns, h.t_ns AS t_next_ns, b.object_id, b.actor_class, CASE WHEN b.is_along = a.is_along THEN b.is_along END AS along
FROM log_hole h
JOIN object_order b ON b.drive_id = h.drive_id AND b.ego_id = h.ego_id AND b.t_ns = h.t_before_ns
JOIN object_order a ON a.drive_id = h.drive_id AND a.ego_id = h.ego_id AND a.t_ns = h.t_ns AND a.object_id = b.object_id
WHERE b.is_ahead AND a.is_behind OR b.is_behind AND a.is_ahead
