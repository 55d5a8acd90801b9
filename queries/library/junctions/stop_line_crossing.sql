-- The crossings of a stop line of the running lane by the ego's front, with the ego's approach and the state of the light.
-- lifetime: part
CREATE TABLE stop_line_crossing (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the crossing, from 0, in time order: the ego's front goes over a stop line of its running lane; again only if it was 0.5 m back in between
    stop_line_id VARCHAR NOT NULL,    -- the line; for a light without a line, the light itself, see way_mark (no row for a stop or give-way sign without a line, see junction_passage)
    lanelet_id VARCHAR NOT NULL,      -- the lanelet that the line crosses
    control VARCHAR,                  -- [control] the kind of the signal that belongs to the line, see way_mark; NULL: the map has none
    signal_id VARCHAR,                -- that signal; NULL: the map has none
    t_ns BIGINT NOT NULL,             -- first step with the ego's front past the line
    begin_seen BOOLEAN NOT NULL,      -- the step before t_ns exists, with the front before the line {position}
    speed_mps DOUBLE,                 -- speed of the ego at t_ns {velocity}
    state VARCHAR,                    -- [light_state] the light's state for the ego's turn at t_ns, see mark_phase; NULL: not known
    state_before VARCHAR,             -- [light_state] the light's state before the present one; NULL: not known
    t_state_ns BIGINT,                -- start of the present state; NULL: not known {position}
    amber_front_m DOUBLE,             -- distance from the ego's front to the line at the onset of the amber: of the amber in which it crossed, or of the one before the red; NULL: none seen {position, heading, size}
    amber_speed_mps DOUBLE,           -- speed of the ego at that onset {velocity}
    slowest_mps DOUBLE,               -- least speed of the ego with its front 0 to 3 m before the line, or at the last step before the line if none was there; NULL: never seen there, or the speed is not known {velocity}
    least_mps DOUBLE,                 -- least speed that the ego may have had there, also between the steps, in a hole or before the log: it brakes by 8 m/s2 and starts by 3.5 m/s2 at most; NULL: no speed is known there {velocity}
    slowest_front_m DOUBLE,           -- distance from the ego's front to the line at that step {position, heading, size}
    stood_s DOUBLE                    -- longest time for which the ego stood (at most 0.1 m/s) with its front 0 to 1 m before the line, as far as seen; 0: it did not stand; NULL: the speed there is not known {position, velocity}
);

