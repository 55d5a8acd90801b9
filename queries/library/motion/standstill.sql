-- Periods in which the ego stands. If the log has no speed, the distance from step to step replaces it: an unknown speed must not hide a
-- standstill.
-- lifetime: part
CREATE TABLE standstill (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the standstill, from 0, in time order: the ego stands (below 0.1 m/s; without a speed in the log, by the distance from step to step) for at least 1 s
    t_start_ns BIGINT NOT NULL,       -- first step of the standstill {velocity}
    t_end_ns BIGINT NOT NULL,         -- last step of the standstill {velocity}
    begin_seen BOOLEAN NOT NULL,      -- the stop was seen: the step before exists, and the ego moves there {position}
    end_seen BOOLEAN NOT NULL,        -- the start after the standstill was seen {position}
    road_type VARCHAR,                -- [road_type] see ego_state
    lanelet_id VARCHAR,               -- see ego_lane; NULL: on no lanelet
    junction_id VARCHAR,              -- the junction that contains the ego's front or rear bumper; NULL: none
    junction_clear_m DOUBLE,          -- distance that the ego's rear has to drive to leave this junction; NULL: none, or no position on the ego's chain {position, heading, size}
    junction_inside_m DOUBLE,         -- length of the ego, with its trailer, that is inside this junction; NULL: none, or no position on the ego's chain {position, heading, size}
    turn VARCHAR,                     -- [turn] the ego's turn in this junction, see junction_passage; NULL: none, or not known {position}
    across BOOLEAN,                   -- see junction_passage {position, heading, velocity}
    junction_m DOUBLE,                -- distance from the front bumper to the next junction along the ego's chain; infinite: none within the corridor; NULL: not known {position}
    crossing_id VARCHAR,              -- a pedestrian crossing on which part of the ego's box is; NULL: none
    crossing_clear_m DOUBLE,          -- distance that the ego's rear has to drive to leave the crossing; NULL: none {position, heading, size}
    stop_line_id VARCHAR,             -- the next stop line, at most 20 m ahead of the ego's front or 3 m behind it; NULL: none
    stop_line_m DOUBLE,               -- distance from the ego's front to this line; negative: the front is over it {position}
    control VARCHAR,                  -- [control] see stop_line_crossing
    state VARCHAR,                    -- [light_state] the light's state at t_start_ns; NULL: not known, or no light
    ahead_id VARCHAR,                 -- the nearest vehicle ahead in the ego's lane at t_start_ns; NULL: none, see ahead_known {position}
    ahead_gap_m DOUBLE,               -- gap from the ego to this vehicle {position, heading, size}
    ahead_speed_mps DOUBLE,           -- speed of this vehicle {velocity}
    ahead_known BOOLEAN NOT NULL,     -- it is known which vehicle is ahead, see lead {position}
    blocking_id VARCHAR,              -- the nearest of the vehicles ahead in the ego's lane while the ego stood; vehicles at 1 m/s or less come before faster ones; NULL: none, see blocking_known {position}
    blocking_gap_m DOUBLE,            -- the least gap from the ego to this vehicle {position, heading, size}
    blocking_speed_mps DOUBLE,        -- speed of this vehicle at that gap {velocity}
    blocking_known BOOLEAN NOT NULL,  -- it is known at every step which vehicle is ahead, see lead {position}
    idle_ns BIGINT NOT NULL,          -- lower bound of the longest time for which the ego stood on without an actor in its way within 10 m that stood or moved up at 1 m/s or less, see in_way {velocity}
    idle_at_most_ns BIGINT NOT NULL   -- upper bound of that time: it includes the time in which this is not known {velocity}
);

