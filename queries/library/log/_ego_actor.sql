-- The boxes of the ego: its own and that of each trailer that it tows.
-- lifetime: part
CREATE TABLE _ego_actor (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    actor_id VARCHAR NOT NULL         -- the ego, or a trailer that it tows: actors whose boxes belong to the ego at the same time
);

INSERT INTO _ego_actor BY NAME
SELECT drive_id, ego_id, ego_id AS actor_id FROM clock
UNION ALL
SELECT drive_id, ego_id, object_id FROM _ego_part WHERE part = 'trailer'
