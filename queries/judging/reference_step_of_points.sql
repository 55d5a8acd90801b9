-- The time of each reference itself.
INSERT INTO _reference_step BY NAME
SELECT $_no AS rule_no, p.*, s.seg
FROM (
    SELECT o.ref_id, o.ref_no, o.drive_id, o.ego_id, o.object_id, o.t_ref_ns AS t_ns
    FROM _occasion o WHERE o.rule_no = $_no AND o.applies AND o.t_ref_ns IS NOT NULL) p
LEFT JOIN step s ON s.drive_id = p.drive_id AND s.ego_id = p.ego_id AND s.t_ns = p.t_ns
