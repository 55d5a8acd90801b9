-- A group with a step in doubt is not settled by the first pass.
UPDATE _group SET clean = false
FROM (SELECT DISTINCT drive_id, ego_id, actor_id FROM _doubted WHERE rule_no = $_no) d
WHERE _group.rule_no = $_no AND _group.clean AND _group.drive_id = d.drive_id AND _group.ego_id = d.ego_id
    AND (d.actor_id = _group.ego_id OR d.actor_id = _group.object_id)
