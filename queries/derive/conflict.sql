-- Where the ground that the ego's box sweeps is swept by another's as well, at an angle, not more than 10 s apart.
WITH scale AS (SELECT drive_id, max(period_s) AS period_s, max(cell_m) AS cell_m FROM meeting GROUP BY drive_id),
-- the trailer that it draws is the ego
part AS (
    SELECT drive_id, object_id AS actor_id, object_slot AS slot FROM meeting
    UNION
    SELECT o.drive_id, o.actor_id, meeting_slot(s.t_ns) FROM step s JOIN ego_actor o USING (drive_id, ego_id)
),
box AS NOT MATERIALIZED (
    SELECT
        s.drive_id, s.actor_id, s.t_ns, s.x_m, s.y_m, s.z_m, meeting_cell(s.x_m, s.y_m, g.cell_m) AS cell, meeting_slot(s.t_ns) AS slot,
        heading_step(s.travel_rad) AS heading,
        s.travel_rad AS dir_rad,
        swept_half_m(s.length_m, s.speed_mps, g.period_s) AS hl, s.width_m / 2 AS hw, cos(s.yaw_rad) AS c, sin(s.yaw_rad) AS s
    FROM state_dynamics s
    JOIN scale g USING (drive_id)
    SEMI JOIN part p ON p.drive_id = s.drive_id AND p.actor_id = s.actor_id AND p.slot = meeting_slot(s.t_ns)
    WHERE s.x_m IS NOT NULL AND s.y_m IS NOT NULL AND s.yaw_rad IS NOT NULL AND s.length_m IS NOT NULL AND s.width_m IS NOT NULL
),
ego AS MATERIALIZED (
    SELECT o.ego_id, b.* FROM box b JOIN ego_actor o USING (drive_id, actor_id) SEMI JOIN step s ON s.drive_id = b.drive_id AND s.ego_id = o.ego_id AND s.t_ns = b.t_ns
),
other AS MATERIALIZED (
    SELECT b.*
    FROM box b
    SEMI JOIN meeting m
        ON m.drive_id = b.drive_id AND m.object_id = b.actor_id AND m.object_cell = b.cell AND m.object_slot = b.slot AND m.object_heading = b.heading
),
around AS (
    SELECT cell_key(x.i, y.i) AS cell, t.i AS slot
    FROM (VALUES (-1), (0), (1)) AS x(i) CROSS JOIN (VALUES (-1), (0), (1)) AS y(i) CROSS JOIN (VALUES (-1), (0), (1)) AS t(i)
),
-- step by step, or the planner, which cannot know how few they are, would compare everybody with everybody
close AS MATERIALIZED (
    SELECT m.ego_id, m.cell AS ego_cell, m.slot AS ego_slot, m.heading AS ego_heading, o.*
    FROM meeting m
    JOIN other o ON o.drive_id = m.drive_id AND o.actor_id = m.object_id AND o.cell = m.object_cell AND o.slot = m.object_slot
        AND o.heading = m.object_heading
),
angled AS MATERIALIZED (
    SELECT o.drive_id, o.ego_id, o.actor_id AS object_id, e.t_ns AS t1, o.t_ns AS t2
    FROM close o
    JOIN ego e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.cell = o.ego_cell AND e.slot = o.ego_slot AND e.heading = o.ego_heading
    WHERE boxes_meet(o.x_m - e.x_m, o.y_m - e.y_m, e.c, e.s, o.c, o.s, e.hl, e.hw, o.hl, o.hw)
        AND same_level(o.z_m, e.z_m) AND abs(e.t_ns - o.t_ns) <= conflict_ns() AND abs(wrap_rad(o.dir_rad - e.dir_rad)) > conflict_angle_rad()
),
-- In a tight bend even a follower's box lies across the ego's of another moment: what counts is the angle against the ego's way where that
-- comes nearest.
there AS MATERIALIZED (
    SELECT b.*, a.ego_id
    FROM (SELECT DISTINCT drive_id, ego_id, object_id, t2 FROM angled) a
    JOIN other b ON b.drive_id = a.drive_id AND b.actor_id = a.object_id AND b.t_ns = a.t2
),
reached AS MATERIALIZED (SELECT b.*, b.cell + n.cell AS near_cell, b.slot + n.slot AS near_slot FROM there b CROSS JOIN around n),
met AS (
    SELECT
        o.drive_id, o.ego_id, o.actor_id AS object_id, o.t_ns AS t2,
        min({
            'd2': (o.x_m - e.x_m) ** 2 + (o.y_m - e.y_m) ** 2, 't1': e.t_ns, 't2': o.t_ns, 'angle_rad': wrap_rad(o.dir_rad - e.dir_rad)
        }) AS near
    FROM reached o
    JOIN ego e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.cell = o.near_cell AND e.slot = o.near_slot
    WHERE boxes_meet(o.x_m - e.x_m, o.y_m - e.y_m, e.c, e.s, o.c, o.s, e.hl, e.hw, o.hl, o.hw) AND same_level(o.z_m, e.z_m)
        AND abs(e.t_ns - o.t_ns) <= conflict_ns()
    GROUP BY ALL
),
shared AS MATERIALIZED (
    SELECT a.*, m.near
    FROM angled a JOIN met m USING (drive_id, ego_id, object_id, t2)
    WHERE abs(m.near.angle_rad) > conflict_angle_rad()
),
-- encounters: stretches of the ego's steps, and in each those of the other's samples
stretch AS (
    SELECT drive_id, ego_id, object_id, t1, sum((t1 - before > conflict_apart_ns())::INTEGER) OVER w AS n1
    FROM (
        SELECT *, lag(t1, 1, t1) OVER (PARTITION BY drive_id, ego_id, object_id ORDER BY t1) AS before
        FROM (SELECT DISTINCT drive_id, ego_id, object_id, t1 FROM shared)
    )
    WINDOW w AS (PARTITION BY drive_id, ego_id, object_id ORDER BY t1)
),
parted AS (
    SELECT drive_id, ego_id, object_id, p.n1, s.t2, min(t1) AS t1_first, max(t1) AS t1_last, min(near) AS near
    FROM shared s JOIN stretch p USING (drive_id, ego_id, object_id, t1)
    GROUP BY ALL
),
-- samples without a pause, and what follows soon after on the same ground (an angle that comes and goes at its edge)
piece AS (
    SELECT
        drive_id, ego_id, object_id, n1, n2, max_gap_ns, min(t1_first) AS t1_first, max(t1_last) AS t1_last, min(t2) AS t2_first, max(t2) AS t2_last,
        min({'t2': t2, 'angle_rad': near.angle_rad}) AS entry
    FROM (
        SELECT *, sum((t2 - before > max_gap_ns)::INTEGER) OVER (PARTITION BY drive_id, ego_id, object_id, n1 ORDER BY t2) AS n2
        FROM (
            SELECT p.*, c.max_gap_ns, lag(p.t2, 1, p.t2) OVER (PARTITION BY p.drive_id, p.ego_id, p.object_id, p.n1 ORDER BY p.t2) AS before
            FROM parted p JOIN clock c USING (drive_id, ego_id)
        )
    )
    GROUP BY drive_id, ego_id, object_id, n1, n2, max_gap_ns
),
encounter AS (
    SELECT
        drive_id, ego_id, object_id, min(t1_first) AS t_ego_in_ns, max(t1_last) AS t_ego_out_ns, min(t2_first) AS t_object_in_ns, max(t2_last) AS t_object_out_ns,
        min(entry).angle_rad AS angle_rad
    FROM (
        SELECT
            *,
            sum((t2_first - before.t2_last > conflict_apart_ns() OR t1_first > before.t1_last + max_gap_ns OR t1_last < before.t1_first - max_gap_ns)::INTEGER)
                OVER (PARTITION BY drive_id, ego_id, object_id, n1 ORDER BY n2) AS n
        FROM (
            SELECT
                *,
                lag({'t1_first': t1_first, 't1_last': t1_last, 't2_last': t2_last}) OVER (PARTITION BY drive_id, ego_id, object_id, n1 ORDER BY n2) AS before
            FROM piece
        )
    )
    GROUP BY drive_id, ego_id, object_id, n1, coalesce(n, 0)
),
-- what stands there all the while is in the way, not on its way
moving AS MATERIALIZED (
    SELECT e.*
    FROM encounter e
    SEMI JOIN state_dynamics s ON s.drive_id = e.drive_id AND s.actor_id = e.object_id
        AND s.t_ns >= e.t_object_in_ns AND s.t_ns <= e.t_object_out_ns AND coalesce(s.speed_mps > standing_mps(), true)
    -- over or under the ego's road, nobody meets it; who may be there is in pair without a place
    ANTI JOIN (FROM pair WHERE off_level) p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.object_id = e.object_id
        AND p.t_ns >= e.t_object_in_ns AND p.t_ns <= e.t_object_out_ns
),
-- Between the last sample off the common ground and the first one on it, a box comes as near as its speed allows: an entry is at most so much
-- before its sample, an exit so much after it.
edge AS (
    SELECT
        m.drive_id, m.ego_id, m.object_id, m.t_ego_in_ns, m.t_object_in_ns, v.*, c.period_ns, v.t_ns - v.sense * c.max_gap_ns AS t_far_ns
    FROM moving m
    JOIN clock c USING (drive_id, ego_id)
    CROSS JOIN LATERAL (VALUES
        ('ego_in', 1, m.ego_id, m.t_ego_in_ns, m.object_id, m.t_object_in_ns, m.t_object_out_ns),
        ('ego_out', -1, m.ego_id, m.t_ego_out_ns, m.object_id, m.t_object_in_ns, m.t_object_out_ns),
        ('object_in', 1, m.object_id, m.t_object_in_ns, m.ego_id, m.t_ego_in_ns, m.t_ego_out_ns),
        ('object_out', -1, m.object_id, m.t_object_out_ns, m.ego_id, m.t_ego_in_ns, m.t_ego_out_ns)
    ) AS v(side, sense, actor_id, t_ns, on_id, from_ns, to_ns)
),
-- the sample off the ground that is next to the one on it
off AS (
    SELECT e.drive_id, e.ego_id, e.object_id, e.t_ego_in_ns, e.t_object_in_ns, e.side, min({'ns': e.sense * (e.t_ns - s.t_ns), 't_ns': s.t_ns}).t_ns AS t_off_ns
    FROM edge e
    JOIN state_dynamics s ON s.drive_id = e.drive_id AND s.actor_id = e.actor_id
        AND s.t_ns >= least(e.t_ns, e.t_far_ns) AND s.t_ns <= greatest(e.t_ns, e.t_far_ns) AND s.t_ns <> e.t_ns
    GROUP BY ALL
),
sooner AS (
    SELECT
        e.drive_id, e.ego_id, e.object_id, e.t_ego_in_ns, e.t_object_in_ns, e.side,
        greatest(0, abs(e.t_ns - o.t_off_ns) - coalesce(round(1e9 * min(greatest(0.0, box_separation(
            (b.x_m - a.x_m) * cos(a.yaw_rad) + (b.y_m - a.y_m) * sin(a.yaw_rad), (b.y_m - a.y_m) * cos(a.yaw_rad) - (b.x_m - a.x_m) * sin(a.yaw_rad),
            cos(b.yaw_rad - a.yaw_rad), sin(b.yaw_rad - a.yaw_rad),
            a.length_m / 2, a.width_m / 2, swept_half_m(b.length_m, b.speed_mps, e.period_ns / 1e9), b.width_m / 2
        )) / nullif(greatest(a.speed_mps, i.speed_mps), 0))), 0))::BIGINT AS by_ns
    FROM edge e
    JOIN off o USING (drive_id, ego_id, object_id, t_ego_in_ns, t_object_in_ns, side)
    LEFT JOIN ego_actor w ON w.drive_id = e.drive_id AND w.ego_id = e.ego_id AND e.actor_id = e.ego_id
    JOIN state_dynamics a ON a.drive_id = e.drive_id AND a.actor_id = coalesce(w.actor_id, e.actor_id) AND a.t_ns = o.t_off_ns
    JOIN state_dynamics i ON i.drive_id = e.drive_id AND i.actor_id = e.actor_id AND i.t_ns = e.t_ns
    JOIN state_dynamics b ON b.drive_id = e.drive_id AND b.actor_id = e.on_id AND b.t_ns >= e.from_ns - e.period_ns AND b.t_ns <= e.to_ns + e.period_ns
    GROUP BY e.drive_id, e.ego_id, e.object_id, e.t_ego_in_ns, e.t_object_in_ns, e.side, e.t_ns, o.t_off_ns
),
timed AS (
    SELECT
        drive_id, ego_id, object_id, t_ego_in_ns, t_object_in_ns,
        (max(e.t_ns - coalesce(s.by_ns, 0)) FILTER (e.sense = 1) - min(e.t_ns + coalesce(s.by_ns, 0)) FILTER (e.sense = -1)) / 1e9 AS pet_s
    FROM edge e LEFT JOIN sooner s USING (drive_id, ego_id, object_id, t_ego_in_ns, t_object_in_ns, side)
    GROUP BY drive_id, ego_id, object_id, t_ego_in_ns, t_object_in_ns
),
-- the mean over the half second before each sample, where that is seen
slowing AS (
    SELECT
        drive_id, ego_id, object_id, t_ego_in_ns, t_object_in_ns, max(decel_mps2) AS decel_mps2,
        -- every stretch of it was seen
        bool_and(coalesce(gap_ns <= max_gap_ns, true)) AND min(t_ns) - (t_ego_in_ns - 4_000_000_000) <= period_ns
            AND max(t_ns) = t_object_in_ns AND bool_and(speed_mps IS NOT NULL) AS whole
    FROM (
        SELECT
            m.drive_id, m.ego_id, m.object_id, m.t_ego_in_ns, m.t_object_in_ns, s.t_ns, s.speed_mps, c.max_gap_ns, c.period_ns,
            s.t_ns - lag(s.t_ns) OVER w AS gap_ns,
            CASE WHEN s.t_ns - first_value(s.t_ns) OVER half >= 500_000_000 - c.period_ns // 2 THEN
                (first_value(s.speed_mps) OVER half - s.speed_mps) / ((s.t_ns - first_value(s.t_ns) OVER half) / 1e9)
            END AS decel_mps2
        FROM moving m
        JOIN clock c USING (drive_id, ego_id)
        JOIN state_dynamics s ON s.drive_id = m.drive_id AND s.actor_id = m.object_id
            AND s.t_ns >= m.t_ego_in_ns - 4_000_000_000 AND s.t_ns <= m.t_object_in_ns
        WINDOW
            w AS (PARTITION BY m.drive_id, m.ego_id, m.object_id, m.t_ego_in_ns, m.t_object_in_ns ORDER BY s.t_ns),
            half AS (
                PARTITION BY m.drive_id, m.ego_id, m.object_id, m.t_ego_in_ns, m.t_object_in_ns ORDER BY s.t_ns
                RANGE BETWEEN 500_000_000 PRECEDING AND CURRENT ROW
            )
    )
    GROUP BY drive_id, ego_id, object_id, t_ego_in_ns, t_object_in_ns, period_ns
),
-- the ego enters the area with its front: what that is on counts
entered AS (
    SELECT m.drive_id, m.ego_id, m.t_ego_in_ns, g.environment_id, c.lanelet_id, e.front_s_m - c.s_start_m AS front_m, e.rear_s_m - c.s_start_m AS rear_m, c.length_m
    FROM (SELECT DISTINCT drive_id, ego_id, t_ego_in_ns FROM moving) m
    JOIN ego_state e ON e.drive_id = m.drive_id AND e.ego_id = m.ego_id AND e.t_ns = m.t_ego_in_ns
    JOIN data_log g ON g.drive_id = m.drive_id
    JOIN chain c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.chain_id = e.chain_id
        AND c.s_start_m <= e.front_s_m AND c.s_start_m + c.length_m >= e.rear_s_m
),
junction_there AS (
    SELECT i.drive_id, i.ego_id, i.t_ego_in_ns, max({'s_m': -i.front_m, 'id': n.junction_id}).id AS junction_id
    FROM entered i
    JOIN lanelet n USING (environment_id, lanelet_id)
    WHERE i.front_m >= 0 AND i.front_m < i.length_m AND n.junction_id IS NOT NULL
    GROUP BY ALL
),
crossing_there AS (
    SELECT i.drive_id, i.ego_id, i.t_ego_in_ns, max({'s_m': x.s_start_m - i.front_m, 'id': x.crossing_id}).id AS crossing_id
    FROM entered i
    JOIN crossing x USING (environment_id, lanelet_id)
    WHERE i.front_m >= x.s_start_m AND i.rear_m <= x.s_end_m
    GROUP BY ALL
)
SELECT
    m.drive_id, m.ego_id,
    (row_number() OVER (PARTITION BY m.drive_id, m.ego_id ORDER BY m.t_ego_in_ns, m.t_object_in_ns, m.object_id) - 1)::INTEGER AS occurrence,
    m.object_id, o.actor_class, m.t_ego_in_ns, m.t_ego_out_ns, m.t_object_in_ns, m.t_object_out_ns,
    p.pet_s,
    m.t_ego_in_ns <= m.t_object_in_ns AS ego_first, m.angle_rad,
    a.speed_mps AS ego_speed_mps, o.speed_mps,
    CASE WHEN d.whole THEN d.decel_mps2 END AS decel_mps2,
    j.junction_id, x.crossing_id
FROM moving m
JOIN state_dynamics a ON a.drive_id = m.drive_id AND a.actor_id = m.ego_id AND a.t_ns = m.t_ego_in_ns
JOIN state_dynamics o ON o.drive_id = m.drive_id AND o.actor_id = m.object_id AND o.t_ns = m.t_object_in_ns
JOIN timed p ON p.drive_id = m.drive_id AND p.ego_id = m.ego_id AND p.object_id = m.object_id AND p.t_ego_in_ns = m.t_ego_in_ns AND p.t_object_in_ns = m.t_object_in_ns
LEFT JOIN slowing d ON d.drive_id = m.drive_id AND d.ego_id = m.ego_id AND d.object_id = m.object_id
    AND d.t_ego_in_ns = m.t_ego_in_ns AND d.t_object_in_ns = m.t_object_in_ns
LEFT JOIN junction_there j ON j.drive_id = m.drive_id AND j.ego_id = m.ego_id AND j.t_ego_in_ns = m.t_ego_in_ns
LEFT JOIN crossing_there x ON x.drive_id = m.drive_id AND x.ego_id = m.ego_id AND x.t_ego_in_ns = m.t_ego_in_ns
