-- Objects whose box overlaps the ego's along the corridor, and the gap between the two boxes across it. An object's speed across the
-- corridor comes from its velocity if it has a sample at the time of the step, else from its speed and heading. An object that is passed in a
-- hole of the log may be beside the ego from the last step before the hole on.
-- lifetime: part
CREATE TABLE beside (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which the two boxes overlap along the corridor, or after which they pass each other before the next step; or at which they may overlap, or after which they pass each other in a hole: then the columns from side on are NULL, but along if they pass in a hole
    object_id VARCHAR NOT NULL,       -- another actor
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    side VARCHAR,                     -- [side] the side of the ego on which the object is {position}
    gap_m DOUBLE,                     -- gap between the two boxes across the corridor; negative: overlap; if they pass each other between two steps, the mean of the gaps at both {position, heading, size}
    clearance_m DOUBLE,               -- distance between the two boxes, see pair; if they pass each other between two steps, gap_m {position, heading, size}
    blur_m DOUBLE,                    -- how much nearer the two may have been between this step and its neighbours, if both swerve by 3 m/s2; 0 in a log of about ten or more samples a second {position}
    ahead_m DOUBLE,                   -- distance from the ego's front to the object's front along the corridor, positive ahead {position}
    ego_speed_mps DOUBLE,             -- speed of the ego {velocity}
    speed_mps DOUBLE,                 -- speed of the object {velocity}
    ego_lat_mps DOUBLE,               -- the ego's speed across the corridor, positive towards the object {velocity}
    lat_mps DOUBLE,                   -- the object's speed across the corridor, positive towards the ego {velocity}
    cycle_lane VARCHAR,               -- [marking + unsaid] the object is on a cycle lane of the carriageway: the marking between this lane and the lane of motor vehicles, unsaid if the map states none; NULL: it is on no cycle lane {position}
    along BOOLEAN,                    -- the object heads in the corridor's direction, within 45 degrees {position}
    on_carriageway BOOLEAN,           -- the object is on the carriageway: its box reaches into the running lane or a drivable lane beside it, or its centre is on a drivable lane or an adjacent cycle lane. Not behind a verge, kerb or footway; NULL: not known
    on_strip BOOLEAN                  -- the object's centre is beside the drivable lanes, with no kerb or verge between: on a shoulder, stop, border, parking, restricted or cycle lane; NULL: not known, as behind a border, which may be a kerb {position}
);

