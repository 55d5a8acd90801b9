-- Where the ego and another road user that heads the same way change their order, fronts against fronts. Steps at which the other has no
-- place, and holes, are bridged: the order has changed all the same, but the stretch was not seen whole. Where the order before or after is
-- not known either, and the two may have been beside each other, it may have changed.
WITH
-- steps without a place of the ego's own are bridged too
own AS (
    SELECT drive_id, ego_id, t_ns, row_number() OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns) AS n_own FROM ego_state WHERE front_s_m IS NOT NULL
),
met AS (
    SELECT drive_id, ego_id, object_id, actor_class, t_ns, k, seg, n_own, true AS placed, ahead_m, gap_ahead_m <= 0 AND gap_behind_m <= 0 AS over,
        gap_m, side, abs(d_m) < half_width_m AS same_lane, abs(heading_diff_rad) < pi() / 2 AS along, ego_speed_mps, speed_mps
    FROM neighbour
    JOIN own USING (drive_id, ego_id, t_ns)
    UNION ALL BY NAME
    SELECT h.drive_id, h.ego_id, h.object_id, h.t_ns, st.k, st.seg, o.n_own, false AS placed, false AS over
    FROM hidden h
    SEMI JOIN neighbour n ON n.drive_id = h.drive_id AND n.ego_id = h.ego_id AND n.object_id = h.object_id
    JOIN step st ON st.drive_id = h.drive_id AND st.ego_id = h.ego_id AND st.t_ns = h.t_ns
    JOIN own o ON o.drive_id = h.drive_id AND o.ego_id = h.ego_id AND o.t_ns = h.t_ns
),
ordered AS (
    SELECT
        *,
        CASE WHEN ahead_m > order_m() THEN 1 WHEN ahead_m < -order_m() THEN -1 END AS rank,
        n_own - row_number() OVER w AS run, lag(k) OVER w = k - 1 AND lag(seg) OVER w = seg AND lag(placed) OVER w AND placed AS joined,
        lag(over) OVER w AS over_before,
        lead(k) OVER w = k + 1 AND lead(seg) OVER w = seg AND lead(placed) OVER w AS goes_on
    FROM met
    WINDOW w AS (PARTITION BY drive_id, ego_id, object_id ORDER BY k)
),
numbered AS (
    SELECT
        *,
        -- a stretch beside each other begins with every step that does not go on from one
        sum((NOT coalesce(over AND over_before AND joined, false))::INTEGER)
            OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY k ROWS UNBOUNDED PRECEDING) AS n,
        last_value(CASE WHEN rank IS NOT NULL THEN {'rank': rank, 't_ns': t_ns, 'parts': parts} END IGNORE NULLS)
            OVER (PARTITION BY drive_id, ego_id, object_id, run ORDER BY k ROWS BETWEEN UNBOUNDED PRECEDING AND 1 PRECEDING) AS was
    FROM (
        SELECT *, sum((NOT coalesce(joined, false))::INTEGER) OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY k ROWS UNBOUNDED PRECEDING) AS parts
        FROM ordered
    )
),
stretch AS (
    SELECT
        drive_id, ego_id, object_id, n, min(t_ns) AS t_from_ns, max(t_ns) AS t_to_ns, min(gap_m) AS gap_m,
        min({'k': k, 'seen': coalesce(joined, false)}).seen AND max({'k': k, 'seen': coalesce(goes_on, false)}).seen AS whole
    FROM numbered
    WHERE over
    GROUP BY ALL
),
changed AS (
    SELECT
        c.drive_id, c.ego_id, c.object_id, c.actor_class, c.rank < 0 AS ego_passes, c.t_ns, CASE WHEN c.parts > c.was.parts THEN c.was.t_ns END AS t_unseen_ns,
        coalesce(s.t_from_ns, c.t_ns) AS t_from_ns, coalesce(s.t_to_ns, c.t_ns) AS t_to_ns,
        c.side, s.gap_m, coalesce(s.whole, false) AS whole, c.same_lane, c.ego_speed_mps, c.speed_mps
    FROM numbered c
    LEFT JOIN (SELECT *, true AS over FROM stretch) s USING (drive_id, ego_id, object_id, n, over)
    WHERE c.rank <> c.was.rank AND c.along
),
-- who may be beside the ego in steps on end
unseen AS (
    SELECT drive_id, ego_id, object_id, actor_class, min(t_ns) AS t_from_ns, max(t_ns) AS t_to_ns
    FROM (
        SELECT b.*, st.k - row_number() OVER (PARTITION BY b.drive_id, b.ego_id, b.object_id ORDER BY st.k) AS run
        FROM beside b
        JOIN step st USING (drive_id, ego_id, t_ns)
        WHERE b.gap_m IS NULL AND may_be_vehicle(b.actor_class)
    )
    GROUP BY drive_id, ego_id, object_id, actor_class, run
),
seen AS (
    SELECT p.drive_id, p.ego_id, p.object_id, p.t_ns, p.front_s_m > e.front_s_m AS ahead, abs(p.heading_diff_rad) < pi() / 2 AS along
    FROM (SELECT DISTINCT drive_id, ego_id, object_id FROM unseen) u
    JOIN pair p USING (drive_id, ego_id, object_id)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    WHERE p.front_s_m IS NOT NULL AND e.front_s_m IS NOT NULL
),
doubt AS (
    SELECT u.drive_id, u.ego_id, u.object_id, u.actor_class, u.t_to_ns AS t_ns, u.t_from_ns AS t_unseen_ns, u.t_from_ns, u.t_to_ns, false AS whole
    FROM unseen u
    ASOF LEFT JOIN seen b ON b.drive_id = u.drive_id AND b.ego_id = u.ego_id AND b.object_id = u.object_id AND b.t_ns <= u.t_from_ns
    ASOF LEFT JOIN seen a ON a.drive_id = u.drive_id AND a.ego_id = u.ego_id AND a.object_id = u.object_id AND a.t_ns >= u.t_to_ns
    ANTI JOIN changed c ON c.drive_id = u.drive_id AND c.ego_id = u.ego_id AND c.object_id = u.object_id AND c.t_ns > b.t_ns AND c.t_ns <= a.t_ns
    WHERE b.ahead = a.ahead IS DISTINCT FROM true AND coalesce(b.along, a.along, true)
)
SELECT
    *,
    (row_number() OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns, object_id, ego_passes) - 1)::INTEGER AS occurrence
FROM (SELECT * FROM changed UNION ALL BY NAME SELECT * FROM doubt)
