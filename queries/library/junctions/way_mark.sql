-- Junctions, stop lines and crossings ("marks") along the ego's chains, and the signals that govern each.
-- lifetime: part
CREATE TABLE way_mark (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- a running chain, see chain
    kind VARCHAR NOT NULL,            -- [mark_kind]
    mark_id VARCHAR NOT NULL,         -- id in the map; a traffic light without a stop line within 30 m counts as a stop line at its own position (inside a junction: at the junction's start), with the light's id
    lanelet_id VARCHAR NOT NULL,      -- the first lanelet of the chain on which the mark lies
    seq_first INTEGER NOT NULL,       -- seq of lanelet_id in the chain
    seq_last INTEGER NOT NULL,        -- seq of the last lanelet of the chain on which the mark lies
    s_start_m DOUBLE NOT NULL,        -- chain station of the mark's start
    s_end_m DOUBLE NOT NULL,          -- chain station of the mark's end
    control VARCHAR,                  -- [control] the first of these that governs the mark: of a junction, from 50 m before it to its connecting lanelets; of a stop line, within 30 m; of a crossing (lights only), from 15 m before to 30 m after it; never beyond another junction; NULL: none
    signal_id VARCHAR,                -- the signal of control. Of several, the first by: not for another turn, states recorded, for the ego's turn, nearest; NULL: none
    lights STRUCT(signal_id VARCHAR, fit VARCHAR)[] -- [fit: light_fit] for a traffic light, all its heads by id, and for which turn each is: own by its connecting lanelet or its arrow; maybe if the ego did not drive the whole turn, or if the turn has two possible names
);

INSERT INTO way_mark BY NAME
WITH chain_lanelet AS (
    SELECT c.drive_id, c.ego_id, c.chain_id, c.seq, c.lanelet_id, c.s_start_m, c.length_m, c.t_first_ns, g.environment_id, n.junction_id
    FROM chain c
    JOIN data_log g USING (drive_id)
    JOIN lanelet n USING (environment_id, lanelet_id)
),
-- ---- junctions: sequences of connecting lanelets
numbered_lanelet AS (
    SELECT
        *,
        sum((junction_id IS DISTINCT FROM previous_junction_id)::INTEGER) OVER (PARTITION BY drive_id, ego_id, chain_id ORDER BY seq) AS run_no
    FROM (SELECT *, lag(junction_id) OVER (PARTITION BY drive_id, ego_id, chain_id ORDER BY seq) AS previous_junction_id FROM chain_lanelet)
),
junction AS (
    SELECT
        drive_id, ego_id, chain_id, junction_id AS mark_id, min({'seq': seq, 'id': lanelet_id}).id AS lanelet_id, min(seq) AS seq_first, max(seq) AS seq_last,
        min(s_start_m) AS s_start_m, max(s_start_m + length_m) AS s_end_m
    FROM numbered_lanelet
    WHERE junction_id IS NOT NULL
    GROUP BY drive_id, ego_id, chain_id, run_no, junction_id
),
-- ---- the ego's turn in each junction: known if the ego drove all of it, or if there was no choice
way_out_count AS (
    SELECT l.environment_id, l.from_id, count(*) AS n
    FROM lane_link l
    JOIN lanelet n ON n.environment_id = l.environment_id AND n.lanelet_id = l.to_id AND n.drivable
    GROUP BY l.environment_id, l.from_id
),
lanelet_heading AS (
    SELECT environment_id, lanelet_id, min({'k': k, 'a': atan2(ty, tx)}).a AS first_rad, max({'k': k, 'a': atan2(ty, tx)}).a AS last_rad
    FROM lane_point
    GROUP BY environment_id, lanelet_id
),
junction_turn AS (
    SELECT
        n.drive_id, n.ego_id, n.chain_id, n.run_no, n.environment_id, n.junction_id, min(n.s_start_m) AS s_start_m, max(n.s_start_m + n.length_m) AS s_end_m,
        min({'seq': n.seq, 'id': b.lanelet_id}).id AS from_id, bool_and(n.t_first_ns IS NOT NULL OR c.n = 1) AS is_known,
        wrap_rad(max({'seq': n.seq, 'a': coalesce(ea.first_rad, e.last_rad)}).a - min({'seq': n.seq, 'a': coalesce(eb.last_rad, e.first_rad)}).a) AS turn_rad
    FROM numbered_lanelet n
    JOIN lanelet_heading e USING (environment_id, lanelet_id)
    LEFT JOIN chain_lanelet b ON b.drive_id = n.drive_id AND b.ego_id = n.ego_id AND b.chain_id = n.chain_id AND b.seq = n.seq - 1
    LEFT JOIN chain_lanelet a ON a.drive_id = n.drive_id AND a.ego_id = n.ego_id AND a.chain_id = n.chain_id AND a.seq = n.seq + 1
    LEFT JOIN way_out_count c ON c.environment_id = n.environment_id AND c.from_id = b.lanelet_id
    LEFT JOIN lanelet_heading eb ON eb.environment_id = n.environment_id AND eb.lanelet_id = b.lanelet_id
    LEFT JOIN lanelet_heading ea ON ea.environment_id = n.environment_id AND ea.lanelet_id = a.lanelet_id
    WHERE n.junction_id IS NOT NULL
    GROUP BY n.drive_id, n.ego_id, n.chain_id, n.run_no, n.environment_id, n.junction_id
),
-- ---- signals: a signal inside a junction governs the entry into it
signal_on_chain AS (
    SELECT
        l.drive_id, l.ego_id, l.chain_id, l.environment_id, l.seq, l.lanelet_id, t.signal_id, t.kind, t.turns, j.s_start_m IS NOT NULL AS is_inside,
        j.is_known AS is_turn_known, coalesce(j.s_start_m, l.s_start_m + t.lane_s_m) AS s_m
    FROM numbered_lanelet l
    JOIN traffic_signal t ON t.environment_id = l.environment_id AND t.lanelet_id = l.lanelet_id AND t.kind IN ('traffic_light', 'stop', 'give_way')
    LEFT JOIN junction_turn j ON j.drive_id = l.drive_id AND j.ego_id = l.ego_id AND j.chain_id = l.chain_id AND j.run_no = l.run_no
    UNION ALL
    -- The ego may have turned off by another connecting lanelet, which has its own lights.
    SELECT b.drive_id, b.ego_id, b.chain_id, b.environment_id, b.seq, b.lanelet_id, t.signal_id, t.kind, t.turns, true, false, j.s_start_m
    FROM junction_turn j
    JOIN chain_lanelet b ON b.drive_id = j.drive_id AND b.ego_id = j.ego_id AND b.chain_id = j.chain_id AND b.lanelet_id = j.from_id AND b.s_start_m < j.s_start_m
    JOIN lane_link k ON k.environment_id = j.environment_id AND k.from_id = j.from_id
    JOIN lanelet n ON n.environment_id = k.environment_id AND n.lanelet_id = k.to_id AND n.junction_id = j.junction_id
    JOIN traffic_signal t ON t.environment_id = n.environment_id AND t.lanelet_id = n.lanelet_id AND t.kind = 'traffic_light'
    WHERE NOT j.is_known
),
-- The next junction ahead decides which of the arrows the ego needs.
signal_with_turns AS (
    SELECT h.*, CASE WHEN j.is_known AND j.s_start_m - h.s_m <= turn_reach_m() THEN possible_turns(j.turn_rad) END AS ego_turns
    FROM signal_on_chain h
    ASOF LEFT JOIN junction_turn j ON j.drive_id = h.drive_id AND j.ego_id = h.ego_id AND j.chain_id = h.chain_id AND j.s_start_m >= h.s_m
),
signal AS (
    SELECT
        h.drive_id, h.ego_id, h.chain_id, h.signal_id, h.kind, h.lanelet_id, h.seq, h.s_m, CASE h.kind WHEN 'traffic_light' THEN 0 WHEN 'stop' THEN 1 ELSE 2 END AS rank,
        CASE
            WHEN h.is_inside THEN CASE WHEN h.is_turn_known THEN 1 ELSE 2 END
            WHEN h.turns IS NULL THEN 4
            WHEN len(h.turns) = 4 THEN 3
            WHEN list_has_all(h.turns, h.ego_turns) THEN 1
            WHEN NOT list_has_any(h.turns, h.ego_turns) THEN 5
            ELSE 2
        END AS fit,
        CASE WHEN r.signal_id IS NULL THEN 1 ELSE 0 END AS is_unrecorded
    FROM signal_with_turns h
    LEFT JOIN (SELECT DISTINCT drive_id, signal_id FROM signal_state) r ON r.drive_id = h.drive_id AND r.signal_id = h.signal_id
),
-- ---- lines and crossings: one at the joint of two lanelets counts once
line_part AS (
    SELECT l.drive_id, l.ego_id, l.chain_id, s.stop_line_id AS mark_id, l.lanelet_id, l.seq, l.s_start_m + s.lane_s_m AS s_start_m, l.s_start_m + s.lane_s_m AS s_end_m
    FROM chain_lanelet l JOIN stop_line s USING (environment_id, lanelet_id)
),
-- A light without a stop line is itself the place to stop.
light_without_line AS (
    SELECT
        drive_id, ego_id, chain_id, unnest(min({'is_unrecorded': is_unrecorded, 's_start_m': s_m, 'mark_id': signal_id, 'lanelet_id': lanelet_id, 'seq': seq, 's_end_m': s_m}))
    FROM (
        SELECT *, sum((s_m - previous_s_m > line_reach_m())::INTEGER) OVER (PARTITION BY drive_id, ego_id, chain_id ORDER BY s_m) AS n
        FROM (
            SELECT t.*, lag(t.s_m, 1, t.s_m) OVER (PARTITION BY t.drive_id, t.ego_id, t.chain_id ORDER BY t.s_m) AS previous_s_m
            FROM signal t
            ANTI JOIN line_part p ON p.drive_id = t.drive_id AND p.ego_id = t.ego_id AND p.chain_id = t.chain_id
                AND p.s_start_m > t.s_m - line_reach_m() AND p.s_start_m < t.s_m + line_reach_m()
            WHERE t.kind = 'traffic_light'
        )
    )
    GROUP BY drive_id, ego_id, chain_id, n
),
mark_part AS (
    SELECT 'stop_line' AS kind, * FROM line_part
    UNION ALL
    SELECT 'stop_line' AS kind, drive_id, ego_id, chain_id, mark_id, lanelet_id, seq, s_start_m, s_end_m FROM light_without_line
    UNION ALL
    SELECT 'crossing' AS kind, l.drive_id, l.ego_id, l.chain_id, x.crossing_id, l.lanelet_id, l.seq, l.s_start_m + x.s_start_m, l.s_start_m + x.s_end_m
    FROM chain_lanelet l JOIN crossing x USING (environment_id, lanelet_id)
),
-- occasion: mark_part, junction
numbered_part AS (
    SELECT
        *,
        sum((s_start_m - end_before_m > 2)::INTEGER) OVER (PARTITION BY drive_id, ego_id, chain_id, kind, mark_id ORDER BY s_start_m, s_end_m, lanelet_id) AS n
    FROM (
        SELECT
            *,
            coalesce(max(s_end_m) OVER (
                PARTITION BY drive_id, ego_id, chain_id, kind, mark_id ORDER BY s_start_m, s_end_m, lanelet_id ROWS BETWEEN UNBOUNDED PRECEDING AND 1 PRECEDING
            ), s_start_m) AS end_before_m
        FROM mark_part
    )
),
mark AS (
    SELECT
        kind, drive_id, ego_id, chain_id, mark_id, min({'s_m': s_start_m, 'id': lanelet_id}).id AS lanelet_id, min(seq) AS seq_first, max(seq) AS seq_last,
        min(s_start_m) AS s_start_m, max(s_end_m) AS s_end_m
    FROM numbered_part
    GROUP BY kind, drive_id, ego_id, chain_id, mark_id, n
    UNION ALL
    SELECT 'junction', drive_id, ego_id, chain_id, mark_id, lanelet_id, seq_first, seq_last, s_start_m, s_end_m FROM junction
),
-- ---- the signals that govern each mark
signal_in_reach AS (
    SELECT m.kind, m.drive_id, m.ego_id, m.chain_id, m.mark_id, m.s_start_m, m.s_end_m, t.signal_id, t.kind AS control, t.s_m, t.rank, t.fit, t.is_unrecorded
    FROM mark m
    JOIN signal t ON t.drive_id = m.drive_id AND t.ego_id = m.ego_id AND t.chain_id = m.chain_id
    WHERE CASE m.kind
            WHEN 'junction' THEN t.s_m >= m.s_start_m - governed_m() AND t.s_m <= m.s_start_m + 1
            WHEN 'stop_line' THEN t.s_m > m.s_start_m - line_reach_m() AND t.s_m < m.s_start_m + line_reach_m()
            ELSE t.kind = 'traffic_light' AND t.s_m >= m.s_start_m - 15 AND t.s_m <= m.s_end_m + line_reach_m()
        END
),
-- A signal before the entry into another junction, or beyond the exit of this one, belongs to another mark.
own_signal AS (
    SELECT r.*
    FROM signal_in_reach r
    ANTI JOIN junction j
        ON j.drive_id = r.drive_id AND j.ego_id = r.ego_id AND j.chain_id = r.chain_id
        AND j.s_start_m >= least(r.s_m, r.s_start_m) AND j.s_start_m < greatest(r.s_m, r.s_start_m) - 5
    ANTI JOIN junction o
        ON o.drive_id = r.drive_id AND o.ego_id = r.ego_id AND o.chain_id = r.chain_id AND o.s_end_m > r.s_start_m + 1 AND o.s_end_m <= r.s_m
),
-- A light belongs to the nearest stop line, and not to a crossing if that line lies beyond the crossing.
nearest_line AS (
    SELECT s.drive_id, s.ego_id, s.chain_id, s.signal_id, s.s_m, min({'off_m': abs(m.s_start_m - s.s_m), 's_m': m.s_start_m}).s_m AS line_s_m
    FROM signal s
    JOIN mark m ON m.drive_id = s.drive_id AND m.ego_id = s.ego_id AND m.chain_id = s.chain_id AND m.kind = 'stop_line'
    GROUP BY s.drive_id, s.ego_id, s.chain_id, s.signal_id, s.s_m
),
signal_with_nearest_line AS (
    SELECT o.*, CASE o.kind WHEN 'stop_line' THEN n.line_s_m <> o.s_start_m WHEN 'crossing' THEN coalesce(n.line_s_m > o.s_end_m, false) ELSE false END AS is_elsewhere
    FROM own_signal o
    LEFT JOIN nearest_line n USING (drive_id, ego_id, chain_id, signal_id, s_m)
),
signal_head AS (
    SELECT
        kind, drive_id, ego_id, chain_id, mark_id, s_start_m, control, rank, signal_id, min(fit) AS fit, any_value(is_unrecorded) AS is_unrecorded, min(abs(s_m - s_start_m)) AS off_m
    FROM (
        FROM signal_with_nearest_line
        QUALIFY {'rank': rank, 'is_elsewhere': is_elsewhere} = min({'rank': rank, 'is_elsewhere': is_elsewhere})
            OVER (PARTITION BY kind, drive_id, ego_id, chain_id, mark_id, s_start_m)
    )
    GROUP BY kind, drive_id, ego_id, chain_id, mark_id, s_start_m, control, rank, signal_id
),
mark_control AS (
    SELECT
        kind, drive_id, ego_id, chain_id, mark_id, s_start_m, any_value(control) AS control,
        min({'is_for_other_turn': fit = 5, 'is_unrecorded': is_unrecorded, 'fit': CASE is_unrecorded WHEN 0 THEN fit END, 'off_m': off_m, 'id': signal_id}).id AS signal_id,
        list({'signal_id': signal_id, 'fit': ['own', 'maybe', 'full', 'unsaid', 'other'][fit]} ORDER BY signal_id) FILTER (control = 'traffic_light') AS lights
    FROM signal_head
    GROUP BY kind, drive_id, ego_id, chain_id, mark_id, s_start_m
)
SELECT
    m.drive_id, m.ego_id, m.chain_id, m.kind, m.mark_id, m.lanelet_id, m.seq_first, m.seq_last, m.s_start_m, m.s_end_m, g.control, g.signal_id, g.lights
FROM mark m
LEFT JOIN mark_control g ON g.kind = m.kind AND g.drive_id = m.drive_id AND g.ego_id = m.ego_id AND g.chain_id = m.chain_id
    AND g.mark_id = m.mark_id AND g.s_start_m = m.s_start_m
