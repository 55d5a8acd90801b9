-- Junctions, stop lines and crossings along the ego's chains, and what governs each.
WITH lane AS (
    SELECT c.drive_id, c.ego_id, c.chain_id, c.seq, c.lanelet_id, c.s_start_m, c.length_m, g.environment_id, n.junction_id
    FROM chain c
    JOIN data_log g USING (drive_id)
    JOIN lanelet n USING (environment_id, lanelet_id)
),
-- ---- junctions: connecting lanelets one after the other
numbered AS (
    SELECT
        *,
        sum((junction_id IS DISTINCT FROM before_id)::INTEGER) OVER (PARTITION BY drive_id, ego_id, chain_id ORDER BY seq) AS run
    FROM (SELECT *, lag(junction_id) OVER (PARTITION BY drive_id, ego_id, chain_id ORDER BY seq) AS before_id FROM lane)
),
junction AS (
    SELECT
        drive_id, ego_id, chain_id, junction_id AS mark_id, min({'seq': seq, 'id': lanelet_id}).id AS lanelet_id, min(seq) AS seq_first, max(seq) AS seq_last,
        min(s_start_m) AS s_start_m, max(s_start_m + length_m) AS s_end_m
    FROM numbered
    WHERE junction_id IS NOT NULL
    GROUP BY drive_id, ego_id, chain_id, run, junction_id
),
-- ---- signals: one inside a junction holds for the way into it
signal AS (
    SELECT
        l.drive_id, l.ego_id, l.chain_id, t.signal_id, t.kind, l.lanelet_id, l.seq,
        coalesce(j.s_start_m, l.s_start_m + t.lane_s_m) AS s_m,
        CASE t.kind WHEN 'traffic_light' THEN 0 WHEN 'stop' THEN 1 ELSE 2 END AS rank,
        -- of several lights the one whose states were recorded
        CASE WHEN r.signal_id IS NULL THEN 1 ELSE 0 END AS silent
    FROM lane l
    JOIN traffic_signal t ON t.environment_id = l.environment_id AND t.lanelet_id = l.lanelet_id AND t.kind IN ('traffic_light', 'stop', 'give_way')
    LEFT JOIN (SELECT DISTINCT drive_id, signal_id FROM signal_state) r ON r.drive_id = l.drive_id AND r.signal_id = t.signal_id
    LEFT JOIN (
        SELECT n.drive_id, n.ego_id, n.chain_id, n.seq, min(n.s_start_m) OVER (PARTITION BY n.drive_id, n.ego_id, n.chain_id, n.run) AS s_start_m
        FROM numbered n
        WHERE n.junction_id IS NOT NULL
    ) j ON j.drive_id = l.drive_id AND j.ego_id = l.ego_id AND j.chain_id = l.chain_id AND j.seq = l.seq
),
-- ---- lines and crossings: one that lies over the seam of two lanelets is one
line_part AS (
    SELECT l.drive_id, l.ego_id, l.chain_id, s.stop_line_id AS mark_id, l.lanelet_id, l.seq, l.s_start_m + s.lane_s_m AS s_start_m, l.s_start_m + s.lane_s_m AS s_end_m
    FROM lane l JOIN stop_line s USING (environment_id, lanelet_id)
),
-- a light without a line is one to stop at itself
unlined AS (
    SELECT
        drive_id, ego_id, chain_id, unnest(min({'silent': silent, 's_start_m': s_m, 'mark_id': signal_id, 'lanelet_id': lanelet_id, 'seq': seq, 's_end_m': s_m}))
    FROM (
        SELECT *, sum((s_m - before_m > line_reach_m())::INTEGER) OVER (PARTITION BY drive_id, ego_id, chain_id ORDER BY s_m) AS n
        FROM (
            SELECT t.*, lag(t.s_m, 1, t.s_m) OVER (PARTITION BY t.drive_id, t.ego_id, t.chain_id ORDER BY t.s_m) AS before_m
            FROM signal t
            ANTI JOIN line_part p ON p.drive_id = t.drive_id AND p.ego_id = t.ego_id AND p.chain_id = t.chain_id
                AND p.s_start_m > t.s_m - line_reach_m() AND p.s_start_m < t.s_m + line_reach_m()
            WHERE t.kind = 'traffic_light'
        )
    )
    GROUP BY drive_id, ego_id, chain_id, n
),
part AS (
    SELECT 'stop_line' AS kind, * FROM line_part
    UNION ALL
    SELECT 'stop_line' AS kind, drive_id, ego_id, chain_id, mark_id, lanelet_id, seq, s_start_m, s_end_m FROM unlined
    UNION ALL
    SELECT 'crossing' AS kind, l.drive_id, l.ego_id, l.chain_id, x.crossing_id, l.lanelet_id, l.seq, l.s_start_m + x.s_start_m, l.s_start_m + x.s_end_m
    FROM lane l JOIN crossing x USING (environment_id, lanelet_id)
),
joined AS (
    SELECT
        *,
        sum((s_start_m - end_before_m > 2)::INTEGER) OVER (PARTITION BY drive_id, ego_id, chain_id, kind, mark_id ORDER BY s_start_m, s_end_m, lanelet_id) AS n
    FROM (
        SELECT
            *,
            coalesce(max(s_end_m) OVER (
                PARTITION BY drive_id, ego_id, chain_id, kind, mark_id ORDER BY s_start_m, s_end_m, lanelet_id ROWS BETWEEN UNBOUNDED PRECEDING AND 1 PRECEDING
            ), s_start_m) AS end_before_m
        FROM part
    )
),
mark AS (
    SELECT
        kind, drive_id, ego_id, chain_id, mark_id, min({'s_m': s_start_m, 'id': lanelet_id}).id AS lanelet_id, min(seq) AS seq_first, max(seq) AS seq_last,
        min(s_start_m) AS s_start_m, max(s_end_m) AS s_end_m
    FROM joined
    GROUP BY kind, drive_id, ego_id, chain_id, mark_id, n
    UNION ALL
    SELECT 'junction', drive_id, ego_id, chain_id, mark_id, lanelet_id, seq_first, seq_last, s_start_m, s_end_m FROM junction
),
-- ---- which signal governs it
reached AS (
    SELECT m.kind, m.drive_id, m.ego_id, m.chain_id, m.mark_id, m.s_start_m, t.signal_id, t.kind AS control, t.s_m, t.rank, t.silent
    FROM mark m
    JOIN signal t ON t.drive_id = m.drive_id AND t.ego_id = m.ego_id AND t.chain_id = m.chain_id
    WHERE CASE m.kind
            WHEN 'junction' THEN t.s_m >= m.s_start_m - 50 AND t.s_m <= m.s_start_m + 1
            WHEN 'stop_line' THEN t.s_m > m.s_start_m - line_reach_m() AND t.s_m < m.s_start_m + line_reach_m()
            ELSE t.kind = 'traffic_light' AND t.s_m >= m.s_start_m - 15 AND t.s_m <= m.s_end_m + line_reach_m()
        END
),
-- what stands before the way into another junction, or past the way out of this one, is another's
own AS (
    SELECT r.*
    FROM reached r
    ANTI JOIN junction j
        ON j.drive_id = r.drive_id AND j.ego_id = r.ego_id AND j.chain_id = r.chain_id
        AND j.s_start_m >= least(r.s_m, r.s_start_m) AND j.s_start_m < greatest(r.s_m, r.s_start_m) - 5
    ANTI JOIN junction o
        ON o.drive_id = r.drive_id AND o.ego_id = r.ego_id AND o.chain_id = r.chain_id AND o.s_end_m > r.s_start_m + 1 AND o.s_end_m <= r.s_m
),
governed AS (
    SELECT
        kind, drive_id, ego_id, chain_id, mark_id, s_start_m,
        min({'rank': rank, 'silent': silent, 'off_m': abs(s_m - s_start_m), 'signal_id': signal_id, 'control': control}) AS by
    FROM own
    GROUP BY kind, drive_id, ego_id, chain_id, mark_id, s_start_m
)
SELECT
    m.drive_id, m.ego_id, m.chain_id, m.kind, m.mark_id, m.lanelet_id, m.seq_first, m.seq_last, m.s_start_m, m.s_end_m, g.by.control AS control, g.by.signal_id AS signal_id
FROM mark m
LEFT JOIN governed g ON g.kind = m.kind AND g.drive_id = m.drive_id AND g.ego_id = m.ego_id AND g.chain_id = m.chain_id
    AND g.mark_id = m.mark_id AND g.s_start_m = m.s_start_m
