-- A vehicle cuts in if it comes from beside into the running lane ahead of the ego: from at most 0.05 m inside the lane to more than 0.3 m,
-- along the lane (within 45 degrees), at most 150 m ahead. A vehicle that is in the ego's lane because the ego changed lanes does not cut
-- in. If the vehicle is not seen while it crosses the line, t_ns is the first step at which it is seen in the lane. A vehicle that
-- overtakes the ego and is over the line when it gets ahead cuts in when it becomes the nearest vehicle ahead. If it is not known for a
-- second which vehicle is ahead, a vehicle may have cut in.
-- lifetime: part
CREATE TABLE cut_in (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the cut-in, from 0, in time order: another vehicle moves from beside into the running lane ahead of the ego. Also a stretch of a second or longer in which it is not known which vehicle is ahead: a vehicle may have cut in
    object_id VARCHAR,                -- the vehicle that cuts in; NULL: a vehicle may have cut in; of the other columns, only ego_speed_mps (the highest) and free_m may then be known
    t_ns BIGINT NOT NULL,             -- first step with its box more than 0.3 m inside the running lane, coming from at most 0.05 m; within 45 degrees of the lane, at most 150 m ahead. Of a vehicle that overtook the ego and was already further inside: first step as the nearest vehicle ahead (lead.joined). If object_id is NULL, the first unknown step
    begin_seen BOOLEAN NOT NULL,      -- the step before exists, and the vehicle's position is known there: else it may have come in earlier {position}
    side VARCHAR,                     -- [side] the side from which the vehicle came {position}
    gap_m DOUBLE,                     -- distance from the ego's front to the vehicle's rear at t_ns, along the corridor {position, heading, size}
    ego_speed_mps DOUBLE,             -- speed of the ego at t_ns {velocity}
    speed_mps DOUBLE,                 -- speed of the vehicle at t_ns {velocity}
    in_place_ns BIGINT,               -- first step with the vehicle's centre in the running lane; NULL: never {position}
    free_m DOUBLE                     -- if object_id is NULL: distance ahead within which no vehicle is at any of these steps; NULL: not known {position, heading, size}
);