INSERT INTO standstill BY NAME
WITH step_speed AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, st.k, st.seg,
        coalesce(
            e.speed_mps,
            CASE WHEN st.dt_ns <= c.max_gap_ns THEN sqrt((e.x_m - lag(e.x_m) OVER w) ** 2 + (e.y_m - lag(e.y_m) OVER w) ** 2) / (st.dt_ns / 1e9) END
        ) AS v_mps
    FROM ego_state e
    JOIN step st USING (drive_id, ego_id, t_ns)
    JOIN clock c USING (drive_id, ego_id)
    WINDOW w AS (PARTITION BY e.drive_id, e.ego_id ORDER BY e.t_ns)
),
stop_period AS (
    SELECT drive_id, ego_id, min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns, min(k) AS k_first, max(k) AS k_last, seg
    FROM (
        SELECT *, k - row_number() OVER (PARTITION BY drive_id, ego_id, seg ORDER BY k) AS run_no FROM step_speed WHERE v_mps < standstill_mps()
    )
    GROUP BY drive_id, ego_id, seg, run_no
    HAVING max(t_ns) - min(t_ns) >= 1_000_000_000
),
-- occasion: stop_period
stop_place AS (
    SELECT s.*, e.road_type, e.lanelet_id, e.chain_id, e.front_s_m, e.rear_s_m, n.junction_id AS lane_junction_id, g.environment_id IS NOT NULL AS has_map
    FROM stop_period s
    JOIN data_log g USING (drive_id)
    JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_start_ns
    LEFT JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = e.lanelet_id
),
mark_at_stop AS (
    SELECT t.drive_id, t.ego_id, t.t_start_ns, t.front_s_m, t.rear_s_m, m.kind, m.mark_id, m.s_start_m, m.s_end_m, m.control
    FROM stop_place t
    JOIN way_mark m ON m.drive_id = t.drive_id AND m.ego_id = t.ego_id AND m.chain_id = t.chain_id
    WHERE t.front_s_m IS NOT NULL AND m.s_end_m > t.rear_s_m - 3
),
nearest_mark AS (
    SELECT
        drive_id, ego_id, t_start_ns,
        min({'s_m': s_start_m, 'id': mark_id, 'clear_m': s_end_m - rear_s_m, 'inside_m': least(front_s_m, s_end_m) - greatest(rear_s_m, s_start_m)})
            FILTER (kind = 'junction' AND s_start_m < front_s_m AND s_end_m > rear_s_m) AS junction,
        min(s_start_m - front_s_m) FILTER (kind = 'junction' AND s_start_m >= front_s_m) AS junction_m,
        min({'s_m': s_start_m, 'id': mark_id, 'clear_m': s_end_m - rear_s_m}) FILTER (kind = 'crossing' AND s_start_m < front_s_m AND s_end_m > rear_s_m) AS crossing,
        min({'off_m': abs(s_start_m - front_s_m), 'id': mark_id, 'm': s_start_m - front_s_m, 's_start_m': s_start_m, 'control': control})
            FILTER (kind = 'stop_line' AND s_start_m - front_s_m BETWEEN -3 AND 20) AS line_ahead
    FROM mark_at_stop
    GROUP BY drive_id, ego_id, t_start_ns
),
junction_turn AS (
    SELECT t.drive_id, t.ego_id, t.t_start_ns, p.junction_id, min({'occurrence': p.occurrence, 'turn': p.turn, 'across': p.across}) AS p
    FROM stop_place t
    JOIN junction_passage p ON p.drive_id = t.drive_id AND p.ego_id = t.ego_id
        AND coalesce(p.t_out_ns, t.t_start_ns) >= t.t_start_ns AND coalesce(p.t_in_ns, p.t_first_ns) <= t.t_end_ns
    GROUP BY t.drive_id, t.ego_id, t.t_start_ns, p.junction_id
),
stop_context AS (
    SELECT
        t.*, coalesce(a.junction.id, t.lane_junction_id) AS junction_id, a.junction.clear_m AS junction_clear_m, a.junction.inside_m AS junction_inside_m, a.crossing.id AS crossing_id,
        a.crossing.clear_m AS crossing_clear_m, a.line_ahead,
        CASE WHEN t.front_s_m IS NOT NULL AND t.has_map THEN coalesce(a.junction_m, 'inf'::DOUBLE) END AS junction_m
    FROM stop_place t
    LEFT JOIN nearest_mark a USING (drive_id, ego_id, t_start_ns)
),
light_state AS (
    SELECT p.drive_id, p.ego_id, p.t_start_ns, f.state
    FROM stop_context p
    JOIN mark_phase f ON f.drive_id = p.drive_id AND f.ego_id = p.ego_id AND f.chain_id = p.chain_id AND f.kind = 'stop_line'
        AND f.mark_id = p.line_ahead.id AND f.s_start_m = p.line_ahead.s_start_m
        AND f.t_from_ns <= p.t_start_ns AND p.t_start_ns < coalesce(f.t_to_ns, p.t_start_ns + 1)
),
-- ---- the vehicle behind which the ego stood, and how long it stood without an actor in its way
stop_step AS (
    SELECT
        s.drive_id, s.ego_id, s.t_start_ns, e.t_ns, d.object_id, d.gap_m, d.speed_mps, d.t_ns IS NOT NULL AS known,
        queued(d.object_id, d.gap_m, d.speed_mps, d.t_ns IS NOT NULL, stands_near_m(), moves_up_mps())
            OR stands_because_of(w.object_id, w.actor_class, w.gap_m, w.along_mps, w.known, stands_near_m(), stands_near_m(), moves_up_mps()) AS is_held_up
    FROM stop_period s
    JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns >= s.t_start_ns AND e.t_ns <= s.t_end_ns
    LEFT JOIN lead d ON d.drive_id = e.drive_id AND d.ego_id = e.ego_id AND d.t_ns = e.t_ns
    LEFT JOIN in_way w ON w.drive_id = e.drive_id AND w.ego_id = e.ego_id AND w.t_ns = e.t_ns
),
blocking_vehicle AS (
    SELECT
        drive_id, ego_id, t_start_ns, bool_and(known) AS known,
        min({'is_quick': coalesce(speed_mps > moves_up_mps(), true), 'gap_m': gap_m, 'id': object_id, 'speed_mps': speed_mps}) FILTER (object_id IS NOT NULL) AS nearest
    FROM stop_step
    GROUP BY ALL
),
idle_time AS (
    SELECT drive_id, ego_id, t_start_ns, max(t_ns - coalesce(t_maybe_held_ns, t_start_ns)) AS idle_ns, max(t_ns - coalesce(t_held_ns, t_start_ns)) AS idle_at_most_ns
    FROM (
        SELECT *, max(t_ns) FILTER (is_held_up) OVER w AS t_held_ns, max(t_ns) FILTER (is_held_up IS DISTINCT FROM false) OVER w AS t_maybe_held_ns
        FROM stop_step
        WINDOW w AS (PARTITION BY drive_id, ego_id, t_start_ns ORDER BY t_ns ROWS UNBOUNDED PRECEDING)
    )
    GROUP BY ALL
)
SELECT
    p.drive_id, p.ego_id, (row_number() OVER (PARTITION BY p.drive_id, p.ego_id ORDER BY p.t_start_ns) - 1)::INTEGER AS occurrence,
    p.t_start_ns, p.t_end_ns, coalesce(b.v_mps >= standstill_mps(), false) AS begin_seen, coalesce(a.v_mps >= standstill_mps(), false) AS end_seen,
    p.road_type, p.lanelet_id, p.junction_id, p.junction_clear_m, p.junction_inside_m, u.p.turn AS turn, u.p.across AS across, p.junction_m, p.crossing_id, p.crossing_clear_m,
    p.line_ahead.id AS stop_line_id, p.line_ahead.m AS stop_line_m, p.line_ahead.control AS control, l.state,
    d.object_id AS ahead_id, d.gap_m AS ahead_gap_m, d.speed_mps AS ahead_speed_mps, d.t_ns IS NOT NULL AS ahead_known,
    k.nearest.id AS blocking_id, k.nearest.gap_m AS blocking_gap_m, k.nearest.speed_mps AS blocking_speed_mps, k.known AS blocking_known, i.idle_ns, i.idle_at_most_ns
FROM stop_context p
JOIN blocking_vehicle k ON k.drive_id = p.drive_id AND k.ego_id = p.ego_id AND k.t_start_ns = p.t_start_ns
JOIN idle_time i ON i.drive_id = p.drive_id AND i.ego_id = p.ego_id AND i.t_start_ns = p.t_start_ns
LEFT JOIN step_speed b ON b.drive_id = p.drive_id AND b.ego_id = p.ego_id AND b.seg = p.seg AND b.k = p.k_first - 1
LEFT JOIN step_speed a ON a.drive_id = p.drive_id AND a.ego_id = p.ego_id AND a.seg = p.seg AND a.k = p.k_last + 1
LEFT JOIN junction_turn u ON u.drive_id = p.drive_id AND u.ego_id = p.ego_id AND u.t_start_ns = p.t_start_ns AND u.junction_id = p.junction_id
LEFT JOIN light_state l ON l.drive_id = p.drive_id AND l.ego_id = p.ego_id AND l.t_start_ns = p.t_start_ns
LEFT JOIN lead d ON d.drive_id = p.drive_id AND d.ego_id = p.ego_id AND d.t_ns = p.t_start_ns
