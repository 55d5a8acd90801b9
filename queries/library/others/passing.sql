-- Passings: the ego and another road user with the same direction change their order, measured from front bumper to front bumper. Steps
-- without the other's position on the corridor, and holes, are bridged: the order has changed, but the stretch was not completely seen. If
-- the order before or after is not known either, and the two may have been beside each other, the order may have changed.
-- lifetime: part
CREATE TABLE passing (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the passing, from 0, in time order: the ego and another road user of the same direction change their order, or a vehicle without a known position may have
    object_id VARCHAR NOT NULL,       -- the other road user
    actor_class VARCHAR,              -- [actor_class] see road_user {class}
    ego_passes BOOLEAN,               -- true: the ego's front got ahead of the other's by more than 0.25 m; false: the other's front got ahead; NULL: the other may be beside the ego, and it is not known whether the order changed {position}
    t_ns BIGINT NOT NULL,             -- first step in the new order; if ego_passes is NULL, the last step at which the other may be beside the ego
    t_unseen_ns BIGINT,               -- last step in the old order, if the order may have changed unseen since then; if ego_passes is NULL, the first step at which the other may be beside the ego; NULL: the order changed at t_ns {position}
    t_from_ns BIGINT NOT NULL,        -- first step of the stretch around t_ns in which the two are beside each other {position}
    t_to_ns BIGINT NOT NULL,          -- last step of this stretch {position}
    side VARCHAR,                     -- [side] the side of the ego on which the other is; NULL: ego_passes is NULL {position}
    gap_m DOUBLE,                     -- least gap across the corridor from t_from_ns to t_to_ns; NULL: no step was seen at which the two are beside each other {position, heading, size}
    whole BOOLEAN NOT NULL,           -- the stretch was completely seen, from before its first step until after its last, without a hole; false: gap_m is only the least gap that was seen {position}
    same_lane BOOLEAN,                -- the other's centre is in the ego's running lane at t_ns: the ego passes round it; NULL: ego_passes is NULL {position}
    ego_speed_mps DOUBLE,             -- speed of the ego at t_ns {velocity}
    speed_mps DOUBLE                  -- speed of the other at t_ns; standing: at most 0.5 {velocity}
);

