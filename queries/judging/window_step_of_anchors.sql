-- The anchors of each reference; t_ns is NULL for one that is not known.
INSERT INTO _window_step BY NAME
WITH _anchor AS (
{anchor}
) SELECT $_no AS rule_no, p.*, s.seg
FROM (
    SELECT DISTINCT o.ref_id, o.ref_no, o.drive_id, o.ego_id, o.object_id, a.t_ns::BIGINT AS t_ns
    FROM _anchor a JOIN _occasion o ON a.ref_id = o.ref_id WHERE o.rule_no = $_no AND o.applies AND o.t_ref_ns IS NOT NULL) p
LEFT JOIN step s ON s.drive_id = p.drive_id AND s.ego_id = p.ego_id AND s.t_ns = p.t_ns
