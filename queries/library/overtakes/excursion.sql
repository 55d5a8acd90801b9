-- Stretches in which a corner of the ego is over a boundary of its running lane, on either side. An ego that enters a junction crosses no
-- boundary: the chain continues through the junction's lanelets.
-- lifetime: part
CREATE TABLE excursion (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- the running chain that the ego leaves
    side INTEGER NOT NULL,            -- 1: over the left boundary, -1: over the right one {position}
    overtaking BOOLEAN,               -- this is the overtaking side; NULL: handedness unknown {position}
    t0_ns BIGINT NOT NULL,            -- first step with a corner more than 0.05 m over the boundary {position}
    begin_seen BOOLEAN NOT NULL,      -- the step before t0_ns exists, and the ego is inside the lane there {position}
    t_end_ns BIGINT NOT NULL,         -- last step over the boundary {position}
    t_back_ns BIGINT,                 -- the step after t_end_ns, wholly inside again; NULL: the log, a hole or the corridor ends first {position}
    t_over_ns BIGINT,                 -- first step with the whole box over the boundary; NULL: never {position, heading, size}
    t_out_ns BIGINT NOT NULL,         -- t_over_ns; if the box is never wholly over: the first step within 0.1 m of the greatest excursion {position}
    t_turn_ns BIGINT,                 -- last step from t_out_ns on before the ego finally moves back, at 0.1 m/s or more towards the running lane; NULL: never {position}
    t_return_ns BIGINT,               -- first step after t_turn_ns with a corner over the line again; NULL: never {position}
    max_out_m DOUBLE NOT NULL,        -- greatest distance of a corner beyond the boundary {position, heading, size}
    centre_over BOOLEAN NOT NULL,     -- the centre crossed the boundary too: an intended manoeuvre {position}
    lane_width_m DOUBLE NOT NULL,     -- width of the running lane at t0_ns
    over_width_m DOUBLE,              -- width of the lane beside it on the overtaking side at t0_ns; NULL: no such lane
    over_against BOOLEAN              -- that lane is driven in the opposite direction {position, heading, size}
);

INSERT INTO excursion BY NAME
WITH side_sample AS (
    SELECT
        c.drive_id, c.ego_id, c.chain_id, st.k, st.seg, st.t_ns, st.dt_ns, c.d_m, c.half_width_m, c.over_width_m, c.over_against, v.side,
        c.side = v.side AS overtaking,
        CASE v.side WHEN 1 THEN c.left_out_m ELSE c.right_out_m END AS out_m,
        CASE v.side WHEN 1 THEN c.left_in_m ELSE c.right_in_m END AS in_m,
        v.side * c.d_m AS lateral_m
    FROM ego_corridor c
    JOIN step st USING (drive_id, ego_id, t_ns)
    CROSS JOIN (VALUES (1), (-1)) AS v(side)
    WHERE c.left_out_m IS NOT NULL
),
sample AS (
    SELECT
        *,
        out_m > over_boundary_m() AS is_over,
        lag({'k': k, 'seg': seg, 't_ns': t_ns, 'is_over': out_m > over_boundary_m(), 'lateral_m': lateral_m}) OVER w AS before,
        lead({'k': k, 'seg': seg, 't_ns': t_ns}) OVER w AS after
    FROM side_sample
    WINDOW w AS (PARTITION BY drive_id, ego_id, chain_id, side ORDER BY k)
),
over_sample AS (
    SELECT
        *,
        coalesce(before.k = k - 1 AND before.seg = seg, false) AS has_step_before,
        coalesce(before.is_over AND before.seg = seg AND (before.k = k - 1 OR t_ns - before.t_ns <= no_return_ns()), false) AS continues_stretch,
        CASE WHEN before.k = k - 1 AND before.seg = seg THEN (lateral_m - before.lateral_m) / (dt_ns / 1e9) END AS lateral_mps
    FROM sample
    WHERE is_over
),
stretch_sample AS (
    SELECT
        *,
        sum((NOT continues_stretch)::INTEGER)
            OVER (PARTITION BY drive_id, ego_id, chain_id, side ORDER BY k ROWS UNBOUNDED PRECEDING) AS stretch_no
    FROM over_sample
),
whole_stretch AS (
    SELECT
        drive_id, ego_id, chain_id, side, stretch_no,
        min(t_ns) AS t0_ns, max(t_ns) AS t_end_ns, min(CASE WHEN in_m >= 0 THEN t_ns END) AS t_over_ns,
        max({'k': k, 'after_ns': CASE WHEN after.k = k + 1 AND after.seg = seg THEN after.t_ns END}) FILTER (in_m >= 0) AS last_over,
        max(out_m) AS max_out_m, bool_or(lateral_m > half_width_m) AS centre_over,
        min({'k': k, 'has_step_before': has_step_before, 'overtaking': overtaking, 'half_width_m': half_width_m, 'over_width_m': over_width_m, 'over_against': over_against}) AS first,
        max({'k': k, 'seg': seg, 'after': after}) AS last
    FROM stretch_sample
    GROUP BY ALL
),
-- The first step within 0.1 m of the furthest position. An ego that passes a narrow vehicle stays astride the line, never wholly over it.
furthest_step AS (
    SELECT s.drive_id, s.ego_id, s.chain_id, s.side, s.stretch_no, min(s.t_ns) AS t_furthest_ns
    FROM whole_stretch w
    JOIN stretch_sample s USING (drive_id, ego_id, chain_id, side, stretch_no)
    WHERE s.out_m >= w.max_out_m - 0.1
    GROUP BY ALL
),
-- The turn back: the last step over the line at which the lateral speed was not yet towards the running lane.
turn_back AS (
    SELECT w.drive_id, w.ego_id, w.chain_id, w.side, w.stretch_no, max(s.t_ns) AS t_turn_ns
    FROM whole_stretch w
    JOIN furthest_step e USING (drive_id, ego_id, chain_id, side, stretch_no)
    JOIN stretch_sample s USING (drive_id, ego_id, chain_id, side, stretch_no)
    WHERE s.t_ns >= coalesce(w.t_over_ns, e.t_furthest_ns) AND s.lateral_mps > -0.1
    GROUP BY ALL
)
SELECT
    w.drive_id, w.ego_id, w.chain_id, w.side, w.first.overtaking AS overtaking, w.t0_ns, w.first.has_step_before AS begin_seen, w.t_end_ns,
    CASE WHEN w.last.after.k = w.last.k + 1 AND w.last.after.seg = w.last.seg THEN w.last.after.t_ns END AS t_back_ns,
    w.t_over_ns, coalesce(w.t_over_ns, e.t_furthest_ns) AS t_out_ns,
    CASE WHEN w.last.after.k = w.last.k + 1 AND w.last.after.seg = w.last.seg THEN t.t_turn_ns END AS t_turn_ns,
    w.last_over.after_ns AS t_return_ns, w.max_out_m, w.centre_over, 2 * w.first.half_width_m AS lane_width_m,
    CASE WHEN w.first.overtaking THEN w.first.over_width_m END AS over_width_m,
    CASE WHEN w.first.overtaking THEN w.first.over_against END AS over_against
FROM whole_stretch w
JOIN furthest_step e USING (drive_id, ego_id, chain_id, side, stretch_no)
LEFT JOIN turn_back t USING (drive_id, ego_id, chain_id, side, stretch_no)
