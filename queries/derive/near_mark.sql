-- The ego's steps around the marks of its chains, with its bumpers before the step and at it. A step after a hole counts for all that lies
-- in between.
WITH moved AS (
    SELECT
        c.drive_id, c.ego_id, c.chain_id, c.t_ns, s.k, s.seg, c.front_s_m, c.rear_s_m, abs(c.d_m) - c.lat_half_m - c.half_width_m AS beside_m,
        lag({'k': s.k, 'seg': s.seg, 'front_s_m': c.front_s_m, 'rear_s_m': c.rear_s_m}) OVER (PARTITION BY c.drive_id, c.ego_id, c.chain_id ORDER BY c.t_ns) AS before
    FROM ego_corridor c
    JOIN step s USING (drive_id, ego_id, t_ns)
    SEMI JOIN way_mark m ON m.drive_id = c.drive_id AND m.ego_id = c.ego_id AND m.chain_id = c.chain_id
    WHERE c.front_s_m IS NOT NULL
)
SELECT
    w.drive_id, w.ego_id, w.chain_id, m.kind, m.mark_id, m.s_start_m, w.t_ns, w.k, w.seg,
    w.front_s_m - m.s_start_m AS front_m, w.rear_s_m - m.s_end_m AS rear_m,
    w.before.front_s_m - m.s_start_m AS front_before_m, w.before.rear_s_m - m.s_end_m AS rear_before_m,
    coalesce(w.before.k = w.k - 1 AND w.before.seg = w.seg, false) AS joined,
    -- beside it by more than a lane it is on another way
    e.chain_id IS NOT DISTINCT FROM w.chain_id AND w.beside_m < 4 AS running
FROM moved w
JOIN way_mark m ON m.drive_id = w.drive_id AND m.ego_id = w.ego_id AND m.chain_id = w.chain_id
    AND w.front_s_m >= m.s_start_m - near_mark_m() AND coalesce(least(w.before.rear_s_m, w.rear_s_m), w.rear_s_m) <= m.s_end_m + near_mark_m()
JOIN ego_state e ON e.drive_id = w.drive_id AND e.ego_id = w.ego_id AND e.t_ns = w.t_ns
