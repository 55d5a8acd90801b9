-- The ego's passages through junctions: stretches of steps on connecting lanelets, with the stations of the ego's bumpers on its chain.
-- lifetime: part
CREATE TABLE junction_passage (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the passage, from 0, in time order: the ego drives through a junction, which it enters by a lane that ends there
    junction_id VARCHAR NOT NULL,     -- the junction
    t_in_ns BIGINT,                   -- first step with the ego's front bumper in the junction; NULL: the log or a part after a hole begins inside {position}
    t_out_ns BIGINT,                  -- first step with the ego's rear bumper, or that of its trailer, past the junction; NULL: the log or the part before a hole ends inside, or the trailer is not seen then {position}
    t_first_ns BIGINT NOT NULL,       -- first step with the ego's centre on a connecting lanelet {position}
    t_last_ns BIGINT NOT NULL,        -- last step with the ego's centre on a connecting lanelet {position}
    from_lanelet_id VARCHAR,          -- the lanelet before the junction
    via_lanelet_id VARCHAR NOT NULL,  -- the (first) connecting lanelet
    to_lanelet_id VARCHAR,            -- the lanelet after the junction
    turn VARCHAR,                     -- [turn] by the change of heading from from_lanelet_id to to_lanelet_id (straight within 30 degrees, u_turn beyond 150); NULL: not seen from the entry of the ego's front until its centre was on the lane after the junction {position}
    turn_rad DOUBLE,                  -- this change of heading, left positive {heading}
    straightest_rad DOUBLE,           -- change of heading to the straightest of all ways out of the junction from the ego's road, left positive; NULL: that road is not known {heading}
    across BOOLEAN,                   -- the turn crosses the oncoming traffic (a right turn in left-hand traffic; any u_turn); NULL: handedness or turn not known {position, heading, velocity}
    branches INTEGER NOT NULL,        -- number of roads that meet in the junction; with 2, it is no junction for a driver
    control VARCHAR,                  -- [control + none] the sign or light that governs the ego's entry, see way_mark; NULL: not known, because the map has no such signals at all or begins less than 50 m before the junction
    minor BOOLEAN                     -- the ego must give way: control is stop or give_way; NULL: control not known {position}
);