INSERT INTO stop_line_crossing BY NAME
WITH stop_line_step AS (SELECT * FROM _near_mark WHERE kind = 'stop_line'),
numbered_step AS (
    SELECT
        *, front_m >= 0 AND front_before_m < 0 AND running AS is_crossing,
        count(CASE WHEN front_m >= 0 AND front_before_m < 0 AND running THEN 1 END)
            OVER (PARTITION BY drive_id, ego_id, chain_id, mark_id, s_start_m ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS n
    FROM stop_line_step
),
-- A front that jitters on the line crosses it once: for another crossing, it must have been half a metre before the line in between.
way_back AS (
    SELECT drive_id, ego_id, chain_id, mark_id, s_start_m, n + 1 AS n, min(front_m) < -0.5 AS has_been_back
    FROM numbered_step
    GROUP BY drive_id, ego_id, chain_id, mark_id, s_start_m, n
),
crossing_step AS (
    SELECT o.drive_id, o.ego_id, o.chain_id, o.mark_id, o.s_start_m, o.t_ns, o.k, o.joined, o.front_before_m
    FROM numbered_step o
    LEFT JOIN way_back b USING (drive_id, ego_id, chain_id, mark_id, s_start_m, n)
    WHERE o.is_crossing AND (o.n = 1 OR b.has_been_back)
),
crossing_interval AS (
    SELECT *, lag(t_ns, 1, -1) OVER (PARTITION BY drive_id, ego_id, chain_id, mark_id, s_start_m ORDER BY t_ns) AS t_before_ns FROM crossing_step
),
-- ---- the approach to the line
ego_speed_step AS (
    SELECT *, least(
        -- A log may begin after the ego stood up to three metres before.
        CASE WHEN lag(t_ns) OVER step_order IS NOT NULL THEN trough_between_mps(lag(speed_mps) OVER step_order, speed_mps, (t_ns - lag(t_ns) OVER step_order) / 1e9)
            WHEN speed_mps ** 2 <= 2 * 3.5 * 3 THEN 0.0 ELSE speed_mps END,
        CASE WHEN lead(t_ns) OVER step_order IS NOT NULL THEN trough_between_mps(speed_mps, lead(speed_mps) OVER step_order, (lead(t_ns) OVER step_order - t_ns) / 1e9) ELSE speed_mps END
    ) AS least_mps
    FROM ego_state
    WINDOW step_order AS (PARTITION BY drive_id, ego_id ORDER BY t_ns)
),
approach_step AS (
    SELECT c.drive_id, c.ego_id, c.chain_id, c.mark_id, c.s_start_m, c.t_ns, n.t_ns AS t_step_ns, n.k, n.seg, n.front_m, e.speed_mps, e.least_mps, c.joined AND n.k = c.k - 1 AS is_last
    FROM crossing_interval c
    JOIN stop_line_step n ON n.drive_id = c.drive_id AND n.ego_id = c.ego_id AND n.chain_id = c.chain_id AND n.mark_id = c.mark_id AND n.s_start_m = c.s_start_m
        AND n.t_ns < c.t_ns AND n.t_ns > c.t_before_ns
    JOIN ego_speed_step e ON e.drive_id = n.drive_id AND e.ego_id = n.ego_id AND e.t_ns = n.t_ns
    WHERE n.front_m <= 0
),
slowest_step AS (
    SELECT
        drive_id, ego_id, chain_id, mark_id, s_start_m, t_ns,
        -- At high speed there may be no step within the last three metres. Then the last step before the line counts.
        coalesce(
            min({'speed_mps': speed_mps, 't_ns': t_step_ns, 'front_m': front_m}) FILTER (front_m >= -3 AND speed_mps IS NOT NULL),
            min({'speed_mps': speed_mps, 't_ns': t_step_ns, 'front_m': front_m}) FILTER (is_last AND speed_mps IS NOT NULL)
        ) AS slowest,
        coalesce(min(least_mps) FILTER (front_m >= -3 AND speed_mps IS NOT NULL), min(least_mps) FILTER (is_last AND speed_mps IS NOT NULL)) AS least_mps,
        coalesce(bool_or(speed_mps IS NULL) FILTER (front_m >= -3), false) AS unknown_3m, coalesce(bool_or(speed_mps IS NULL) FILTER (front_m >= -1), false) AS unknown_1m
    FROM approach_step
    GROUP BY drive_id, ego_id, chain_id, mark_id, s_start_m, t_ns
),
stop_time AS (
    SELECT drive_id, ego_id, chain_id, mark_id, s_start_m, t_ns, max(stood_ns) / 1e9 AS stood_s
    FROM (
        SELECT drive_id, ego_id, chain_id, mark_id, s_start_m, t_ns, max(t_step_ns) - min(t_step_ns) AS stood_ns
        FROM (
            SELECT *, k - row_number() OVER (PARTITION BY drive_id, ego_id, chain_id, mark_id, s_start_m, t_ns, seg ORDER BY k) AS run_no
            FROM approach_step
            WHERE front_m >= -1 AND speed_mps <= standstill_mps()
        )
        GROUP BY drive_id, ego_id, chain_id, mark_id, s_start_m, t_ns, seg, run_no
    )
    GROUP BY drive_id, ego_id, chain_id, mark_id, s_start_m, t_ns
),
-- ---- the light
light_state AS (
    SELECT
        c.drive_id, c.ego_id, c.chain_id, c.mark_id, c.s_start_m, c.t_ns, p.state, p.state_before, CASE WHEN p.begin_seen THEN p.t_from_ns END AS t_state_ns,
        CASE WHEN p.state = 'amber' AND p.begin_seen THEN p.t_from_ns WHEN p.state = 'red' AND p.state_before = 'amber' THEN p.t_before_ns END AS t_amber_ns
    FROM crossing_step c
    JOIN mark_phase p USING (drive_id, ego_id, chain_id, mark_id, s_start_m)
    WHERE p.kind = 'stop_line' AND p.t_from_ns <= c.t_ns AND c.t_ns < coalesce(p.t_to_ns, c.t_ns + 1)
),
amber_onset AS (
    SELECT
        l.drive_id, l.ego_id, l.chain_id, l.mark_id, l.s_start_m, l.t_ns,
        min({'t_ns': x.t_ns, 'front_m': l.s_start_m - x.front_s_m, 'speed_mps': e.speed_mps}) AS a
    FROM light_state l
    JOIN clock k USING (drive_id, ego_id)
    JOIN ego_corridor x ON x.drive_id = l.drive_id AND x.ego_id = l.ego_id AND x.chain_id = l.chain_id
        AND x.t_ns >= l.t_amber_ns AND x.t_ns <= l.t_amber_ns + k.max_gap_ns
    JOIN ego_state e ON e.drive_id = x.drive_id AND e.ego_id = x.ego_id AND e.t_ns = x.t_ns
    WHERE x.front_s_m IS NOT NULL
    GROUP BY l.drive_id, l.ego_id, l.chain_id, l.mark_id, l.s_start_m, l.t_ns
)
SELECT
    c.drive_id, c.ego_id, (row_number() OVER (PARTITION BY c.drive_id, c.ego_id ORDER BY c.t_ns, c.mark_id) - 1)::INTEGER AS occurrence,
    c.mark_id AS stop_line_id, m.lanelet_id, m.control, m.signal_id, c.t_ns, c.joined AS begin_seen, e.speed_mps,
    l.state, l.state_before, l.t_state_ns, a.a.front_m AS amber_front_m, a.a.speed_mps AS amber_speed_mps,
    CASE WHEN NOT s.unknown_3m OR s.slowest.speed_mps <= standstill_mps() THEN s.slowest.speed_mps END AS slowest_mps,
    CASE WHEN NOT s.unknown_3m OR s.slowest.speed_mps <= standstill_mps() THEN -s.slowest.front_m END AS slowest_front_m,
    s.least_mps,
    CASE WHEN d.stood_s IS NOT NULL AND NOT s.unknown_1m THEN d.stood_s WHEN NOT s.unknown_1m THEN 0.0 WHEN s.t_ns IS NULL THEN 0.0 END AS stood_s
FROM crossing_step c
JOIN way_mark m ON m.drive_id = c.drive_id AND m.ego_id = c.ego_id AND m.chain_id = c.chain_id AND m.mark_id = c.mark_id
    AND m.s_start_m = c.s_start_m AND m.kind = 'stop_line'
JOIN ego_state e ON e.drive_id = c.drive_id AND e.ego_id = c.ego_id AND e.t_ns = c.t_ns
LEFT JOIN slowest_step s ON s.drive_id = c.drive_id AND s.ego_id = c.ego_id AND s.chain_id = c.chain_id AND s.mark_id = c.mark_id
    AND s.s_start_m = c.s_start_m AND s.t_ns = c.t_ns
LEFT JOIN stop_time d ON d.drive_id = c.drive_id AND d.ego_id = c.ego_id AND d.chain_id = c.chain_id AND d.mark_id = c.mark_id
    AND d.s_start_m = c.s_start_m AND d.t_ns = c.t_ns
LEFT JOIN light_state l ON l.drive_id = c.drive_id AND l.ego_id = c.ego_id AND l.chain_id = c.chain_id AND l.mark_id = c.mark_id
    AND l.s_start_m = c.s_start_m AND l.t_ns = c.t_ns
LEFT JOIN amber_onset a ON a.drive_id = c.drive_id AND a.ego_id = c.ego_id AND a.chain_id = c.chain_id AND a.mark_id = c.mark_id
    AND a.s_start_m = c.s_start_m AND a.t_ns = c.t_ns
