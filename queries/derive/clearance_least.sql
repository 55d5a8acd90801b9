-- Steps at which the clearance of a pair is not known, for one of the two has no place, heading or size: no less than what is left of the
-- clearance seen before, and of the one seen after, once both have driven at each other for the time between. Nothing bounds an actor that the
-- log put upon another one, though its track contradicts that.
WITH doubted AS (
    SELECT DISTINCT drive_id, actor_id FROM quality WHERE check_id = 'jumps_onto'
),
lost AS (
    SELECT p.drive_id, p.ego_id, p.t_ns, p.object_id
    FROM pair p
    ANTI JOIN doubted o ON o.drive_id = p.drive_id AND o.actor_id = p.object_id
    ANTI JOIN doubted e ON e.drive_id = p.drive_id AND e.actor_id = p.ego_id
    WHERE p.clearance_m IS NULL
),
seen AS (
    SELECT drive_id, ego_id, t_ns, object_id, clearance_m
    FROM pair p
    SEMI JOIN lost l ON l.drive_id = p.drive_id AND l.ego_id = p.ego_id AND l.object_id = p.object_id
    WHERE clearance_m IS NOT NULL
)
SELECT
    l.*,
    -- greatest() leaves out what is not there, as it should here
    greatest(b.clearance_m - unseen_closing_mps() * (l.t_ns - b.t_ns) / 1e9, a.clearance_m - unseen_closing_mps() * (a.t_ns - l.t_ns) / 1e9) AS least_m
FROM lost l
ASOF LEFT JOIN seen b ON b.drive_id = l.drive_id AND b.ego_id = l.ego_id AND b.object_id = l.object_id AND b.t_ns <= l.t_ns
ASOF LEFT JOIN seen a ON a.drive_id = l.drive_id AND a.ego_id = l.ego_id AND a.object_id = l.object_id AND a.t_ns >= l.t_ns
WHERE least_m > 0
