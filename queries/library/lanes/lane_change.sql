-- Changes of the ego to an adjacent lane of the same direction, with the vehicles in the new lane at the start. A change lasts from the
-- first corner over the line until the whole ego is in the new lane. If the crossing of the line is not seen, the change counts only if
-- half a metre of the ego is over the line when the log or a hole ends it.
-- lifetime: part
CREATE TABLE lane_change (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the change, from 0, in time order: first the changes to an adjacent lane of the same direction, then those out of restricted ground
    t_start_ns BIGINT NOT NULL,       -- first step with a corner more than 0.05 m over the boundary {position}
    begin_seen BOOLEAN NOT NULL,      -- the step before t_start_ns exists, and the ego is inside the lane there {position}
    t_cross_ns BIGINT,                -- first step with the centre over the boundary; NULL: the log or a hole ends before (with half a metre of the ego over it), or it crossed during a hole {position}
    t_done_ns BIGINT,                 -- first step with the whole box in the new lane; NULL: the log or a hole ends before {position}
    side VARCHAR NOT NULL,            -- [side] the side to which the ego changes {position}
    from_lanelet_id VARCHAR NOT NULL, -- the lane that the ego leaves, at t_start_ns
    to_lanelet_id VARCHAR,            -- the lane that the ego enters, at t_cross_ns; NULL: not seen
    merge BOOLEAN,                    -- the old lane only leads onto the new one (an entry, an on-ramp, or a lane that ends); NULL: not known {position}
    ego_speed_mps DOUBLE,             -- speed of the ego at t_start_ns {velocity}
    leader_id VARCHAR,                -- the nearest vehicle ahead in the new lane at t_start_ns; NULL: none, see known {position}
    leader_gap_m DOUBLE,              -- distance from the ego's front to the leader's rear {position, heading, size}
    leader_speed_mps DOUBLE,          -- speed of the leader {velocity}
    follower_id VARCHAR,              -- the nearest vehicle behind in the new lane at t_start_ns, or one beside the ego that is still beside it when the ego's centre crosses the line; NULL: none, see known {position}
    follower_gap_m DOUBLE,            -- distance from the follower's front to the ego's rear; negative: alongside {position, heading, size}
    follower_gap_before_m DOUBLE,     -- the same gap at the step before t_start_ns: the ego crosses the line between the two steps; NULL: not seen {position, heading, size}
    follower_speed_mps DOUBLE,        -- speed of the follower {velocity}
    follower_decel_mps2 DOUBLE,       -- the follower's strongest mean deceleration over 0.5 s in the 4 s after t_start_ns (positive: it slowed); NULL: not completely seen, or no follower {velocity}
    known BOOLEAN NOT NULL,           -- the positions of all vehicles nearby are known at t_start_ns: no other vehicle is leader or follower {position}
    unseen_m DOUBLE                   -- lower bound of the distance of a vehicle without a position that may be behind in the new lane at t_start_ns; infinite: none; NULL: the ego's position was not known {position}
);

