-- The bounds of an actor's speed at the steps at which its recorded velocity is in doubt. A jolt changes the recorded velocity and changes
-- it back. The velocities before and after it are not in doubt, and tyres allow no greater change from them than tyre_mps2. Any other
-- doubt leaves the speed without bounds.
-- lifetime: part
CREATE TABLE velocity_bound (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR,                -- an actor whose recorded velocity is in doubt (doubt); NULL: the ego
    t_ns BIGINT NOT NULL,             -- the step
    least_mps DOUBLE,                 -- least speed that the actor can have there, by its velocities before and after the doubt; NULL: not known {velocity}
    most_mps DOUBLE                   -- greatest speed, likewise {velocity}
);

INSERT INTO velocity_bound BY NAME
WITH
doubted_step AS (
    SELECT st.drive_id, st.ego_id, d.actor_id, st.t_ns, bool_and(d.code IN ('common_jolt', 'velocity_jolt')) AS is_jolt
    FROM doubt d
    JOIN step st ON st.drive_id = d.drive_id AND st.t_ns BETWEEN d.t_from_ns AND d.t_to_ns
    WHERE d.quantity = 'velocity'
    GROUP BY ALL
),
credible_sample AS (
    SELECT s.drive_id, s.actor_id, s.t_ns, s.speed_mps
    FROM state_dynamics s
    SEMI JOIN doubted_step x ON x.drive_id = s.drive_id AND x.actor_id = s.actor_id
    ANTI JOIN (FROM doubt WHERE quantity = 'velocity') d ON d.drive_id = s.drive_id AND d.actor_id = s.actor_id AND s.t_ns BETWEEN d.t_from_ns AND d.t_to_ns
    WHERE s.speed_mps IS NOT NULL
)
SELECT
    x.drive_id, x.ego_id, nullif(x.actor_id, x.ego_id) AS object_id, x.t_ns,
    CASE WHEN x.is_jolt AND b.t_ns + a.t_ns IS NOT NULL THEN greatest(0.0, b.speed_mps - room.since_mps, a.speed_mps - room.until_mps) END AS least_mps,
    CASE WHEN x.is_jolt AND b.t_ns + a.t_ns IS NOT NULL THEN least(b.speed_mps + room.since_mps, a.speed_mps + room.until_mps) END AS most_mps
FROM doubted_step x
ASOF LEFT JOIN credible_sample b ON b.drive_id = x.drive_id AND b.actor_id = x.actor_id AND b.t_ns <= x.t_ns
ASOF LEFT JOIN credible_sample a ON a.drive_id = x.drive_id AND a.actor_id = x.actor_id AND a.t_ns >= x.t_ns
CROSS JOIN LATERAL (SELECT tyre_mps2() * (x.t_ns - b.t_ns) / 1e9 AS since_mps, tyre_mps2() * (a.t_ns - x.t_ns) / 1e9 AS until_mps) room
