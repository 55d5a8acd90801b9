-- Each reference point with its window, and whether the rule applies there.
INSERT INTO _occasion BY NAME
SELECT $_no AS rule_no, r.ref_id, r.ref_id - min(r.ref_id) OVER (PARTITION BY r.drive_id, r.ego_id) AS ref_no,
    r.drive_id::VARCHAR AS drive_id, r.ego_id::VARCHAR AS ego_id, {own_object}::VARCHAR AS object_id, r.t_ns::BIGINT AS t_ref_ns,
    ({start})::BIGINT AS a_ns, ({end})::BIGINT AS b_ns, {in_force} AS applies, {doubt} AS doubt, {crowd} AS crowd, {at_point} AS at_point
FROM reference r
{condition_joins}
