-- The ego's passages over pedestrian crossings: when each began and ended, and who was on the ego's half of it or stood at its end.
-- lifetime: part
CREATE TABLE crossing_passage (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the passage, from 0, in time order: the ego drives over a pedestrian crossing, or reverses onto it
    crossing_id VARCHAR NOT NULL,     -- the crossing
    kind VARCHAR,                     -- [crossing_kind] as the map states, or signalled if a light governs the crossing; NULL: the map does not state it
    t_in_ns BIGINT,                   -- first step with the ego's front (reversing: its rear) on the crossing; NULL: the log or a part after a hole begins with the ego on it {position}
    t_out_ns BIGINT,                  -- first step with the ego's rear past the crossing, or, if it came reversing, its front back before it; NULL: the log or the part before a hole ends with the ego on it {position}
    on_id VARCHAR,                    -- the first pedestrian on the ego's half at any time from t_in_ns to t_out_ns; also on the other half, if the ego's centre was over that half; NULL: none {position}
    t_on_ns BIGINT,                   -- time since which on_id is there; NULL: none {position}
    coming_id VARCHAR,                -- a pedestrian on the other half at t_in_ns who goes straight on to the ego's half within 3 s (a longer time is a wait on an island); NULL: none {position}
    coming_known BOOLEAN NOT NULL,    -- for every pedestrian on the other half at t_in_ns, it is known whether they came from the ego's half, leave the crossing, or come to the ego's half; not known if the ego's side was over the other half {position}
    waiting_id VARCHAR,               -- a pedestrian who stands (at most 0.5 m/s) beside the lanes, within 2 m of the crossing's end on the ego's side, during the whole 2 s before t_in_ns; NULL: none {position}
    waiting_known BOOLEAN NOT NULL,   -- no actor of unknown class waits there, and no one of unknown speed may {position}
    known BOOLEAN NOT NULL,           -- all pedestrians nearby have a position from 2 s before t_in_ns to t_out_ns: no track has a hole then, or begins or ends within 30 m; and no actor of unknown class is on the crossing {position}
    signal_id VARCHAR,                -- the light for vehicles, see way_mark; NULL: the map has none
    state VARCHAR,                    -- [light_state] the light's state at t_in_ns; NULL: not known
    stood_before BOOLEAN              -- the ego stood within 5 m before the crossing during the 10 s before t_in_ns; NULL: not seen, or it came reversing {position, velocity}
);