INSERT INTO junction_passage BY NAME
WITH lane_step AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, st.seg, g.environment_id, e.lanelet_id, n.junction_id
    FROM ego_lane e
    JOIN step st USING (drive_id, ego_id, t_ns)
    JOIN data_log g USING (drive_id)
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = e.lanelet_id
),
passage AS (
    SELECT
        drive_id, ego_id, environment_id, seg, junction_id, run_no, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns,
        min({'t_ns': t_ns, 'id': lanelet_id}).id AS via_id
    FROM (
        SELECT
            *,
            sum((junction_id IS DISTINCT FROM junction_before OR seg IS DISTINCT FROM seg_before)::INTEGER)
                OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS run_no
        FROM (
            SELECT *, lag(junction_id) OVER w AS junction_before, lag(seg) OVER w AS seg_before
            FROM lane_step
            WINDOW w AS (PARTITION BY drive_id, ego_id ORDER BY t_ns)
        )
    )
    WHERE junction_id IS NOT NULL
    GROUP BY drive_id, ego_id, environment_id, seg, junction_id, run_no
),
-- occasion: passage
-- If the ego cut the corner of a junction, it drove beside a lanelet of its chain. The times for that lanelet are then between those of the
-- lanelet before and the one after.
chain_lanelet AS (
    SELECT
        drive_id, ego_id, chain_id, seq, coalesce(t_first_ns, lag(t_last_ns IGNORE NULLS) OVER w) AS t_first_ns, coalesce(t_last_ns, lead(t_first_ns IGNORE NULLS) OVER w) AS t_last_ns
    FROM chain
    WINDOW w AS (PARTITION BY drive_id, ego_id, chain_id ORDER BY seq)
),
-- The start of the junction on the chain on which the ego entered, and its end on the chain on which the ego left. One chain may end inside
-- the junction and the next one begin there.
passage_chain AS (
    SELECT
        i.drive_id, i.ego_id, i.t_first_ns,
        min({'t_ns': c.t_first_ns, 'chain_id': m.chain_id, 's_m': m.s_start_m, 'seq': m.seq_first, 'control': m.control}) AS entry_mark,
        max({'t_ns': c.t_first_ns, 'chain_id': m.chain_id, 's_m': m.s_start_m, 'seq': m.seq_last}) AS exit_mark
    FROM passage i
    JOIN chain_lanelet c ON c.drive_id = i.drive_id AND c.ego_id = i.ego_id AND c.t_first_ns <= i.t_last_ns AND c.t_last_ns >= i.t_first_ns
    JOIN way_mark m ON m.drive_id = c.drive_id AND m.ego_id = c.ego_id AND m.chain_id = c.chain_id AND m.kind = 'junction'
        AND m.mark_id = i.junction_id AND c.seq >= m.seq_first AND c.seq <= m.seq_last
    GROUP BY i.drive_id, i.ego_id, i.t_first_ns
),
entry_time AS (
    SELECT i.drive_id, i.ego_id, i.t_first_ns, max(n.t_ns) AS t_in_ns
    FROM passage i
    JOIN passage_chain w USING (drive_id, ego_id, t_first_ns)
    JOIN _near_mark n ON n.drive_id = i.drive_id AND n.ego_id = i.ego_id AND n.chain_id = w.entry_mark.chain_id AND n.kind = 'junction'
        AND n.mark_id = i.junction_id AND n.s_start_m = w.entry_mark.s_m AND n.seg = i.seg AND n.t_ns <= i.t_first_ns
    WHERE n.front_m >= 0 AND n.front_before_m < 0 AND n.joined
    GROUP BY i.drive_id, i.ego_id, i.t_first_ns
),
exit_time AS (
    SELECT i.drive_id, i.ego_id, i.t_first_ns, min(n.t_ns) AS t_out_ns
    FROM passage i
    JOIN passage_chain w USING (drive_id, ego_id, t_first_ns)
    JOIN _near_mark n ON n.drive_id = i.drive_id AND n.ego_id = i.ego_id AND n.chain_id = w.exit_mark.chain_id AND n.kind = 'junction'
        AND n.mark_id = i.junction_id AND n.s_start_m = w.exit_mark.s_m AND n.seg = i.seg AND n.t_ns >= i.t_last_ns
    WHERE n.rear_m >= 0 AND n.rear_before_m < 0 AND n.joined
    GROUP BY i.drive_id, i.ego_id, i.t_first_ns
),
-- Headings at the start and end of a lanelet, for the ego's entry and exit.
lanelet_heading AS (
    SELECT environment_id, lanelet_id, min({'k': k, 'a': atan2(ty, tx)}).a AS first_rad, max({'k': k, 'a': atan2(ty, tx)}).a AS last_rad
    FROM lane_point
    GROUP BY environment_id, lanelet_id
),
-- The way out with the least turn, of all ways out of the ego's road. A connecting road may consist of several consecutive lanelets: each
-- is searched for a link out of the junction.
straightest_exit AS (
    SELECT environment_id, junction_id, road_id, along_road, min({'off_rad': abs(turn_rad), 'turn_rad': turn_rad}).turn_rad AS turn_rad
    FROM (
        SELECT j.environment_id, j.junction_id, f.road_id, f.along_road, wrap_rad(eo.first_rad - ef.last_rad) AS turn_rad
        FROM lanelet j
        JOIN lane_link i ON i.environment_id = j.environment_id AND i.to_id = j.lanelet_id
        JOIN lanelet f ON f.environment_id = j.environment_id AND f.lanelet_id = i.from_id
        JOIN lanelet k ON k.environment_id = j.environment_id AND k.junction_id = j.junction_id AND k.road_id = j.road_id AND k.along_road = j.along_road
        JOIN lane_link l ON l.environment_id = j.environment_id AND l.from_id = k.lanelet_id
        JOIN lanelet o ON o.environment_id = j.environment_id AND o.lanelet_id = l.to_id
        JOIN lanelet_heading ef ON ef.environment_id = j.environment_id AND ef.lanelet_id = f.lanelet_id
        JOIN lanelet_heading eo ON eo.environment_id = j.environment_id AND eo.lanelet_id = o.lanelet_id
        WHERE j.junction_id IS NOT NULL AND j.drivable AND k.drivable AND f.drivable AND o.drivable
            AND f.junction_id IS DISTINCT FROM j.junction_id AND o.junction_id IS DISTINCT FROM j.junction_id
    )
    GROUP BY environment_id, junction_id, road_id, along_road
),
-- If both ends of a road lead to the same junction, they are two branches.
branch_count AS (
    SELECT environment_id, junction_id, count(DISTINCT {'road': coalesce(h.of_road_id, r.road_id), 'by_road_end': r.by_road_end <> coalesce(h.turned, false)}) AS n
    FROM (
        SELECT j.environment_id, j.junction_id, o.road_id, o.along_road = -1 AS by_road_end
        FROM lanelet j
        JOIN lane_link l ON l.environment_id = j.environment_id AND l.from_id = j.lanelet_id
        JOIN lanelet o ON o.environment_id = j.environment_id AND o.lanelet_id = l.to_id
        WHERE j.junction_id IS NOT NULL AND j.drivable AND o.drivable AND o.junction_id IS DISTINCT FROM j.junction_id
        UNION
        SELECT j.environment_id, j.junction_id, o.road_id, o.along_road = 1
        FROM lanelet j
        JOIN lane_link l ON l.environment_id = j.environment_id AND l.to_id = j.lanelet_id
        JOIN lanelet o ON o.environment_id = j.environment_id AND o.lanelet_id = l.from_id
        WHERE j.junction_id IS NOT NULL AND j.drivable AND o.drivable AND o.junction_id IS DISTINCT FROM j.junction_id
    ) r
    LEFT JOIN _road_half h USING (environment_id, road_id)
    GROUP BY environment_id, junction_id
),
-- A map that has only lights may lack the signs: a junction without a light may have a sign.
map_with_signals AS (
    SELECT DISTINCT t.environment_id
    FROM traffic_signal t
    JOIN environment e USING (environment_id)
    WHERE e.signs_mapped AND t.kind IN ('traffic_light', 'stop', 'give_way')
),
-- Passages where the map begins so shortly before the junction that a signal may be outside the map.
cropped_approach AS (
    SELECT w.drive_id, w.ego_id, w.t_first_ns
    FROM passage_chain w
    JOIN data_log g USING (drive_id)
    JOIN chain c ON c.drive_id = w.drive_id AND c.ego_id = w.ego_id AND c.chain_id = w.entry_mark.chain_id AND c.seq <= w.entry_mark.seq
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = c.lanelet_id
    JOIN lane_next l ON l.environment_id = g.environment_id AND l.lanelet_id = c.lanelet_id
    GROUP BY w.drive_id, w.ego_id, w.t_first_ns, w.entry_mark
    HAVING min({'seq': c.seq, 'begins': l.map_begins}).begins AND w.entry_mark.s_m - min(c.s_start_m) < governed_m()
        AND NOT bool_or(n.junction_id IS NOT NULL AND c.seq < w.entry_mark.seq)
),
passage_detail AS (
    SELECT
        i.*, e.t_in_ns, o.t_out_ns, b.lanelet_id AS from_id, a.lanelet_id AS to_id,
        CASE WHEN v.handedness_source <> 'default' THEN v.handedness END AS known_handedness,
        -- When the ego's centre is on the lane after the junction, its turn is known, even if the log ends before its rear has left the
        -- junction.
        CASE WHEN e.t_in_ns IS NOT NULL AND (o.t_out_ns IS NOT NULL OR a.t_first_ns > i.t_last_ns) THEN wrap_rad(ea.first_rad - eb.last_rad) END AS turn_rad,
        CASE WHEN w.entry_mark IS NOT NULL THEN coalesce(w.entry_mark.control, CASE WHEN g.environment_id IS NOT NULL AND x.t_first_ns IS NULL THEN 'none' END) END AS control
    FROM passage i
    JOIN environment v USING (environment_id)
    LEFT JOIN passage_chain w USING (drive_id, ego_id, t_first_ns)
    LEFT JOIN entry_time e USING (drive_id, ego_id, t_first_ns)
    LEFT JOIN exit_time o USING (drive_id, ego_id, t_first_ns)
    LEFT JOIN chain b ON b.drive_id = i.drive_id AND b.ego_id = i.ego_id AND b.chain_id = w.entry_mark.chain_id AND b.seq = w.entry_mark.seq - 1
    LEFT JOIN chain a ON a.drive_id = i.drive_id AND a.ego_id = i.ego_id AND a.chain_id = w.exit_mark.chain_id AND a.seq = w.exit_mark.seq + 1
    LEFT JOIN lanelet_heading eb ON eb.environment_id = i.environment_id AND eb.lanelet_id = b.lanelet_id
    LEFT JOIN lanelet_heading ea ON ea.environment_id = i.environment_id AND ea.lanelet_id = a.lanelet_id
    LEFT JOIN map_with_signals g ON g.environment_id = i.environment_id
    LEFT JOIN cropped_approach x ON x.drive_id = i.drive_id AND x.ego_id = i.ego_id AND x.t_first_ns = i.t_first_ns
),
passage_with_turn AS (
    SELECT
        *,
        CASE
            WHEN abs(turn_rad) <= radians(30) THEN 'straight' WHEN abs(turn_rad) > radians(150) THEN 'u_turn'
            WHEN turn_rad > 0 THEN 'left' WHEN turn_rad < 0 THEN 'right'
        END AS turn
    FROM passage_detail
)
SELECT
    t.drive_id, t.ego_id, (row_number() OVER (PARTITION BY t.drive_id, t.ego_id ORDER BY t.t_first_ns) - 1)::INTEGER AS occurrence,
    t.junction_id, t.t_in_ns, t.t_out_ns, t.t_first_ns, t.t_last_ns, t.from_id AS from_lanelet_id, t.via_id AS via_lanelet_id, t.to_id AS to_lanelet_id,
    t.turn, t.turn_rad, s.turn_rad AS straightest_rad,
    CASE WHEN t.known_handedness IS NOT NULL THEN t.turn = 'u_turn' OR t.turn = CASE t.known_handedness WHEN 'lht' THEN 'right' ELSE 'left' END END AS across,
    coalesce(n.n, 0)::INTEGER AS branches, t.control, t.control IN ('stop', 'give_way') AS minor
FROM passage_with_turn t
LEFT JOIN branch_count n USING (environment_id, junction_id)
LEFT JOIN lanelet f ON f.environment_id = t.environment_id AND f.lanelet_id = t.from_id
LEFT JOIN straightest_exit s ON s.environment_id = f.environment_id AND s.junction_id = t.junction_id AND s.road_id = f.road_id AND s.along_road = f.along_road