INSERT INTO lane_change BY NAME
WITH any_crossing AS (FROM lane_crossing),
unfinished_excursion AS (FROM excursion WHERE t_back_ns IS NULL AND max_out_m >= 0.5),
step_on_restricted_ground AS (FROM ego_lane WHERE aside_type = 'restricted' AND aside_with_direction),
-- occasion: any_crossing, unfinished_excursion, step_on_restricted_ground
chain_span AS (
    SELECT drive_id, ego_id, chain_id, min(t_ns) AS t_ns, max({'t_ns': t_ns, 'id': lanelet_id}).id AS last_id
    FROM ego_state
    WHERE with_direction
    GROUP BY ALL
),
crossing_step AS (
    SELECT
        l.*, lead(l.t_ns) OVER (PARTITION BY l.drive_id, l.ego_id ORDER BY l.t_ns) AS t_next_ns, b.t_ns AS t_chain_ns, b.last_id
    FROM any_crossing l
    JOIN chain_span b ON b.drive_id = l.drive_id AND b.ego_id = l.ego_id AND b.chain_id = l.from_chain_id
),
change_begin AS (
    SELECT c.drive_id, c.ego_id, c.t_ns, min({'t0_ns': x.t0_ns, 'seen': x.begin_seen}) AS x
    FROM crossing_step c
    JOIN excursion x ON x.drive_id = c.drive_id AND x.ego_id = c.ego_id AND x.chain_id = c.from_chain_id AND x.side = c.side
        AND x.t0_ns <= c.t_ns AND x.t_end_ns >= c.t_before_ns
    GROUP BY ALL
),
-- Measured from the new lane, the ego is over the near boundary of that lane until it is wholly inside.
change_end AS (
    SELECT c.drive_id, c.ego_id, c.t_ns, count(*) AS n, min(x.t_back_ns) AS t_back_ns
    FROM crossing_step c
    JOIN excursion x ON x.drive_id = c.drive_id AND x.ego_id = c.ego_id AND x.chain_id = c.to_chain_id AND x.side = -c.side
        AND x.t0_ns <= c.t_ns AND x.t_end_ns >= c.t_ns
    GROUP BY ALL
),
crossed_change AS (
    SELECT
        c.drive_id, c.ego_id, c.from_chain_id, c.to_chain_id, c.side,
        -- If the ego was never wholly in the lane that it leaves, the change begins at the crossing into that lane.
        greatest(coalesce(b.x.t0_ns, c.t_ns), c.t_chain_ns) AS t_start_ns,
        coalesce(b.x.seen AND b.x.t0_ns >= c.t_chain_ns, false) AS begin_seen,
        CASE WHEN c.seen THEN c.t_ns END AS t_cross_ns, c.t_before_ns AS t_own_lane_ns, c.t_ns AS t_new_lane_ns,
        CASE WHEN coalesce(d.n, 0) = 0 THEN CASE WHEN y.front_s_m IS NOT NULL THEN c.t_ns END WHEN d.t_back_ns < coalesce(c.t_next_ns, d.t_back_ns + 1) THEN d.t_back_ns END AS t_done_ns,
        c.last_id, c.to_lanelet_id, a.s_m AS from_s_m, y.s_m AS to_s_m
    FROM crossing_step c
    LEFT JOIN change_begin b USING (drive_id, ego_id, t_ns)
    LEFT JOIN change_end d USING (drive_id, ego_id, t_ns)
    JOIN ego_corridor a ON a.drive_id = c.drive_id AND a.ego_id = c.ego_id AND a.chain_id = c.from_chain_id AND a.t_ns = c.t_ns
    JOIN ego_corridor y ON y.drive_id = c.drive_id AND y.ego_id = c.ego_id AND y.chain_id = c.to_chain_id AND y.t_ns = c.t_ns
),
unfinished_change AS (
    SELECT
        x.drive_id, x.ego_id, x.chain_id AS from_chain_id, NULL::INTEGER AS to_chain_id, x.side, x.t0_ns AS t_start_ns, x.begin_seen,
        NULL::BIGINT AS t_cross_ns, x.t_end_ns AS t_own_lane_ns, x.t_end_ns AS t_new_lane_ns, NULL::BIGINT AS t_done_ns, e.lanelet_id AS last_id, NULL::VARCHAR AS to_lanelet_id,
        NULL::DOUBLE AS from_s_m, NULL::DOUBLE AS to_s_m
    FROM unfinished_excursion x
    JOIN ego_state e ON e.drive_id = x.drive_id AND e.ego_id = x.ego_id AND e.t_ns = x.t0_ns AND e.chain_id = x.chain_id
    JOIN data_log g ON g.drive_id = x.drive_id
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = e.lanelet_id
    JOIN lanelet b ON b.environment_id = g.environment_id AND b.drivable
        AND b.lanelet_id = CASE x.side WHEN 1 THEN n.left_id ELSE n.right_id END
    ANTI JOIN change_begin s ON s.drive_id = x.drive_id AND s.ego_id = x.ego_id AND s.x.t0_ns = x.t0_ns
    WHERE NOT CASE x.side WHEN 1 THEN n.left_against ELSE n.right_against END
),
change AS MATERIALIZED (
    SELECT
        w.*, (row_number() OVER (PARTITION BY w.drive_id, w.ego_id ORDER BY w.t_start_ns, w.side) - 1)::INTEGER AS occurrence,
        g.environment_id, coalesce(CASE WHEN e.chain_id = w.from_chain_id THEN e.lanelet_id END, w.last_id) AS from_lanelet_id,
        e.speed_mps AS ego_speed_mps, e.s_m, e.front_s_m, e.rear_s_m, st.seg, b.t_ns AS t_before_ns,
        -- Whether the new lane is already the running lane of that step. Otherwise it is beside the old lane.
        coalesce(e.chain_id = w.to_chain_id, false) AS is_in_new_lane
    FROM (SELECT * FROM crossed_change UNION ALL BY NAME SELECT * FROM unfinished_change) w
    JOIN data_log g ON g.drive_id = w.drive_id
    JOIN ego_state e ON e.drive_id = w.drive_id AND e.ego_id = w.ego_id AND e.t_ns = w.t_start_ns
    JOIN step st ON st.drive_id = w.drive_id AND st.ego_id = w.ego_id AND st.t_ns = w.t_start_ns
    LEFT JOIN step b ON b.drive_id = w.drive_id AND b.ego_id = w.ego_id AND b.k = st.k - 1 AND b.seg = st.seg
),
new_lane_width AS (
    SELECT c.drive_id, c.ego_id, c.occurrence, b.width_m
    FROM change c
    JOIN lanelet n ON n.environment_id = c.environment_id AND n.lanelet_id = c.from_lanelet_id
    JOIN lanelet b ON b.environment_id = c.environment_id
        AND b.lanelet_id = coalesce(c.to_lanelet_id, CASE c.side WHEN 1 THEN n.left_id ELSE n.right_id END)
),
object_at_start AS MATERIALIZED (
    SELECT
        c.drive_id, c.ego_id, c.occurrence, p.object_id, p.speed_mps, p.s_m > c.s_m AS centre_ahead,
        p.rear_s_m - c.front_s_m AS ahead_gap_m, c.rear_s_m - p.front_s_m AS behind_gap_m, p.heading_diff_rad,
        is_vehicle(p.actor_class) IS NOT DISTINCT FROM true AS vehicle
    FROM change c
    JOIN new_lane_width w USING (drive_id, ego_id, occurrence)
    JOIN pair p ON p.drive_id = c.drive_id AND p.ego_id = c.ego_id AND p.t_ns = c.t_start_ns
    WHERE (may_be_vehicle(p.actor_class) OR p.actor_class = 'object' AND p.s_m > c.s_m)
        AND CASE
            WHEN c.is_in_new_lane THEN in_lane(p.d_m, p.lat_half_m, p.half_width_m)
            ELSE in_lane(c.side * p.d_m - p.half_width_m - w.width_m / 2, p.lat_half_m, w.width_m / 2)
        END
),
-- The position of the same object at the step before the change, and at the two steps between which the ego's centre crosses the line.
later_place AS (
    SELECT
        o.drive_id, o.ego_id, o.occurrence, o.object_id, v.moment, p.s_m > e.s_m AS centre_ahead, p.rear_s_m > e.front_s_m AS clear_ahead,
        e.rear_s_m - p.front_s_m AS behind_gap_m
    FROM object_at_start o
    JOIN change c USING (drive_id, ego_id, occurrence)
    CROSS JOIN LATERAL (VALUES ('before', c.t_before_ns), ('own_lane', c.t_own_lane_ns), ('new_lane', c.t_new_lane_ns)) AS v(moment, t_ns)
    JOIN pair p ON p.drive_id = o.drive_id AND p.ego_id = o.ego_id AND p.object_id = o.object_id AND p.t_ns = v.t_ns
    JOIN ego_state e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.t_ns = v.t_ns
),
-- An object with its centre ahead of the ego's at the start counts as ahead only if the ego can move in behind it. That is, its rear is
-- clear of the ego's front when the ego's centre crosses the line. Else it counts as behind, because the ego changes lanes into it. The
-- order is not known (behind is NULL) if it changes between two samples.
object_in_new_lane AS MATERIALIZED (
    SELECT
        o.*, b.behind_gap_m AS behind_gap_before_m,
        CASE
            WHEN NOT o.centre_ahead THEN true
            WHEN o.ahead_gap_m <= 0 AND NOT n.clear_ahead THEN true
            WHEN o.ahead_gap_m <= 0 AND (n.clear_ahead IS NULL OR w.clear_ahead IS DISTINCT FROM true) OR NOT b.centre_ahead THEN NULL
            ELSE false
        END AS behind
    FROM object_at_start o
    LEFT JOIN later_place b ON b.drive_id = o.drive_id AND b.ego_id = o.ego_id AND b.occurrence = o.occurrence AND b.object_id = o.object_id AND b.moment = 'before'
    LEFT JOIN later_place w ON w.drive_id = o.drive_id AND w.ego_id = o.ego_id AND w.occurrence = o.occurrence AND w.object_id = o.object_id AND w.moment = 'own_lane'
    LEFT JOIN later_place n ON n.drive_id = o.drive_id AND n.ego_id = o.ego_id AND n.occurrence = o.occurrence AND n.object_id = o.object_id AND n.moment = 'new_lane'
),
leader AS (
    SELECT drive_id, ego_id, occurrence, min({'gap_m': ahead_gap_m, 'object_id': object_id, 'speed_mps': speed_mps}) AS nearest
    FROM object_in_new_lane
    WHERE vehicle AND centre_ahead AND (abs(heading_diff_rad) < 2 * pi() / 3 OR speed_mps <= standing_mps())
    GROUP BY ALL
),
follower AS (
    SELECT drive_id, ego_id, occurrence, min({'gap_m': behind_gap_m, 'object_id': object_id, 'speed_mps': speed_mps, 'gap_before_m': behind_gap_before_m}) AS nearest
    FROM object_in_new_lane
    WHERE vehicle AND behind AND abs(heading_diff_rad) < pi() / 2
    GROUP BY ALL
),
-- The follower's speed in the 4 s after the start of the change.
follower_step AS (
    SELECT
        c.drive_id, c.ego_id, c.occurrence, st.t_ns, st.seg = c.seg AS is_same_seg, p.speed_mps,
        first_value({'t_ns': st.t_ns, 'speed_mps': p.speed_mps}) OVER (
            PARTITION BY c.drive_id, c.ego_id, c.occurrence ORDER BY st.t_ns RANGE BETWEEN 500_000_000 PRECEDING AND CURRENT ROW
        ) AS earlier
    FROM change c
    JOIN follower f USING (drive_id, ego_id, occurrence)
    JOIN step st ON st.drive_id = c.drive_id AND st.ego_id = c.ego_id AND st.t_ns >= c.t_start_ns AND st.t_ns <= c.t_start_ns + 4_000_000_000
    LEFT JOIN (
        SELECT q.drive_id, q.ego_id, q.t_ns, q.object_id, q.speed_mps
        FROM pair q SEMI JOIN follower f ON f.drive_id = q.drive_id AND f.ego_id = q.ego_id AND f.nearest.object_id = q.object_id
        WHERE q.x_m IS NOT NULL
    ) p ON p.drive_id = c.drive_id AND p.ego_id = c.ego_id AND p.t_ns = st.t_ns AND p.object_id = f.nearest.object_id
),
follower_braking AS (
    SELECT
        w.drive_id, w.ego_id, w.occurrence,
        max(1e9 * (w.earlier.speed_mps - w.speed_mps) / (w.t_ns - w.earlier.t_ns)) FILTER (w.t_ns - w.earlier.t_ns >= 400_000_000) AS decel_mps2,
        bool_and(w.is_same_seg AND w.speed_mps IS NOT NULL) AND max(w.t_ns) > min(w.t_ns) + 4_000_000_000 - max(k.max_gap_ns) AS whole_course
    FROM follower_step w
    JOIN clock k USING (drive_id, ego_id)
    GROUP BY ALL
),
-- A change is a merge if the old lane only leads onto the new one: by its type, or because it ends and the new lane continues.
chain_end AS (
    SELECT c.drive_id, c.ego_id, c.chain_id, max(c.s_start_m + c.length_m) AS end_m, max({'seq': c.seq, 'id': c.lanelet_id}).id AS last_id
    FROM chain c
    GROUP BY ALL
),
-- It is also a merge if the two lanes become one and the old lane narrows to nothing: just before the merge, it is less than half as wide
-- as the new lane.
lane_merge AS (
    SELECT c.drive_id, c.ego_id, c.occurrence, min({'s_m': a.s_start_m, 'from_seq': a.seq, 'to_seq': b.seq}) AS merge_place
    FROM change c
    JOIN chain a ON a.drive_id = c.drive_id AND a.ego_id = c.ego_id AND a.chain_id = c.from_chain_id
    JOIN chain b ON b.drive_id = c.drive_id AND b.ego_id = c.ego_id AND b.chain_id = c.to_chain_id AND b.lanelet_id = a.lanelet_id
    WHERE a.s_start_m >= c.from_s_m AND a.s_start_m < c.from_s_m + 500 AND b.s_start_m >= c.to_s_m
    GROUP BY ALL
),
last_point AS (
    SELECT environment_id, lanelet_id, max({'k': k, 'half_width_m': half_width_m}).half_width_m AS half_width_m FROM lane_point GROUP BY ALL
),
width_ratio AS (
    SELECT j.drive_id, j.ego_id, j.occurrence, p.half_width_m / nullif(q.half_width_m, 0) AS ratio
    FROM lane_merge j
    JOIN change c USING (drive_id, ego_id, occurrence)
    JOIN chain a ON a.drive_id = c.drive_id AND a.ego_id = c.ego_id AND a.chain_id = c.from_chain_id AND a.seq = j.merge_place.from_seq - 1
    JOIN chain b ON b.drive_id = c.drive_id AND b.ego_id = c.ego_id AND b.chain_id = c.to_chain_id AND b.seq = j.merge_place.to_seq - 1
    JOIN last_point p ON p.environment_id = c.environment_id AND p.lanelet_id = a.lanelet_id
    JOIN last_point q ON q.environment_id = c.environment_id AND q.lanelet_id = b.lanelet_id
),
-- Restricted ground is level with the lanes, but has no chain. If the ego drives on it and then comes into a lane, only the end of the
-- change is known.
restricted_step AS (
    SELECT
        st.drive_id, st.ego_id, st.k, st.t_ns, st.seg, e.lanelet_id, a.aside_id, e.speed_mps, x.d_m,
        sum((a.aside_id IS NULL)::INTEGER) OVER (PARTITION BY st.drive_id, st.ego_id ORDER BY st.k) AS run_no
    FROM step st
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    LEFT JOIN step_on_restricted_ground a USING (drive_id, ego_id, t_ns)
    LEFT JOIN ego_corridor x ON x.drive_id = e.drive_id AND x.ego_id = e.ego_id AND x.chain_id = e.chain_id AND x.t_ns = e.t_ns
),
restricted_stretch AS (
    SELECT drive_id, ego_id, seg, max(k) AS k_last, min({'k': k, 'lanelet_id': aside_id}).lanelet_id AS from_lanelet_id
    FROM restricted_step
    SEMI JOIN step_on_restricted_ground g ON g.drive_id = restricted_step.drive_id AND g.ego_id = restricted_step.ego_id
    WHERE aside_id IS NOT NULL
    GROUP BY drive_id, ego_id, seg, run_no
    HAVING max(t_ns) - min(t_ns) >= 2_000_000_000 AND min(speed_mps) > standing_mps()
),
change_from_restricted AS (
    SELECT r.drive_id, r.ego_id, n.t_ns, CASE WHEN n.d_m < 0 THEN 'left' ELSE 'right' END AS side, r.from_lanelet_id, n.lanelet_id AS to_lanelet_id, n.speed_mps
    FROM restricted_stretch r
    JOIN restricted_step n ON n.drive_id = r.drive_id AND n.ego_id = r.ego_id AND n.k = r.k_last + 1 AND n.seg = r.seg
    WHERE n.lanelet_id IS NOT NULL
),
uncertain_object AS (
    SELECT drive_id, ego_id, t_ns, min(least_m) AS near_m, min(least_m) FILTER (ahead IS DISTINCT FROM true) AS behind_m
    FROM (
        SELECT drive_id, ego_id, t_ns, least_m, ahead FROM hidden WHERE vehicle
        UNION ALL
        SELECT drive_id, ego_id, t_start_ns, greatest(ahead_gap_m, behind_gap_m), NOT behind FROM object_in_new_lane JOIN change USING (drive_id, ego_id, occurrence)
        WHERE NOT vehicle OR behind IS NULL AND abs(heading_diff_rad) < pi() / 2
    )
    GROUP BY ALL
)
SELECT
    c.drive_id, c.ego_id, c.occurrence, c.t_start_ns, c.begin_seen, c.t_cross_ns, c.t_done_ns,
    CASE c.side WHEN 1 THEN 'left' ELSE 'right' END AS side, c.from_lanelet_id, c.to_lanelet_id,
    CASE
        WHEN n.lane_type IN ('entry', 'onRamp', 'connectingRamp') THEN true
        WHEN j.merge_place IS NOT NULL THEN CASE WHEN r.ratio < 0.5 THEN true WHEN r.ratio > 2 OR r.ratio IS NULL THEN false END
        WHEN c.to_chain_id IS NOT NULL THEN a.ahead_id IS NULL AND f.end_m - c.from_s_m < 500 AND t.end_m - c.to_s_m > f.end_m - c.from_s_m + 20
    END AS merge,
    c.ego_speed_mps, l.nearest.object_id AS leader_id, l.nearest.gap_m AS leader_gap_m, l.nearest.speed_mps AS leader_speed_mps,
    b.nearest.object_id AS follower_id, b.nearest.gap_m AS follower_gap_m, b.nearest.gap_before_m AS follower_gap_before_m, b.nearest.speed_mps AS follower_speed_mps,
    CASE WHEN s.whole_course THEN s.decel_mps2 END AS follower_decel_mps2,
    c.front_s_m IS NOT NULL AND coalesce(d.near_m >= lane_change_near_m(), true) AS known,
    CASE WHEN c.front_s_m IS NOT NULL THEN coalesce(d.behind_m, 'inf'::DOUBLE) END AS unseen_m