INSERT INTO crossing_passage BY NAME
WITH crossing_step AS (
    SELECT
        *, running AND front_m >= 0 AND ((rear_m < 0 AND NOT joined) OR front_before_m < 0) AS enters_forwards,
        -- The ego reverses onto the crossing over its far edge.
        coalesce(running AND joined AND rear_m < 0 AND rear_before_m >= 0 AND front_m >= 0 AND front_before_m >= 0, false) AS enters_backwards
    FROM _near_mark
    WHERE kind = 'crossing'
),
passage_step AS (
    SELECT
        *, enters_forwards OR enters_backwards AS begins,
        count(CASE WHEN enters_forwards OR enters_backwards THEN 1 END) OVER (PARTITION BY drive_id, ego_id, chain_id, mark_id, s_start_m ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS n
    FROM crossing_step
),
-- An ego whose position jitters at the edge enters the crossing only once, see stop_line_crossing.
stretch_before AS (
    SELECT drive_id, ego_id, chain_id, mark_id, s_start_m, n + 1 AS n, min(front_m) < -0.5 AS was_before, max(rear_m) > 0.5 AS was_past
    FROM passage_step
    GROUP BY drive_id, ego_id, chain_id, mark_id, s_start_m, n
),
entry AS (
    SELECT o.drive_id, o.ego_id, o.chain_id, o.mark_id, o.s_start_m, o.t_ns, o.seg, o.enters_backwards,
        CASE WHEN o.joined AND (o.enters_backwards OR o.front_before_m < 0) THEN o.t_ns END AS t_in_ns
    FROM passage_step o
    LEFT JOIN stretch_before b USING (drive_id, ego_id, chain_id, mark_id, s_start_m, n)
    WHERE o.begins AND (o.n = 1 OR CASE WHEN o.enters_backwards THEN b.was_past ELSE b.was_before END OR NOT o.joined)
),
entry_with_next AS (
    SELECT *, lead(t_ns, 1, 9223372036854775807) OVER (PARTITION BY drive_id, ego_id, chain_id, mark_id, s_start_m ORDER BY t_ns) AS t_next_ns FROM entry
),
passage AS (
    SELECT
        b.drive_id, b.ego_id, b.chain_id, b.mark_id, b.s_start_m, b.t_ns, b.t_in_ns, b.enters_backwards,
        min(n.t_ns) FILTER ((n.rear_m >= 0 OR (b.enters_backwards AND n.front_m < 0)) AND n.seg = b.seg) AS t_out_ns,
        max(n.t_ns) FILTER (n.rear_m < 0 AND NOT (b.enters_backwards AND n.front_m < 0) AND n.seg = b.seg) AS t_last_ns
    FROM entry_with_next b
    JOIN passage_step n ON n.drive_id = b.drive_id AND n.ego_id = b.ego_id AND n.chain_id = b.chain_id AND n.mark_id = b.mark_id AND n.s_start_m = b.s_start_m
        AND n.t_ns >= b.t_ns AND n.t_ns < b.t_next_ns
    GROUP BY b.drive_id, b.ego_id, b.chain_id, b.mark_id, b.s_start_m, b.t_ns, b.t_in_ns, b.enters_backwards
),
crossing_kind AS (SELECT environment_id, crossing_id, min(kind) AS kind FROM crossing GROUP BY environment_id, crossing_id),
passage_context AS (
    SELECT
        p.*, g.environment_id, g.sensor_range_m, n.along_road, m.lanelet_id, m.s_end_m, m.control, m.signal_id, c.max_gap_ns, c.t_start_ns, c.t_end_ns,
        p.t_in_ns - 2_000_000_000 AS t_watch_from_ns, coalesce(p.t_out_ns, p.t_last_ns, p.t_ns) AS t_watch_to_ns, e.x_m, e.y_m
    FROM passage p
    JOIN data_log g USING (drive_id)
    JOIN clock c USING (drive_id, ego_id)
    JOIN way_mark m USING (drive_id, ego_id, chain_id, mark_id, s_start_m)
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = m.lanelet_id
    JOIN ego_state e ON e.drive_id = p.drive_id AND e.ego_id = p.ego_id AND e.t_ns = p.t_ns
    WHERE m.kind = 'crossing'
),
-- ---- people on the crossing and at its end
-- The ego's centre gets onto the other half (is_driven), or at least its side does (is_reached).
other_half AS (
    SELECT
        v.drive_id, v.ego_id, v.mark_id, v.t_ns, -v.along_road AS along_road,
        bool_or(v.side * x.d_m - x.half_width_m > o.gap_m) AS is_driven,
        bool_or(coalesce(CASE v.side WHEN 1 THEN x.left_out_m ELSE x.right_out_m END > o.gap_m + over_boundary_m(), true)) AS is_reached
    FROM (FROM passage_context CROSS JOIN (VALUES (1), (-1)) AS b(side)) v
    JOIN (
        SELECT environment_id, lanelet_id, side, min(gap_m) AS gap_m FROM lane_beside WHERE against GROUP BY ALL
    ) o ON o.environment_id = v.environment_id AND o.lanelet_id = v.lanelet_id AND o.side = CASE v.side WHEN 1 THEN 'left' ELSE 'right' END
    JOIN ego_corridor x ON x.drive_id = v.drive_id AND x.ego_id = v.ego_id AND x.chain_id = v.chain_id
        AND x.t_ns >= coalesce(v.t_in_ns, v.t_ns) AND x.t_ns <= v.t_watch_to_ns
    -- Steps after the ego's centre has passed the crossing do not count as driving on the other half.
    WHERE x.s_m <= v.s_end_m OR x.t_ns = v.t_in_ns
    GROUP BY ALL
),
driven_half AS (
    SELECT drive_id, ego_id, mark_id, t_ns, along_road FROM passage_context
    UNION SELECT drive_id, ego_id, mark_id, t_ns, along_road FROM other_half WHERE is_driven
),
passage_occupancy AS (
    SELECT
        v.drive_id, v.ego_id, v.mark_id, v.t_ns,
        min({'t_ns': o.t_from_ns, 'id': o.object_id}) FILTER (a.actor_class = 'pedestrian') AS first_occupant, bool_or(a.actor_class IS DISTINCT FROM 'pedestrian') AS has_unclassed
    FROM passage_context v
    JOIN driven_half h USING (drive_id, ego_id, mark_id, t_ns)
    JOIN _crossing_occupancy o ON o.drive_id = v.drive_id AND o.crossing_id = v.mark_id AND o.along_road = h.along_road AND o.object_id <> v.ego_id
        AND o.t_from_ns <= v.t_watch_to_ns AND o.t_to_ns >= coalesce(v.t_in_ns, v.t_ns)
    JOIN road_user a ON a.drive_id = o.drive_id AND a.actor_id = o.object_id
    GROUP BY v.drive_id, v.ego_id, v.mark_id, v.t_ns
),
-- Pedestrians on the other half when the ego enters, and where they go. Those who go straight on reach the ego's half. Those who came from
-- there, or who leave the crossing on the other half, do not.
other_half_occupant AS (
    SELECT
        v.drive_id, v.ego_id, v.mark_id, v.t_ns, o.object_id, a.actor_class, o.t_to_ns, v.t_end_ns - v.max_gap_ns AS t_seen_until_ns,
        min(q.t_from_ns) FILTER (q.t_from_ns > v.t_in_ns) AS t_next_ns, coalesce(bool_or(q.t_from_ns <= v.t_in_ns), false) AS came_from_ego_half,
        coalesce(x.is_reached, false) AS is_reached
    FROM passage_context v
    LEFT JOIN other_half x ON x.drive_id = v.drive_id AND x.ego_id = v.ego_id AND x.mark_id = v.mark_id AND x.t_ns = v.t_ns
    JOIN _crossing_occupancy o ON o.drive_id = v.drive_id AND o.crossing_id = v.mark_id AND o.along_road = -v.along_road AND o.object_id <> v.ego_id
        AND o.t_from_ns <= v.t_in_ns AND o.t_to_ns >= v.t_in_ns
    JOIN road_user a ON a.drive_id = o.drive_id AND a.actor_id = o.object_id
    LEFT JOIN _crossing_occupancy q ON q.drive_id = o.drive_id AND q.crossing_id = o.crossing_id AND q.object_id = o.object_id AND q.along_road = v.along_road
    GROUP BY ALL
),
coming_occupant AS (
    SELECT drive_id, ego_id, mark_id, t_ns, min(object_id) FILTER (comes AND actor_class = 'pedestrian') AS coming_id,
        bool_and(comes IS NOT NULL AND NOT (comes AND actor_class IS DISTINCT FROM 'pedestrian')) AS known
    FROM (
        SELECT *, CASE WHEN t_next_ns - t_to_ns <= half_to_half_ns() THEN true WHEN is_reached THEN NULL WHEN came_from_ego_half OR t_to_ns < t_seen_until_ns THEN false END AS comes FROM other_half_occupant
    )
    GROUP BY drive_id, ego_id, mark_id, t_ns
),
-- The outermost lane of each half: the crossing ends at the outer bound of this lane.
outer_lane AS (
    SELECT x.environment_id, x.crossing_id, n.along_road, x.lanelet_id, x.s_start_m, x.s_end_m, v.handedness
    FROM crossing x
    JOIN environment v USING (environment_id)
    JOIN lanelet n USING (environment_id, lanelet_id)
    ANTI JOIN crossing y ON y.environment_id = x.environment_id AND y.crossing_id = x.crossing_id
        AND y.lanelet_id = CASE v.handedness WHEN 'lht' THEN n.left_id ELSE n.right_id END
),
crossing_end AS (
    SELECT
        o.environment_id, o.crossing_id, o.along_road, CASE o.handedness WHEN 'lht' THEN p.left_x_m ELSE p.right_x_m END AS x0,
        CASE o.handedness WHEN 'lht' THEN p.left_y_m ELSE p.right_y_m END AS y0, p.tx, p.ty, p.s_m, o.s_start_m, o.s_end_m
    FROM outer_lane o
    ASOF JOIN lane_point p ON p.environment_id = o.environment_id AND p.lanelet_id = o.lanelet_id AND p.s_m <= o.s_start_m
),
person_sample AS (
    SELECT v.drive_id, v.ego_id, v.mark_id, v.t_ns, v.t_in_ns, v.max_gap_ns, s.actor_id, s.actor_class, s.t_ns AS t_at_ns, s.speed_mps <= standing_mps() AS stands,
        min(piece_distance_m(s.x_m, s.y_m, k.x0, k.y0, k.tx, k.ty, k.s_start_m - k.s_m, k.s_end_m - k.s_m)) AS off_m
    FROM passage_context v
    JOIN state_dynamics s ON s.drive_id = v.drive_id AND s.actor_id <> v.ego_id AND s.t_ns >= v.t_watch_from_ns AND s.t_ns <= v.t_in_ns
    JOIN crossing_end k ON k.environment_id = v.environment_id AND k.crossing_id = v.mark_id AND k.along_road = v.along_road
    -- A person on the crossing is no longer waiting.
    ANTI JOIN _crossing_occupancy o ON o.drive_id = v.drive_id AND o.crossing_id = v.mark_id AND o.object_id = s.actor_id
        AND o.t_from_ns <= v.t_in_ns AND o.t_to_ns >= v.t_watch_from_ns
    WHERE may_walk(s.actor_class)
    GROUP BY ALL
),
waiting_person AS (
    SELECT drive_id, ego_id, mark_id, t_ns, min(actor_id) FILTER (actor_class = 'pedestrian' AND is_sure) AS waiting_id, bool_and(actor_class IS NOT NULL AND is_sure) AS known
    FROM (
        -- A person whose speed is not known at some of the steps may stand there.
        SELECT drive_id, ego_id, mark_id, t_ns, actor_id, actor_class, bool_and(stands IS NOT NULL) AS is_sure
        FROM person_sample
        GROUP BY drive_id, ego_id, mark_id, t_ns, t_in_ns, max_gap_ns, actor_id, actor_class
        HAVING bool_and(coalesce(stands, true) AND coalesce(off_m <= 2, false)) AND min(t_at_ns) <= t_in_ns - 2_000_000_000 + max_gap_ns AND max(t_at_ns) >= t_in_ns - max_gap_ns
    )
    GROUP BY drive_id, ego_id, mark_id, t_ns
),
-- ---- whether another person may have been there
unplaced_person AS (
    SELECT v.drive_id, v.ego_id, v.mark_id, v.t_ns, o.object_id, v.x_m, v.y_m, v.t_watch_from_ns, v.t_watch_to_ns,
        CASE WHEN o.actor_class IS NULL THEN 30.0 ELSE 3.0 END * count(*) * any_value(c.period_ns) / 1e9 AS reach_m
    FROM passage_context v
    JOIN clock c USING (drive_id, ego_id)
    JOIN (FROM pair WHERE (x_m IS NULL OR y_m IS NULL) AND may_walk(actor_class)) o
        ON o.drive_id = v.drive_id AND o.ego_id = v.ego_id AND o.t_ns >= v.t_watch_from_ns AND o.t_ns <= v.t_watch_to_ns
    GROUP BY v.drive_id, v.ego_id, v.mark_id, v.t_ns, o.object_id, o.actor_class, v.x_m, v.y_m, v.t_watch_from_ns, v.t_watch_to_ns
),
passage_near_unplaced_person AS (
    SELECT b.drive_id, b.ego_id, b.mark_id, b.t_ns
    FROM unplaced_person b
    LEFT JOIN (
        SELECT b.drive_id, b.ego_id, b.mark_id, b.t_ns, b.object_id, min(sqrt((o.x_m - b.x_m) ** 2 + (o.y_m - b.y_m) ** 2)) AS least_m
        FROM unplaced_person b
        JOIN pair o ON o.drive_id = b.drive_id AND o.ego_id = b.ego_id AND o.object_id = b.object_id
            AND o.t_ns >= b.t_watch_from_ns - conflict_ns() AND o.t_ns <= b.t_watch_to_ns + conflict_ns()
        GROUP BY b.drive_id, b.ego_id, b.mark_id, b.t_ns, b.object_id
    ) k USING (drive_id, ego_id, mark_id, t_ns, object_id)
    WHERE k.least_m IS NULL OR k.least_m < meeting_near_m() + b.reach_m
),
-- The first and last sample with a position of each track. If the position jumps, the reader of the log gives the later part of the track
-- another id (drivelint/drive/jumps.py): the track ends here at the jump.
track_range AS (
    SELECT s.drive_id, s.actor_id, min(s.t_ns) AS t_first_ns, max(s.t_ns) AS t_last_ns
    FROM state_dynamics s
    WHERE may_walk(s.actor_class) AND s.x_m IS NOT NULL AND s.y_m IS NOT NULL
    GROUP BY s.drive_id, s.actor_id
),
passage_near_broken_track AS (
    SELECT v.drive_id, v.ego_id, v.mark_id, v.t_ns
    FROM passage_context v
    JOIN clock c USING (drive_id, ego_id)
    JOIN track_range d ON d.drive_id = v.drive_id AND d.actor_id <> v.ego_id
    CROSS JOIN LATERAL (
        VALUES (d.t_first_ns, greatest(0, d.t_first_ns - v.t_watch_to_ns), d.t_first_ns - v.t_watch_from_ns), (d.t_last_ns, greatest(0, v.t_watch_from_ns - d.t_last_ns), v.t_watch_to_ns - d.t_last_ns)
    ) AS w(t_at_ns, apart_ns, walk_ns)
    JOIN state_dynamics s ON s.drive_id = v.drive_id AND s.actor_id = d.actor_id AND s.t_ns = w.t_at_ns
    WHERE w.walk_ns >= 0 AND w.apart_ns <= conflict_ns() AND w.t_at_ns > c.t_start_ns + c.max_gap_ns AND w.t_at_ns < c.t_end_ns - c.max_gap_ns
        -- If the track ends while the ego passes, it counts if it ends near the crossing. If it ends before or after, it counts if a person
        -- can walk that far in the time.
        AND sqrt((s.x_m - v.x_m) ** 2 + (s.y_m - v.y_m) ** 2)
            < CASE WHEN w.apart_ns = 0 THEN meeting_near_m() ELSE greatest(5.0, 3.0 * w.walk_ns / 1e9) END
),
passage_with_hole AS (
    SELECT v.drive_id, v.ego_id, v.mark_id, v.t_ns
    FROM passage_context v JOIN step st ON st.drive_id = v.drive_id AND st.ego_id = v.ego_id AND st.t_ns >= v.t_watch_from_ns AND st.t_ns <= v.t_watch_to_ns
    GROUP BY v.drive_id, v.ego_id, v.mark_id, v.t_ns
    HAVING min(st.seg) < max(st.seg)
),
unknown_passage AS (
    SELECT drive_id, ego_id, mark_id, t_ns FROM passage_near_unplaced_person
    UNION SELECT drive_id, ego_id, mark_id, t_ns FROM passage_near_broken_track
    UNION SELECT drive_id, ego_id, mark_id, t_ns FROM passage_with_hole
    UNION SELECT drive_id, ego_id, mark_id, t_ns FROM passage_occupancy WHERE has_unclassed
    UNION SELECT drive_id, ego_id, mark_id, t_ns FROM passage_context WHERE t_in_ns IS NULL OR t_out_ns IS NULL OR t_start_ns > t_watch_from_ns OR sensor_range_m < 20
),
-- ---- whether the ego stood before the crossing
stop_before AS (
    SELECT
        v.drive_id, v.ego_id, v.mark_id, v.t_ns,
        CASE
            WHEN bool_or(e.speed_mps <= standstill_mps() AND n.front_m >= -5) THEN true
            WHEN bool_or(e.speed_mps IS NULL AND n.front_m >= -5) THEN NULL
            WHEN bool_or(n.front_m < -5) OR min(n.t_ns) <= v.t_in_ns - 10_000_000_000 + v.max_gap_ns THEN false
        END AS stood_before
    FROM passage_context v
    JOIN passage_step n ON n.drive_id = v.drive_id AND n.ego_id = v.ego_id AND n.chain_id = v.chain_id AND n.mark_id = v.mark_id AND n.s_start_m = v.s_start_m
        AND n.t_ns < v.t_in_ns AND n.t_ns >= v.t_in_ns - 10_000_000_000
    JOIN ego_state e ON e.drive_id = n.drive_id AND e.ego_id = n.ego_id AND e.t_ns = n.t_ns
    WHERE n.front_m < 0 AND NOT v.enters_backwards
    GROUP BY v.drive_id, v.ego_id, v.mark_id, v.t_ns, v.t_in_ns, v.max_gap_ns
),
light_state AS (
    SELECT v.drive_id, v.ego_id, v.mark_id, v.t_ns, f.state
    FROM passage_context v
    JOIN mark_phase f USING (drive_id, ego_id, chain_id, mark_id, s_start_m)
    WHERE f.kind = 'crossing' AND f.t_from_ns <= v.t_in_ns AND v.t_in_ns < coalesce(f.t_to_ns, v.t_in_ns + 1)
)
SELECT
    v.drive_id, v.ego_id, (row_number() OVER (PARTITION BY v.drive_id, v.ego_id ORDER BY v.t_ns, v.mark_id) - 1)::INTEGER AS occurrence,
    v.mark_id AS crossing_id, coalesce(s.kind, CASE WHEN v.signal_id IS NOT NULL THEN 'signalled' END) AS kind,
    v.t_in_ns, CASE WHEN v.t_last_ns IS NOT NULL OR v.t_in_ns IS NOT NULL THEN v.t_out_ns END AS t_out_ns,
    o.first_occupant.id AS on_id, o.first_occupant.t_ns AS t_on_ns, f.coming_id, coalesce(f.known, true) AS coming_known, w.waiting_id, coalesce(w.known, true) AS waiting_known, u.t_ns IS NULL AS known,
    v.signal_id, l.state, h.stood_before
FROM passage_context v
LEFT JOIN crossing_kind s ON s.environment_id = v.environment_id AND s.crossing_id = v.mark_id
LEFT JOIN passage_occupancy o USING (drive_id, ego_id, mark_id, t_ns)
LEFT JOIN waiting_person w USING (drive_id, ego_id, mark_id, t_ns)
LEFT JOIN coming_occupant f USING (drive_id, ego_id, mark_id, t_ns)
LEFT JOIN unknown_passage u USING (drive_id, ego_id, mark_id, t_ns)
LEFT JOIN stop_before h USING (drive_id, ego_id, mark_id, t_ns)
LEFT JOIN light_state l USING (drive_id, ego_id, mark_id, t_ns)