INSERT INTO cut_in BY NAME
WITH ahead AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, st.k, st.seg, p.object_id, e.chain_id, p.rear_s_m - e.front_s_m AS gap_m, e.speed_mps AS ego_speed_mps,
        p.speed_mps, p.d_m, abs(p.d_m) < p.half_width_m AS is_centre_in, p.half_width_m + p.lat_half_m - abs(p.d_m) AS inside_m,
        abs(p.heading_diff_rad) < pi() / 4 AS is_along
    FROM pair p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    JOIN step st USING (drive_id, ego_id, t_ns)
    WHERE is_vehicle(p.actor_class) AND p.front_s_m > e.front_s_m AND p.rear_s_m - e.front_s_m <= 150
        AND abs(p.heading_diff_rad) < pi() / 2 AND abs(p.d_m) < 10
),
-- A vehicle that is in the lane all the time, or never, does not cut in.
candidate_sample AS (
    SELECT a.*
    FROM ahead a
    SEMI JOIN (
        SELECT drive_id, ego_id, object_id, chain_id
        FROM ahead
        GROUP BY ALL
        HAVING min(inside_m) <= over_boundary_m() AND max(inside_m) > cut_in_m()
    ) m ON m.drive_id = a.drive_id AND m.ego_id = a.ego_id AND m.object_id = a.object_id AND m.chain_id = a.chain_id
),
-- If lanes merge or a lane begins, the centre line of the running lane jumps without any motion of a vehicle: a new run begins.
run_sample AS (
    SELECT *, sum(coalesce(has_jumped, false)::INTEGER) OVER (PARTITION BY drive_id, ego_id, object_id, chain_id ORDER BY k ROWS UNBOUNDED PRECEDING) AS run
    FROM (
        SELECT *, abs(d_m - lag(d_m) OVER w) > 0.3 + 5 * (t_ns - lag(t_ns) OVER w) / 1e9 AS has_jumped
        FROM candidate_sample
        WINDOW w AS (PARTITION BY drive_id, ego_id, object_id, chain_id ORDER BY k)
    )
),
-- last_clear: the last previous sample at which the vehicle was clearly inside or clearly outside the lane.
sample_with_last_clear_place AS (
    SELECT
        *,
        last_value(
            CASE WHEN inside_m > cut_in_m() OR inside_m <= over_boundary_m() THEN {'is_in': inside_m > cut_in_m(), 't_ns': t_ns, 'd_m': d_m} END
            IGNORE NULLS
        )
            OVER (w ROWS BETWEEN UNBOUNDED PRECEDING AND 1 PRECEDING) AS last_clear,
        lag(k) OVER w = k - 1 AND lag(seg) OVER w = seg AS joined
    FROM run_sample
    WINDOW w AS (PARTITION BY drive_id, ego_id, object_id, chain_id, run ORDER BY k)
),
cut_in_sample AS (
    SELECT
        *,
        coalesce(inside_m > cut_in_m() AND NOT last_clear.is_in AND is_along AND t_ns - last_clear.t_ns <= 5_000_000_000, false) AS begins,
        sum(((inside_m > cut_in_m() AND NOT last_clear.is_in) OR inside_m <= over_boundary_m())::INTEGER)
            OVER (PARTITION BY drive_id, ego_id, object_id, chain_id, run ORDER BY k ROWS UNBOUNDED PRECEDING) AS n
    FROM sample_with_last_clear_place
),
centre_in_lane_step AS (
    SELECT drive_id, ego_id, object_id, chain_id, run, n, min(t_ns) AS t_ns FROM cut_in_sample WHERE is_centre_in GROUP BY ALL
),
-- The least distance ahead (m) along the lane of an unseen vehicle that may be present, or of a seen actor of unknown class.
free_lane AS (
    SELECT drive_id, ego_id, t_ns, min(m) AS m
    FROM (
        SELECT drive_id, ego_id, t_ns, lane_m AS m FROM hidden WHERE vehicle AND ahead IS DISTINCT FROM false AND NOT beside_lane
        UNION ALL
        SELECT drive_id, ego_id, t_ns, gap_m FROM _lane_ahead WHERE is_vehicle(actor_class) IS DISTINCT FROM true
    )
    GROUP BY ALL
),
-- Stretches of a second or longer in which it is not known which vehicle is ahead.
blind_stretch AS (
    SELECT
        drive_id, ego_id, min(t_ns) AS t_ns, max(t_ns) AS t_to_ns,
        CASE WHEN count(free_m) = count(*) AND count(speed_mps) = count(*) THEN min(free_m) END AS free_m, max(speed_mps) AS ego_speed_mps
    FROM (
        SELECT
            st.*, e.speed_mps, CASE WHEN e.front_s_m IS NOT NULL THEN f.m END AS free_m,
            st.k - row_number() OVER (PARTITION BY st.drive_id, st.ego_id, st.seg ORDER BY st.k) AS run
        FROM step st
        JOIN ego_state e USING (drive_id, ego_id, t_ns)
        LEFT JOIN free_lane f USING (drive_id, ego_id, t_ns)
        ANTI JOIN lead l ON l.drive_id = st.drive_id AND l.ego_id = st.ego_id AND l.t_ns = st.t_ns
    )
    GROUP BY drive_id, ego_id, seg, run
    HAVING max(t_ns) - min(t_ns) >= 1_000_000_000 AND coalesce(CASE WHEN count(free_m) = count(*) THEN min(free_m) END < 150, true)
),
seen_cut_in AS (
    SELECT
        c.drive_id, c.ego_id, c.object_id, c.t_ns, coalesce(c.joined, false) AS begin_seen, CASE WHEN c.last_clear.d_m > 0 THEN 'left' ELSE 'right' END AS side,
        c.gap_m, c.ego_speed_mps, c.speed_mps, p.t_ns AS in_place_ns
    FROM cut_in_sample c
    LEFT JOIN centre_in_lane_step p USING (drive_id, ego_id, object_id, chain_id, run, n)
    WHERE c.begins
),
-- The vehicle is over the line from the moment at which its front gets ahead, and the ego stays in one lane all that time.
overtaker_cut_in AS (
    SELECT DISTINCT l.drive_id, l.ego_id, l.object_id, l.t_ns, a.chain_id
    FROM passing p
    JOIN (
        SELECT drive_id, ego_id, object_id, t_ns FROM lead WHERE joined AND t_ns = t_since_ns
    ) l ON l.drive_id = p.drive_id AND l.ego_id = p.ego_id AND l.object_id = p.object_id AND l.t_ns >= p.t_ns
    JOIN ahead a ON a.drive_id = l.drive_id AND a.ego_id = l.ego_id AND a.object_id = l.object_id AND a.t_ns = l.t_ns AND a.is_along
    ANTI JOIN ahead b ON b.drive_id = l.drive_id AND b.ego_id = l.ego_id AND b.object_id = l.object_id AND b.t_ns >= p.t_ns AND b.t_ns <= l.t_ns
        AND b.inside_m <= over_boundary_m()
    ANTI JOIN ahead d ON d.drive_id = l.drive_id AND d.ego_id = l.ego_id AND d.object_id = l.object_id AND d.t_ns >= p.t_ns AND d.t_ns <= l.t_ns
        AND d.chain_id <> a.chain_id
    ANTI JOIN seen_cut_in n ON n.drive_id = l.drive_id AND n.ego_id = l.ego_id AND n.object_id = l.object_id AND n.t_ns >= p.t_from_ns AND n.t_ns <= l.t_ns
    WHERE NOT p.ego_passes
    QUALIFY l.t_ns = min(l.t_ns) OVER (PARTITION BY p.drive_id, p.ego_id, p.occurrence)
),
any_cut_in AS (
    SELECT * FROM seen_cut_in
    UNION ALL BY NAME
    SELECT
        q.drive_id, q.ego_id, q.object_id, q.t_ns, true AS begin_seen, CASE WHEN a.d_m > e.d_m THEN 'left' ELSE 'right' END AS side,
        a.gap_m, a.ego_speed_mps, a.speed_mps, i.t_ns AS in_place_ns
    FROM overtaker_cut_in q
    JOIN ahead a USING (drive_id, ego_id, object_id, t_ns)
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    LEFT JOIN (
        SELECT q.drive_id, q.ego_id, q.object_id, q.t_ns AS t_join_ns, min(c.t_ns) AS t_ns
        FROM overtaker_cut_in q
        JOIN ahead c USING (drive_id, ego_id, object_id, chain_id)
        WHERE c.t_ns >= q.t_ns AND c.is_centre_in
        GROUP BY ALL
    ) i ON i.drive_id = q.drive_id AND i.ego_id = q.ego_id AND i.object_id = q.object_id AND i.t_join_ns = q.t_ns
    UNION ALL BY NAME
    SELECT b.drive_id, b.ego_id, b.t_ns, false AS begin_seen, b.ego_speed_mps, b.free_m
    FROM blind_stretch b
    JOIN clock c USING (drive_id, ego_id)
    -- A cut-in that is seen in this stretch, or right after it, replaces it.
    ANTI JOIN seen_cut_in n ON n.drive_id = b.drive_id AND n.ego_id = b.ego_id AND n.t_ns >= b.t_ns AND n.t_ns <= b.t_to_ns + c.max_gap_ns
)
SELECT *, (row_number() OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns, object_id) - 1)::INTEGER AS occurrence
FROM any_cut_in