FROM change c
LEFT JOIN leader l USING (drive_id, ego_id, occurrence)
LEFT JOIN follower b USING (drive_id, ego_id, occurrence)
LEFT JOIN follower_braking s USING (drive_id, ego_id, occurrence)
LEFT JOIN lane_merge j USING (drive_id, ego_id, occurrence)
LEFT JOIN width_ratio r USING (drive_id, ego_id, occurrence)
LEFT JOIN lanelet n ON n.environment_id = c.environment_id AND n.lanelet_id = c.from_lanelet_id
LEFT JOIN chain_end f ON f.drive_id = c.drive_id AND f.ego_id = c.ego_id AND f.chain_id = c.from_chain_id
LEFT JOIN chain_end t ON t.drive_id = c.drive_id AND t.ego_id = c.ego_id AND t.chain_id = c.to_chain_id
LEFT JOIN lane_next a ON a.environment_id = c.environment_id AND a.lanelet_id = f.last_id
LEFT JOIN uncertain_object d ON d.drive_id = c.drive_id AND d.ego_id = c.ego_id AND d.t_ns = c.t_start_ns
UNION ALL BY NAME
SELECT
    r.drive_id, r.ego_id,
    (coalesce(n.n_changes, 0) + row_number() OVER (PARTITION BY r.drive_id, r.ego_id ORDER BY r.t_ns) - 1)::INTEGER AS occurrence,
    r.t_ns AS t_start_ns, false AS begin_seen, r.t_ns AS t_cross_ns, r.side, r.from_lanelet_id, r.to_lanelet_id, r.speed_mps AS ego_speed_mps, false AS known
FROM change_from_restricted r
LEFT JOIN (SELECT drive_id, ego_id, count(*) AS n_changes FROM change GROUP BY ALL) n USING (drive_id, ego_id)
