-- The chain's segments in one station, with the lane beside them on the overtaking side.
WITH piece AS (
    SELECT
        c.drive_id, c.ego_id, c.chain_id, c.seq, g.k, c.lanelet_id, c.s_start_m + g.s0_m AS s0_m, g.len_m,
        g.x0_m, g.y0_m, g.tx0, g.ty0, g.hw0_m, g.x1_m, g.y1_m, g.tx1, g.ty1, g.hw1_m,
        n.junction_id,
        -- by the default alone the side is a guess, and rules that need it must not count on it
        CASE WHEN e.handedness_source <> 'default' THEN CASE e.handedness WHEN 'lht' THEN -1 ELSE 1 END END AS side,
        CASE e.handedness WHEN 'lht' THEN n.right_id ELSE n.left_id END AS beside_id,
        CASE e.handedness WHEN 'lht' THEN n.right_against ELSE n.left_against END AS beside_against,
        e.environment_id
    FROM chain c
    JOIN data_log l USING (drive_id)
    JOIN environment e USING (environment_id)
    JOIN lanelet n ON n.environment_id = e.environment_id AND n.lanelet_id = c.lanelet_id
    JOIN lane_segment g ON g.environment_id = e.environment_id AND g.lanelet_id = c.lanelet_id
),
beside AS (
    SELECT
        p.*,
        b.width_m AS width_m,
        CASE WHEN b.width_m IS NOT NULL THEN {'width_m': b.width_m, 'against': p.beside_against} END AS lane
    FROM piece p
    LEFT JOIN lanelet b ON b.environment_id = p.environment_id AND b.lanelet_id = p.beside_id AND b.drivable
),
carried AS (
    SELECT
        *,
        last_value(lane IGNORE NULLS) OVER (PARTITION BY drive_id, ego_id, chain_id ORDER BY seq, k ROWS UNBOUNDED PRECEDING) AS lane_before,
        first_value(lane IGNORE NULLS) OVER (PARTITION BY drive_id, ego_id, chain_id ORDER BY seq, k ROWS BETWEEN CURRENT ROW AND UNBOUNDED FOLLOWING) AS lane_after
    FROM beside
)
SELECT
    drive_id, ego_id, chain_id, seq, k, lanelet_id, s0_m, len_m, x0_m, y0_m, tx0, ty0, hw0_m, x1_m, y1_m, tx1, ty1, hw1_m, side,
    CASE WHEN junction_id IS NULL THEN lane.width_m ELSE coalesce(lane, lane_before, lane_after).width_m END AS over_width_m,
    CASE WHEN junction_id IS NULL THEN lane.against ELSE coalesce(lane, lane_before, lane_after).against END AS over_against
FROM carried
