-- The boxes of the ego: its own and that of each trailer that it tows.
SELECT drive_id, ego_id, ego_id AS actor_id FROM clock
UNION ALL
SELECT drive_id, ego_id, object_id FROM ego_part WHERE part = 'trailer'
