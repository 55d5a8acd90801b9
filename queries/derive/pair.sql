-- The ego and every other actor, one row per ego step from the actor's first sample to its last. A sample of another time than the
-- step's is moved on by its own velocity while it is fresh; beyond that the actor is there but not placed.
WITH track AS (SELECT drive_id, actor_id, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns FROM actor_state GROUP BY ALL),
present AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, t.actor_id AS object_id
    FROM step e
    JOIN track t ON t.drive_id = e.drive_id AND t.actor_id <> e.ego_id AND e.t_ns >= t.t_first_ns AND e.t_ns <= t.t_last_ns
),
exact AS (
    SELECT p.*, s.t_ns AS t_sample_ns, s.x_m, s.y_m, s.yaw_rad, s.speed_mps, s.accel_mps2, s.travel_m
    FROM present p
    LEFT JOIN state_dynamics s ON s.drive_id = p.drive_id AND s.actor_id = p.object_id AND s.t_ns = p.t_ns
),
held AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, p.object_id, s.t_ns AS t_sample_ns,
        s.x_m + s.vx_mps * (p.t_ns - s.t_ns) / 1e9 AS x_m, s.y_m + s.vy_mps * (p.t_ns - s.t_ns) / 1e9 AS y_m,
        s.yaw_rad, s.speed_mps, s.accel_mps2, s.travel_m
    FROM (SELECT drive_id, ego_id, t_ns, object_id FROM exact WHERE t_sample_ns IS NULL) p
    ASOF JOIN state_dynamics s ON s.drive_id = p.drive_id AND s.actor_id = p.object_id AND s.t_ns <= p.t_ns
),
sampled AS (
    SELECT * FROM exact WHERE t_sample_ns IS NOT NULL
    UNION ALL BY NAME
    SELECT h.* FROM held h JOIN clock c USING (drive_id, ego_id) WHERE h.t_ns - h.t_sample_ns <= c.max_gap_ns
    UNION ALL BY NAME
    SELECT h.drive_id, h.ego_id, h.t_ns, h.object_id FROM held h JOIN clock c USING (drive_id, ego_id) WHERE h.t_ns - h.t_sample_ns > c.max_gap_ns
),
apart AS (
    SELECT
        o.drive_id, o.ego_id, o.t_ns, o.object_id, a.actor_class, o.x_m, o.y_m, o.yaw_rad, o.speed_mps, o.accel_mps2, o.travel_m,
        a.length_m, a.width_m, e.chain_id, e.s_m AS ego_s_m, e.yaw_rad AS ego_yaw_rad, e.length_m / 2 AS hla, e.width_m / 2 AS hwa,
        a.length_m / 2 AS hlb, a.width_m / 2 AS hwb,
        o.x_m - e.x_m AS ex, o.y_m - e.y_m AS ey,
        sqrt((o.x_m - e.x_m) ** 2 + (o.y_m - e.y_m) ** 2) AS distance_m
    FROM sampled o
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    JOIN actor a ON a.drive_id = o.drive_id AND a.actor_id = o.object_id
),
bounded AS (
    SELECT *, distance_m - sqrt(hla * hla + hwa * hwa) - sqrt(hlb * hlb + hwb * hwb) AS least_m FROM apart
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
    FROM bounded
),
candidate AS (
    SELECT
        a.drive_id, a.ego_id, a.t_ns, a.object_id, a.x_m, a.y_m, a.yaw_rad, a.ego_s_m, a.hlb, a.hwb, g.*,
        along0(a.x_m, a.y_m, g.x0_m, g.y0_m, g.tx0, g.ty0) AS a0,
        along1(a.x_m, a.y_m, g.x1_m, g.y1_m, g.tx1, g.ty1) AS a1
    FROM cleared a
    JOIN corridor_cell c ON c.drive_id = a.drive_id AND c.ego_id = a.ego_id AND c.chain_id = a.chain_id AND c.cell = corridor_cell_of(a.x_m, a.y_m)
    JOIN corridor g ON g.drive_id = c.drive_id AND g.ego_id = c.ego_id AND g.chain_id = c.chain_id AND g.seq = c.seq AND g.k = c.k
    WHERE a.ego_s_m IS NOT NULL
),
placed AS (
    SELECT
        drive_id, ego_id, t_ns, object_id,
        -- of several places on a corridor that meets itself, the one nearest to the ego along it
        min({
            'off': abs(s0_m + u * len_m - ego_s_m), 's_m': s0_m + u * len_m, 'd_m': d_m, 'half_width_m': hw0_m + u * (hw1_m - hw0_m),
            'over_width_m': over_width_m, 'over_against': over_against,
            'psi': wrap_rad(yaw_rad - atan2(ty0 + u * (ty1 - ty0), tx0 + u * (tx1 - tx0)))
        }) AS p
    FROM (
        SELECT *, a0 / (a0 + a1) AS u, offset_left(x_m, y_m, a0 / (a0 + a1), x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1) AS d_m
        FROM candidate
        WHERE a0 >= -0.02 AND a1 > -0.02 AND a0 + a1 > 0
    )
    WHERE abs(d_m) <= strip_m()
    GROUP BY ALL
)
SELECT
    c.drive_id, c.ego_id, c.t_ns, c.object_id, c.actor_class, c.x_m, c.y_m, c.yaw_rad, c.speed_mps, c.accel_mps2, c.travel_m,
    c.length_m, c.width_m, c.distance_m, c.clearance_m, c.clearance_is_bound,
    p.p.s_m AS s_m, p.p.d_m AS d_m,
    p.p.s_m + c.hlb * abs(cos(p.p.psi)) + c.hwb * abs(sin(p.p.psi)) AS front_s_m,
    p.p.s_m - c.hlb * abs(cos(p.p.psi)) - c.hwb * abs(sin(p.p.psi)) AS rear_s_m,
    c.hlb * abs(sin(p.p.psi)) + c.hwb * abs(cos(p.p.psi)) AS lat_half_m,
    p.p.psi AS heading_diff_rad,
    p.p.half_width_m AS half_width_m, p.p.over_width_m AS over_width_m, p.p.over_against AS over_against
FROM cleared c
LEFT JOIN placed p USING (drive_id, ego_id, t_ns, object_id)