INSERT INTO passing BY NAME
WITH
-- Steps at which the ego itself has no position on the corridor are bridged, too.
ego_place_step AS (
    SELECT drive_id, ego_id, t_ns, row_number() OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns) AS ego_step_no FROM ego_state WHERE front_s_m IS NOT NULL
),
neighbour_step AS (
    SELECT drive_id, ego_id, object_id, actor_class, t_ns, k, seg, ego_step_no, true AS is_placed, ahead_m, gap_ahead_m <= 0 AND gap_behind_m <= 0 AS is_beside,
        gap_m, side, abs(d_m) < half_width_m AS same_lane, abs(heading_diff_rad) < pi() / 2 AS along, ego_speed_mps, speed_mps
    FROM neighbour
    JOIN ego_place_step USING (drive_id, ego_id, t_ns)
    UNION ALL BY NAME
    SELECT h.drive_id, h.ego_id, h.object_id, h.t_ns, st.k, st.seg, o.ego_step_no, false AS is_placed, false AS is_beside
    FROM hidden h
    SEMI JOIN neighbour n ON n.drive_id = h.drive_id AND n.ego_id = h.ego_id AND n.object_id = h.object_id
    JOIN step st ON st.drive_id = h.drive_id AND st.ego_id = h.ego_id AND st.t_ns = h.t_ns
    JOIN ego_place_step o ON o.drive_id = h.drive_id AND o.ego_id = h.ego_id AND o.t_ns = h.t_ns
),
order_step AS (
    SELECT
        *,
        CASE WHEN ahead_m > order_change_m() THEN 1 WHEN ahead_m < -order_change_m() THEN -1 END AS front_order,
        ego_step_no - row_number() OVER w AS run_no, lag(k) OVER w = k - 1 AND lag(seg) OVER w = seg AND lag(is_placed) OVER w AND is_placed AS is_joined,
        lag(is_beside) OVER w AS was_beside,
        lead(k) OVER w = k + 1 AND lead(seg) OVER w = seg AND lead(is_placed) OVER w AS is_continued
    FROM neighbour_step
    WINDOW w AS (PARTITION BY drive_id, ego_id, object_id ORDER BY k)
),
numbered_step AS (
    SELECT
        *,
        -- Every step that does not continue a stretch beside each other begins a new stretch.
        sum((NOT coalesce(is_beside AND was_beside AND is_joined, false))::INTEGER)
            OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY k ROWS UNBOUNDED PRECEDING) AS n,
        last_value(CASE WHEN front_order IS NOT NULL THEN {'front_order': front_order, 't_ns': t_ns, 'part_no': part_no} END IGNORE NULLS)
            OVER (PARTITION BY drive_id, ego_id, object_id, run_no ORDER BY k ROWS BETWEEN UNBOUNDED PRECEDING AND 1 PRECEDING) AS earlier_order
    FROM (
        SELECT *, sum((NOT coalesce(is_joined, false))::INTEGER) OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY k ROWS UNBOUNDED PRECEDING) AS part_no
        FROM order_step
    )
),
beside_stretch AS (
    SELECT
        drive_id, ego_id, object_id, n, min(t_ns) AS t_from_ns, max(t_ns) AS t_to_ns, min(gap_m) AS gap_m,
        min({'k': k, 'seen': coalesce(is_joined, false)}).seen AND max({'k': k, 'seen': coalesce(is_continued, false)}).seen AS whole
    FROM numbered_step
    WHERE is_beside
    GROUP BY ALL
),
order_change AS (
    SELECT
        c.drive_id, c.ego_id, c.object_id, c.actor_class, c.front_order < 0 AS ego_passes, c.t_ns, CASE WHEN c.part_no > c.earlier_order.part_no THEN c.earlier_order.t_ns END AS t_unseen_ns,
        coalesce(s.t_from_ns, c.t_ns) AS t_from_ns, coalesce(s.t_to_ns, c.t_ns) AS t_to_ns,
        c.side, s.gap_m, coalesce(s.whole, false) AS whole, c.same_lane, c.ego_speed_mps, c.speed_mps
    FROM numbered_step c
    LEFT JOIN (SELECT *, true AS is_beside FROM beside_stretch) s USING (drive_id, ego_id, object_id, n, is_beside)
    WHERE c.front_order <> c.earlier_order.front_order AND c.along
),
-- Vehicles that may be beside the ego in consecutive steps.
possibly_beside_stretch AS (
    SELECT drive_id, ego_id, object_id, actor_class, min(t_ns) AS t_from_ns, max(t_ns) AS t_to_ns
    FROM (
        SELECT b.*, st.k - row_number() OVER (PARTITION BY b.drive_id, b.ego_id, b.object_id ORDER BY st.k) AS run_no
        FROM beside b
        JOIN step st USING (drive_id, ego_id, t_ns)
        WHERE b.gap_m IS NULL AND may_be_vehicle(b.actor_class)
    )
    GROUP BY drive_id, ego_id, object_id, actor_class, run_no
),
placed_step AS (
    SELECT p.drive_id, p.ego_id, p.object_id, p.t_ns, p.front_s_m > e.front_s_m AS ahead, abs(p.heading_diff_rad) < pi() / 2 AS along
    FROM (SELECT DISTINCT drive_id, ego_id, object_id FROM possibly_beside_stretch) u
    JOIN pair p USING (drive_id, ego_id, object_id)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    WHERE p.front_s_m IS NOT NULL AND e.front_s_m IS NOT NULL
),
possible_change AS (
    SELECT u.drive_id, u.ego_id, u.object_id, u.actor_class, u.t_to_ns AS t_ns, u.t_from_ns AS t_unseen_ns, u.t_from_ns, u.t_to_ns, false AS whole
    FROM possibly_beside_stretch u
    ASOF LEFT JOIN placed_step b ON b.drive_id = u.drive_id AND b.ego_id = u.ego_id AND b.object_id = u.object_id AND b.t_ns <= u.t_from_ns
    ASOF LEFT JOIN placed_step a ON a.drive_id = u.drive_id AND a.ego_id = u.ego_id AND a.object_id = u.object_id AND a.t_ns >= u.t_to_ns
    ANTI JOIN order_change c ON c.drive_id = u.drive_id AND c.ego_id = u.ego_id AND c.object_id = u.object_id AND c.t_ns > b.t_ns AND c.t_ns <= a.t_ns
    WHERE b.ahead = a.ahead IS DISTINCT FROM true AND coalesce(b.along, a.along, true)
)
SELECT
    *,
    (row_number() OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns, object_id, ego_passes) - 1)::INTEGER AS occurrence
FROM (SELECT * FROM order_change UNION ALL BY NAME SELECT * FROM possible_change)
