-- All vehicles that come towards the ego in the lane in which the ego would overtake, at each step. OV (oncoming vehicle) and DA (distance
-- ahead) are terms of Harper et al. 2021. The nearest OV may not be the critical one: if it waits or is slow, it leaves more time. A
-- vehicle that never moved is parked and does not count. A horse on the road counts as a vehicle. A vehicle from another lane counts from
-- 15 s before it reaches this lane, at the distance that it then really drives.
-- lifetime: part
CREATE TABLE _oncoming_vehicle (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    object_id VARCHAR NOT NULL,       -- a vehicle or animal that comes towards the ego in the lane in which the ego would overtake; not one that never moved
    vehicle BOOLEAN,                  -- it is a vehicle; NULL: its class is not known {class}
    da_m DOUBLE,                      -- distance along the corridor from the ego's front to its nearest corner; if on_its_way, plus the distance that it has to drive to the corridor {position}
    speed_mps DOUBLE,                 -- speed of the vehicle {velocity}
    on_its_way BOOLEAN NOT NULL       -- it is not on the corridor yet, but gets there within 15 s {position, heading, velocity}
);

INSERT INTO _oncoming_vehicle BY NAME
WITH ego_step AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, e.s_m, e.front_s_m, x.side, x.over_width_m
    FROM ego_state e
    JOIN ego_corridor x ON x.drive_id = e.drive_id AND x.ego_id = e.ego_id AND x.chain_id = e.chain_id AND x.t_ns = e.t_ns
    WHERE e.front_s_m IS NOT NULL AND x.side IS NOT NULL
),
-- Recorded positions and velocities may jitter. An object moves if it leaves its place, or if it is fast and seen too briefly to leave it.
standing_object AS (
    SELECT drive_id, actor_id AS object_id
    FROM state_dynamics
    GROUP BY ALL
    HAVING greatest(max(x_m) - min(x_m), max(y_m) - min(y_m)) <= standing_spread_m()
        AND (max(t_ns) - min(t_ns) >= standing_spread_m() / standing_mps() * 1e9 OR coalesce(max(speed_mps) <= standing_mps(), false))
),
oncoming_object AS (
    SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id, p.rear_s_m, p.speed_mps, p.rear_s_m - e.front_s_m AS da_m, is_vehicle(p.actor_class) OR p.actor_class = 'animal' AS vehicle
    FROM pair p
    JOIN ego_step e USING (drive_id, ego_id, t_ns)
    ANTI JOIN standing_object o ON o.drive_id = p.drive_id AND o.object_id = p.object_id
    WHERE (may_be_vehicle(p.actor_class) OR p.actor_class = 'animal') AND p.s_m > e.s_m AND abs(p.heading_diff_rad) > 2 * pi() / 3
        AND e.side * p.d_m - p.lat_half_m < p.half_width_m + coalesce(p.over_width_m, e.over_width_m, 2 * p.half_width_m)
        -- A vehicle that stands against the direction of the running lane is parked there. A moving one is oncoming.
        AND e.side * p.d_m + p.lat_half_m > CASE WHEN p.speed_mps <= standing_mps() THEN p.half_width_m + over_boundary_m() ELSE -p.half_width_m END
),
lane_entry AS (
    SELECT drive_id, ego_id, object_id, min({'t_ns': t_ns, 's_m': rear_s_m}) AS e FROM oncoming_object WHERE vehicle GROUP BY ALL
),
-- The distance that the vehicle still has to drive to the lane, at each step before it arrives; straight on over steps without a position.
approach_step AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, p.object_id, p.speed_mps, p.x_m, y.e.s_m AS entry_s_m,
        sqrt((p.x_m - lead(p.x_m IGNORE NULLS) OVER w) ** 2 + (p.y_m - lead(p.y_m IGNORE NULLS) OVER w) ** 2) AS step_m, p.t_ns = y.e.t_ns AS has_arrived
    FROM lane_entry y
    JOIN pair p ON p.drive_id = y.drive_id AND p.ego_id = y.ego_id AND p.object_id = y.object_id
        AND p.t_ns <= y.e.t_ns AND p.t_ns >= y.e.t_ns - 15_000_000_000
    WINDOW w AS (PARTITION BY p.drive_id, p.ego_id, p.object_id ORDER BY p.t_ns)
),
vehicle_on_its_way AS (
    SELECT a.drive_id, a.ego_id, a.t_ns, a.object_id, a.speed_mps, a.entry_s_m - e.front_s_m + a.way_m AS da_m
    FROM (
        SELECT *, from_picometres(sum(to_picometres(coalesce(step_m, 0.0))) OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY t_ns DESC ROWS UNBOUNDED PRECEDING)) AS way_m
        FROM approach_step
    ) a
    JOIN ego_step e USING (drive_id, ego_id, t_ns)
    WHERE NOT a.has_arrived AND a.x_m IS NOT NULL AND a.entry_s_m > e.front_s_m
)
SELECT drive_id, ego_id, t_ns, object_id, vehicle, da_m, speed_mps, false AS on_its_way FROM oncoming_object
UNION ALL
SELECT drive_id, ego_id, t_ns, object_id, true, da_m, speed_mps, true FROM vehicle_on_its_way
