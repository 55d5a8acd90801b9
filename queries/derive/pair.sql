-- The ego and every other actor, one row per ego step from the actor's first sample to its last. A sample of another time than the
-- step's is moved on by its own velocity while it is fresh; beyond that the actor is there but not placed.
WITH same_time AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, e.k, s.actor_id AS object_id, s.actor_class, s.x_m, s.y_m, s.yaw_rad, s.speed_mps, s.accel_mps2,
        s.length_m, s.width_m
    FROM step e
    JOIN state_dynamics s ON s.drive_id = e.drive_id AND s.t_ns = e.t_ns AND s.actor_id <> e.ego_id
),
track AS (
    SELECT c.drive_id, c.ego_id, s.object_id, s.t_first_ns, s.t_last_ns, s.n
    FROM clock c
    JOIN (
        SELECT drive_id, actor_id AS object_id, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns, count(*) AS n FROM state_dynamics GROUP BY ALL
    ) s ON s.drive_id = c.drive_id AND s.object_id <> c.ego_id
),
met AS (
    SELECT drive_id, ego_id, object_id, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns, max(k) - min(k) + 1 AS span, count(*) AS n
    FROM same_time
    GROUP BY ALL
),
-- only actors that miss a step, or have samples between the steps, need a closer look
ragged AS (
    SELECT t.drive_id, t.ego_id, t.object_id, t.t_first_ns, t.t_last_ns
    FROM track t
    LEFT JOIN met m USING (drive_id, ego_id, object_id)
    WHERE m.n IS NULL OR m.n <> t.n OR m.span <> m.n
),
missed AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, r.object_id
    FROM ragged r
    JOIN step e ON e.drive_id = r.drive_id AND e.ego_id = r.ego_id AND e.t_ns >= r.t_first_ns AND e.t_ns <= r.t_last_ns
    ANTI JOIN same_time s ON s.drive_id = e.drive_id AND s.ego_id = e.ego_id AND s.t_ns = e.t_ns AND s.object_id = r.object_id
),
held AS (
    SELECT m.drive_id, m.ego_id, m.t_ns, m.object_id, (m.t_ns - s.t_ns) / 1e9 AS age_s, m.t_ns - s.t_ns <= c.max_gap_ns AS fresh, s.* EXCLUDE (drive_id, actor_id, t_ns)
    FROM missed m
    JOIN clock c USING (drive_id, ego_id)
    -- sorting every track for the sake of none would cost more than all the rest
    ASOF JOIN (
        SELECT s.* FROM state_dynamics s
        SEMI JOIN ragged r ON r.drive_id = s.drive_id AND r.object_id = s.actor_id
    ) s ON s.drive_id = m.drive_id AND s.actor_id = m.object_id AND s.t_ns <= m.t_ns
),
sampled AS (
    SELECT * EXCLUDE (k) FROM same_time
    UNION ALL BY NAME
    SELECT
        drive_id, ego_id, t_ns, object_id, actor_class, length_m, width_m,
        CASE WHEN fresh THEN x_m + vx_mps * age_s END AS x_m, CASE WHEN fresh THEN y_m + vy_mps * age_s END AS y_m,
        CASE WHEN fresh THEN yaw_rad END AS yaw_rad, CASE WHEN fresh THEN speed_mps END AS speed_mps, CASE WHEN fresh THEN accel_mps2 END AS accel_mps2
    FROM held
),
apart AS MATERIALIZED (
    SELECT
        o.*, e.chain_id, e.s_m AS ego_s_m, e.yaw_rad AS ego_yaw_rad, e.length_m / 2 AS hla, e.width_m / 2 AS hwa,
        o.length_m / 2 AS hlb, o.width_m / 2 AS hwb, o.x_m - e.x_m AS ex, o.y_m - e.y_m AS ey,
        sqrt((o.x_m - e.x_m) ** 2 + (o.y_m - e.y_m) ** 2) AS distance_m,
        row_number() OVER () AS pair_no
    FROM sampled o
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
),
cleared AS (
    SELECT
        *,
        CASE
            WHEN least_m > exact_clearance_m() THEN least_m
            WHEN least_m IS NOT NULL AND yaw_rad IS NOT NULL AND ego_yaw_rad IS NOT NULL THEN box_clearance(
                ex * cos(ego_yaw_rad) + ey * sin(ego_yaw_rad), ey * cos(ego_yaw_rad) - ex * sin(ego_yaw_rad),
                cos(yaw_rad - ego_yaw_rad), sin(yaw_rad - ego_yaw_rad), hla, hwa, hlb, hwb
            )
        END AS clearance_m,
        CASE WHEN least_m IS NOT NULL THEN least_m > exact_clearance_m() END AS clearance_is_bound
    FROM (SELECT *, distance_m - sqrt(hla * hla + hwa * hwa) - sqrt(hlb * hlb + hwb * hwb) AS least_m FROM apart)
),
candidate AS (
    SELECT
        a.pair_no, a.drive_id, a.ego_id, a.chain_id, a.x_m, a.y_m, a.yaw_rad, a.ego_s_m, c.* EXCLUDE (drive_id, ego_id, cell),
        along0(a.x_m, a.y_m, c.x0_m, c.y0_m, c.tx0, c.ty0) AS a0,
        along1(a.x_m, a.y_m, c.x1_m, c.y1_m, c.tx1, c.ty1) AS a1
    FROM apart a
    JOIN corridor_cell c ON c.drive_id = a.drive_id AND c.ego_id = a.ego_id AND c.cell = corridor_cell_of(a.x_m, a.y_m)
    WHERE a.ego_s_m IS NOT NULL
),
beside AS (
    SELECT
        pair_no, drive_id, ego_id, chain_id, ego_s_m, lanelet_id, s0_m + u * len_m AS lane_s_m, d_m, hw0_m + u * (hw1_m - hw0_m) AS half_width_m,
        wrap_rad(yaw_rad - atan2(ty0 + u * (ty1 - ty0), tx0 + u * (tx1 - tx0))) AS psi
    FROM (
        SELECT *, a0 / (a0 + a1) AS u, offset_left(x_m, y_m, a0 / (a0 + a1), x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1) AS d_m
        FROM candidate
        WHERE a0 >= -slack0_m AND a1 > -slack1_m AND a0 + a1 > 0
    )
    WHERE abs(d_m) <= strip_m()
),
-- the corridor by kilometre of the ego's station: what lies within 1.2 km of it, so that a ring's other laps are not looked at
lap AS (
    SELECT *, unnest(range(floor((s_start_m - 1200) / 1000)::BIGINT, floor((s_start_m + length_m + 1200) / 1000)::BIGINT + 1)) AS bucket
    FROM corridor
),
on_chain AS MATERIALIZED (
    SELECT
        b.pair_no, c.s_start_m + b.lane_s_m AS s_m, b.d_m, b.half_width_m, b.psi, c.over_width_m, c.over_against,
        abs(c.s_start_m + b.lane_s_m - b.ego_s_m)
        -- beside the road only if it is nowhere on it: the legs of a hairpin lie in each other's strip
        + CASE WHEN abs(b.d_m) > b.half_width_m + coalesce(c.over_width_m, 2 * b.half_width_m) THEN 1e8 ELSE 0.0 END
        -- and what comes the other way is still to be met, even if the shorter way round a ring is back
        + CASE WHEN abs(b.psi) > pi() / 2 AND c.s_start_m + b.lane_s_m < b.ego_s_m - exact_clearance_m() THEN 1e6 ELSE 0.0 END AS off
    FROM beside b
    JOIN lap c ON c.drive_id = b.drive_id AND c.ego_id = b.ego_id AND c.lanelet_id = b.lanelet_id AND c.chain_id = b.chain_id
        AND c.bucket = floor(b.ego_s_m / 1000)::BIGINT
),
-- of several places on a corridor that meets itself, the one nearest to the ego along it (see above); a tie is settled by the station
least AS MATERIALIZED (SELECT pair_no, min(off) AS off FROM on_chain GROUP BY pair_no),
nearest AS MATERIALIZED (SELECT o.* FROM on_chain o JOIN least USING (pair_no, off)),
-- ties are rare: only where there are more rows than pairs it is worth looking for them
twice AS (
    SELECT pair_no FROM nearest WHERE (SELECT count(*) FROM nearest) > (SELECT count(*) FROM least) GROUP BY pair_no HAVING count(*) > 1
),
settled AS (
    SELECT
        pair_no,
        min({
            's_m': s_m, 'd_m': d_m, 'half_width_m': half_width_m, 'psi': psi, 'over_width_m': over_width_m, 'over_against': over_against
        }) AS p
    FROM nearest SEMI JOIN twice USING (pair_no)
    GROUP BY pair_no
),
placed AS (
    SELECT * EXCLUDE (off) FROM nearest ANTI JOIN twice USING (pair_no)
    UNION ALL
    SELECT pair_no, unnest(p) FROM settled
)
SELECT
    c.drive_id, c.ego_id, c.t_ns, c.object_id, c.actor_class, c.x_m, c.y_m, c.yaw_rad, c.speed_mps, c.accel_mps2,
    c.length_m, c.width_m, c.distance_m, c.clearance_m, c.clearance_is_bound,
    p.s_m AS s_m, p.d_m AS d_m,
    p.s_m + c.hlb * abs(cos(p.psi)) + c.hwb * abs(sin(p.psi)) AS front_s_m,
    p.s_m - c.hlb * abs(cos(p.psi)) - c.hwb * abs(sin(p.psi)) AS rear_s_m,
    c.hlb * abs(sin(p.psi)) + c.hwb * abs(cos(p.psi)) AS lat_half_m,
    p.psi AS heading_diff_rad,
    p.half_width_m AS half_width_m, p.over_width_m AS over_width_m, p.over_against AS over_against
FROM cleared c
LEFT JOIN placed p USING (pair_no)
