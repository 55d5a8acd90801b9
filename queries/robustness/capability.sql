-- A copy can decide what its drive can: a part of a drive is too short to show how well it fits its map.
INSERT INTO capability BY NAME
SELECT k.* REPLACE (c.copy_id AS drive_id) FROM capability k JOIN _copy c ON k.drive_id = c.drive_id AND k.ego_id = c.ego_id
