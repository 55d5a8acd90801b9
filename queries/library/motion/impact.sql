-- The first impact of the ego and an object: one of the two loses or gains speed faster than tyres allow while their boxes nearly touch, as
-- in the rule contact-signature. The loss of speed in an impact and after it does not count as braking.
-- lifetime: part
CREATE TABLE impact (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    object_id VARCHAR NOT NULL,       -- another actor
    t_ns BIGINT NOT NULL              -- first step with an impact: the boxes are 0.5 m or less apart, and the object or the ego has lost or gained speed by 12 m/s2 or more since the step before. For an actor that may be on foot, only a loss counts. If the change began up to 0.5 s before, it is that earlier step
);

INSERT INTO impact BY NAME
WITH near_jolt AS (
    SELECT drive_id, ego_id, object_id, min(t_ns) AS t_ns
    FROM (FROM pair WHERE clearance_m <= impact_within_m()) p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    WHERE jolt_mps2(p.actor_class, p.accel_mps2, e.accel_mps2) >= tyre_mps2()
    GROUP BY ALL
)
-- Velocities that are computed from positions spread an impact over the steps around it.
SELECT n.drive_id, n.ego_id, n.object_id, min(p.t_ns) AS t_ns
FROM near_jolt n
JOIN pair p ON p.drive_id = n.drive_id AND p.ego_id = n.ego_id AND p.object_id = n.object_id AND p.t_ns <= n.t_ns AND p.t_ns >= n.t_ns - 500_000_000
JOIN ego_state e ON e.drive_id = p.drive_id AND e.ego_id = p.ego_id AND e.t_ns = p.t_ns
WHERE jolt_mps2(p.actor_class, p.accel_mps2, e.accel_mps2) >= tyre_mps2()
GROUP BY n.drive_id, n.ego_id, n.object_id
