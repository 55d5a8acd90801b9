-- A lower bound of the clearance, for the steps at which it is not known because the ego or the object has no position, heading or size.
-- The known clearances before and after the step decrease by at most the distance that the two actors can approach in the time between.
-- There is no bound for an actor whose track jumps to the position of another actor that it cannot have reached (quality jumps_onto): its
-- positions are not trusted.
-- lifetime: part
CREATE TABLE clearance_least (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- a step at which the clearance in pair is not known
    object_id VARCHAR NOT NULL,       -- the other actor
    least_m DOUBLE NOT NULL           -- lower bound of the clearance, positive: from the positions before and after the step {position, heading, size}
);

INSERT INTO clearance_least BY NAME
WITH doubtful_actor AS (
    SELECT DISTINCT drive_id, actor_id FROM quality WHERE check_id = 'jumps_onto'
),
unknown_clearance AS (
    SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id
    FROM pair p
    ANTI JOIN doubtful_actor o ON o.drive_id = p.drive_id AND o.actor_id = p.object_id
    ANTI JOIN doubtful_actor e ON e.drive_id = p.drive_id AND e.actor_id = p.ego_id
    WHERE p.clearance_m IS NULL
),
known_clearance AS (
    SELECT drive_id, ego_id, t_ns, object_id, clearance_m
    FROM pair p
    SEMI JOIN unknown_clearance l ON l.drive_id = p.drive_id AND l.ego_id = p.ego_id AND l.object_id = p.object_id
    WHERE clearance_m IS NOT NULL
)
SELECT
    l.*,
    -- greatest() ignores NULL, as it should here.
    greatest(b.clearance_m - unseen_closing_mps() * (l.t_ns - b.t_ns) / 1e9, a.clearance_m - unseen_closing_mps() * (a.t_ns - l.t_ns) / 1e9) AS least_m
FROM unknown_clearance l
ASOF LEFT JOIN known_clearance b ON b.drive_id = l.drive_id AND b.ego_id = l.ego_id AND b.object_id = l.object_id AND b.t_ns <= l.t_ns
ASOF LEFT JOIN known_clearance a ON a.drive_id = l.drive_id AND a.ego_id = l.ego_id AND a.object_id = l.object_id AND a.t_ns >= l.t_ns
WHERE least_m > 0
