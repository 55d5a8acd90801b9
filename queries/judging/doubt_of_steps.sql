-- A step at which the ego or the object is in doubt is not judged, if the rule uses the quantity that is doubted.
UPDATE _judged SET holds = NULL, code = 'doubted', reason = d.why
FROM (
    SELECT j.rule_no, j.drive_id, j.ego_id, j.t_ns, j.object_id, min(why('doubted', {'object_id': nullif(x.actor_id, j.ego_id), 'whose': CASE WHEN x.actor_id = j.ego_id THEN 'the ego' END, 'quantity': x.doubt.quantity, 'check_id': x.doubt.code})) AS why
    FROM (SELECT DISTINCT rule_no, drive_id, ego_id, t_ns, object_id, coalesce(nullif(who, ''), object_id) AS who FROM _judged WHERE holds IS NOT NULL) j
    JOIN _doubted x ON x.rule_no = j.rule_no AND x.drive_id = j.drive_id AND x.ego_id = j.ego_id AND x.t_ns = j.t_ns AND (x.actor_id = j.ego_id OR x.actor_id = j.who)
    GROUP BY ALL
) d
WHERE _judged.holds IS NOT NULL AND _judged.rule_no = d.rule_no AND _judged.drive_id = d.drive_id AND _judged.ego_id = d.ego_id AND _judged.t_ns = d.t_ns
    AND _judged.object_id = d.object_id
