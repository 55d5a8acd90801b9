-- The steps of the window of each reference.
INSERT INTO _window_step BY NAME
-- time buckets as long as the window turn the range join into an equi-join: a window touches two of them
WITH _bucket AS (
    SELECT *, unnest([a_ns // greatest($_window_ns, 1), a_ns // greatest($_window_ns, 1) + 1]) AS bucket
        FROM _occasion o WHERE o.rule_no = $_no AND o.applies AND o.t_ref_ns IS NOT NULL)
SELECT $_no AS rule_no, o.ref_id, o.ref_no, o.drive_id, o.ego_id, o.object_id, s.t_ns, s.seg FROM _bucket o
JOIN step s ON s.drive_id = o.drive_id AND s.ego_id = o.ego_id AND s.t_ns // greatest($_window_ns, 1) = o.bucket
    AND s.t_ns >= o.a_ns AND s.t_ns <= o.b_ns
