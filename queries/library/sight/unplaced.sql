-- Steps at which "no vehicle is coming" cannot be stated. A vehicle is present without a position, heading or size; or it moves off all
-- lanes, nearer than the end of the corridor; or its track begins or ends where it must have been on the road. A vehicle that enters over
-- the far end of the map was beyond that end until then. While the ego is far from that end, this has a code of its own (beyond_map). A
-- vehicle that the ego has already met has one, too (lost_behind).
-- lifetime: part
CREATE TABLE unplaced (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- a vehicle that may be on the road ahead, but has no position on it
    code VARCHAR NOT NULL             -- [unplaced_cause + lost + lost_behind + appeared + beyond_map] the reason; see _unseen
);

INSERT INTO unplaced BY NAME
WITH pair_without_position AS (
    SELECT drive_id, ego_id, t_ns, object_id, CASE WHEN off_level THEN 'off_level' ELSE 'no_position' END AS code
    FROM pair
    WHERE may_be_vehicle(actor_class) AND (x_m IS NULL OR y_m IS NULL)
),
pair_off_lanes AS (
    SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, 'off_lanes' AS code
    FROM (
        SELECT * FROM pair
        WHERE may_be_vehicle(actor_class) AND distance_m < corridor_ahead_m() AND (speed_mps IS NULL OR speed_mps > standing_mps())
    ) p
    ANTI JOIN (SELECT drive_id, actor_id, t_ns FROM lane_occupancy WHERE drivable) o
        ON o.drive_id = p.drive_id AND o.actor_id = p.object_id AND o.t_ns = p.t_ns
),
incomplete_pair AS (
    SELECT drive_id, ego_id, t_ns, object_id, CASE WHEN yaw_rad IS NULL THEN 'no_heading' ELSE 'no_size' END AS code
    FROM pair
    WHERE may_be_vehicle(actor_class) AND x_m IS NOT NULL AND (yaw_rad IS NULL OR length_m IS NULL OR width_m IS NULL)
)
SELECT drive_id, ego_id, t_ns, object_id, min(code) AS code
FROM (
    SELECT * FROM pair_without_position
    UNION ALL
    SELECT * FROM pair_off_lanes
    UNION ALL
    SELECT * FROM incomplete_pair
    UNION ALL
    SELECT u.drive_id, u.ego_id, u.t_ns, u.object_id, u.code
    FROM _unseen u
    JOIN road_user a ON a.drive_id = u.drive_id AND a.actor_id = u.object_id
    WHERE u.near AND may_be_vehicle(a.actor_class)
)
GROUP BY ALL