INSERT INTO beside BY NAME
WITH RECURSIVE
-- The object and the ego pass each other between this step and the next; they are beside each other at neither of the two steps.
pass_between_steps AS (
    SELECT n.* REPLACE ((n.gap_m + m.gap_m) / 2 AS gap_m, (n.gap_m + m.gap_m) / 2 AS clearance_m)
    FROM neighbour n
    JOIN clock c USING (drive_id, ego_id)
    JOIN neighbour m ON m.drive_id = n.drive_id AND m.ego_id = n.ego_id AND m.object_id = n.object_id AND m.k = n.k + 1 AND m.seg = n.seg AND m.chain_id = n.chain_id
    WHERE greatest(n.gap_ahead_m, n.gap_behind_m) > 0 AND greatest(n.gap_ahead_m, n.gap_behind_m) < (coalesce(n.ego_speed_mps, unknown_speed_mps()) + coalesce(n.speed_mps, unknown_speed_mps())) * c.max_gap_ns / 1e9
        AND (n.gap_ahead_m > 0 AND m.gap_behind_m > 0 OR n.gap_behind_m > 0 AND m.gap_ahead_m > 0)
),
beside_object AS (
    SELECT n.*, e.d_m AS ego_d_m, e.s_m AS ego_s_m, e.yaw_rad - e.heading_diff_rad AS way_rad
    FROM (FROM neighbour WHERE gap_ahead_m <= 0 AND gap_behind_m <= 0 UNION ALL FROM pass_between_steps) n
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
),
beside_motion AS (
    SELECT
        n.*, coalesce(s.vy_mps * cos(n.way_rad) - s.vx_mps * sin(n.way_rad), n.speed_mps * sin(n.heading_diff_rad)) AS drift_mps
    FROM beside_object n
    LEFT JOIN state_dynamics s ON s.drive_id = n.drive_id AND s.actor_id = n.object_id AND s.t_ns = n.t_ns
),
-- The drivable lane beside the running lane, on the side of the object.
adjacent_lane AS (
    SELECT n.drive_id, n.ego_id, n.t_ns, n.object_id, max(b.width_m) AS width_m
    FROM beside_object n
    JOIN data_log g ON g.drive_id = n.drive_id
    JOIN chain c ON c.drive_id = n.drive_id AND c.ego_id = n.ego_id AND c.chain_id = n.chain_id
        AND c.s_start_m <= n.ego_s_m AND n.ego_s_m <= c.s_start_m + c.length_m
    JOIN lanelet r ON r.environment_id = g.environment_id AND r.lanelet_id = c.lanelet_id
    JOIN lanelet b ON b.environment_id = g.environment_id AND b.lanelet_id = CASE WHEN n.d_m > 0 THEN r.left_id ELSE r.right_id END
    WHERE b.drivable
    GROUP BY ALL
),
-- A cycle lane belongs to the carriageway. A cycle track behind a verge or a kerb does not.
cycle_lane AS (
    SELECT n.environment_id, n.lanelet_id, coalesce(min(b.marking), 'unsaid') AS marking
    FROM lanelet n
    CROSS JOIN (VALUES ('left'), ('right')) AS v(side)
    JOIN lanelet m ON m.environment_id = n.environment_id AND m.drivable AND m.lanelet_id = CASE v.side WHEN 'left' THEN n.left_id ELSE n.right_id END
    LEFT JOIN lane_boundary b ON b.environment_id = n.environment_id AND b.lanelet_id = n.lanelet_id AND b.side = v.side
    WHERE n.lane_type = 'biking'
    GROUP BY n.environment_id, n.lanelet_id
    HAVING coalesce(bool_and(b.marking NOT IN ('curb', 'grass')), true)
),
object_on_cycle_lane AS (
    SELECT n.drive_id, n.ego_id, n.t_ns, n.object_id, min(y.marking) AS marking
    FROM beside_object n
    JOIN data_log g ON g.drive_id = n.drive_id
    JOIN lane_occupancy o ON o.drive_id = n.drive_id AND o.actor_id = n.object_id AND o.t_ns = n.t_ns
    JOIN cycle_lane y ON y.environment_id = g.environment_id AND y.lanelet_id = o.lanelet_id
    GROUP BY ALL
),
-- The drivable lanelets, and the lanelets beside them without a kerb or verge between, on which people ride, too. A border may be a kerb,
-- and no vehicle drives over restricted ground. It is therefore not known whether a lanelet beyond a border or restricted ground belongs to
-- the road (is_certain is false).
rideable_lanelet AS (
    SELECT environment_id, lanelet_id, lane_type, true AS is_certain FROM lanelet WHERE drivable
    UNION
    SELECT n.environment_id, n.lanelet_id, n.lane_type, r.is_certain AND r.lane_type NOT IN ('border', 'restricted')
    FROM rideable_lanelet r
    JOIN lanelet n ON n.environment_id = r.environment_id AND (n.left_id = r.lanelet_id OR n.right_id = r.lanelet_id) AND NOT n.drivable
        AND n.lane_type IN ('shoulder', 'stop', 'border', 'parking', 'restricted', 'biking')
    ANTI JOIN lane_boundary b ON b.environment_id = n.environment_id AND b.lanelet_id = n.lanelet_id AND b.marking IN ('curb', 'grass')
        AND b.side = CASE WHEN n.left_id = r.lanelet_id THEN 'left' ELSE 'right' END
),
object_on_rideable_lanelet AS (
    SELECT n.drive_id, n.ego_id, n.t_ns, n.object_id, bool_or(y.is_certain) AS is_certain
    FROM beside_object n
    JOIN data_log g ON g.drive_id = n.drive_id
    JOIN lane_occupancy o ON o.drive_id = n.drive_id AND o.actor_id = n.object_id AND o.t_ns = n.t_ns AND NOT o.drivable
    JOIN rideable_lanelet y ON y.environment_id = g.environment_id AND y.lanelet_id = o.lanelet_id
    GROUP BY ALL
),
object_on_lane AS (
    SELECT DISTINCT n.drive_id, n.ego_id, n.t_ns, n.object_id
    FROM beside_object n
    JOIN lane_occupancy o ON o.drive_id = n.drive_id AND o.actor_id = n.object_id AND o.t_ns = n.t_ns
    WHERE o.drivable
),
-- Actors that may be beside the ego, but whose position on the corridor is not known.
possibly_beside AS (
    SELECT drive_id, ego_id, t_ns, object_id, actor_class FROM hidden WHERE least_m < may_be_beside_m()
    UNION
    SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, p.actor_class
    FROM pair p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    WHERE NOT p.clearance_is_bound AND (e.front_s_m IS NULL OR p.front_s_m IS NULL)
        -- The object is more than 15 m from the running lane's centre line (strip_m), or the ego itself has no position on a corridor.
        AND p.clearance_m < may_be_beside_m() AND (e.front_s_m IS NULL OR p.clearance_m < may_be_beside_m() / 2)
)
SELECT
    m.drive_id, m.ego_id, m.t_ns, m.object_id, m.actor_class, m.side, m.gap_m, m.clearance_m,
    -- blur_m: how much nearer the two may come between two steps, if both swerve towards each other at bend_mps2 and back.
    CASE WHEN k.period_ns > 110_000_000 THEN 2 * bend_mps2() * (k.period_ns / 1e9) ** 2 / 8 ELSE 0.0 END AS blur_m, m.ahead_m, m.ego_speed_mps, m.speed_mps,
    CASE WHEN m.d_m > m.ego_d_m THEN m.ego_left_mps ELSE -m.ego_left_mps END AS ego_lat_mps,
    CASE WHEN m.d_m > m.ego_d_m THEN -m.drift_mps ELSE m.drift_mps END AS lat_mps,
    abs(m.heading_diff_rad) < pi() / 4 AS along, y.marking AS cycle_lane,
    o.object_id IS NOT NULL OR y.object_id IS NOT NULL OR abs(m.d_m) - m.lat_half_m < m.half_width_m + coalesce(l.width_m, 0.0) AS on_carriageway,
    CASE WHEN z.object_id IS NULL THEN false WHEN z.is_certain THEN true END AS on_strip
FROM beside_motion m
JOIN clock k USING (drive_id, ego_id)
LEFT JOIN adjacent_lane l USING (drive_id, ego_id, t_ns, object_id)
LEFT JOIN object_on_lane o USING (drive_id, ego_id, t_ns, object_id)
LEFT JOIN object_on_cycle_lane y USING (drive_id, ego_id, t_ns, object_id)
LEFT JOIN object_on_rideable_lanelet z USING (drive_id, ego_id, t_ns, object_id)
UNION ALL BY NAME
SELECT drive_id, ego_id, t_ns, object_id, actor_class FROM possibly_beside
UNION ALL BY NAME
SELECT drive_id, ego_id, t_ns, object_id, actor_class, along FROM hole_passing
