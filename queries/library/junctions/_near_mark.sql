-- The steps of the ego around the marks of its chains (junctions, stop lines and crossings, see way_mark), with the positions of its
-- bumpers at the step and at the step before. The rear bumper is that of its trailer, if it tows one. The first step after a hole is kept
-- for every mark that the ego passed in the hole.
-- lifetime: part
CREATE TABLE _near_mark (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- a chain whose strip contains the ego
    kind VARCHAR NOT NULL,            -- [mark_kind] see way_mark
    mark_id VARCHAR NOT NULL,         -- see way_mark
    s_start_m DOUBLE NOT NULL,        -- see way_mark
    t_ns BIGINT NOT NULL,             -- a step with the front bumper at most 10 m before the mark or beyond, and the rear bumper (at this step or the last one before) at most 10 m past it
    k INTEGER NOT NULL,               -- see step
    seg INTEGER NOT NULL,             -- see step
    front_m DOUBLE NOT NULL,          -- distance of the front bumper beyond the mark's start; negative: before it
    rear_m DOUBLE NOT NULL,           -- distance of the rear bumper (or the trailer's) beyond the mark's end; negative: before it
    front_before_m DOUBLE,            -- front_m at the last step before with a position on this chain; NULL: none
    rear_before_m DOUBLE,             -- rear_m at that step; NULL: none
    joined BOOLEAN NOT NULL,          -- that step is the one directly before this step, without a hole
    running BOOLEAN NOT NULL          -- the chain is the ego's running chain at this step, and the ego is at most 4 m beside the lane
);

INSERT INTO _near_mark BY NAME
WITH
-- Distance from the ego's middle to the rear of its trailer, see ego_state. While the trailer is not seen, its greatest distance counts.
trailer_reach AS (
    SELECT drive_id, ego_id, t_ns, coalesce(reach_m, max(reach_m) OVER (PARTITION BY drive_id, ego_id)) AS reach_m
    FROM (SELECT *, CASE WHEN combination_m <> length_m THEN combination_m - length_m / 2 END AS reach_m FROM ego_state)
),
bumper_place AS (
    SELECT
        c.drive_id, c.ego_id, c.chain_id, c.t_ns, s.k, s.seg, abs(c.d_m) - c.lat_half_m - c.half_width_m AS beside_m,
        -- If the ego drives against the corridor, the end of the trailer has the largest station.
        CASE WHEN t.reach_m IS NULL OR abs(c.heading_diff_rad) <= pi() / 2 THEN c.front_s_m ELSE c.s_m + t.reach_m END AS front_s_m,
        CASE WHEN t.reach_m IS NULL OR abs(c.heading_diff_rad) > pi() / 2 THEN c.rear_s_m ELSE c.s_m - t.reach_m END AS rear_s_m
    FROM ego_corridor c
    JOIN step s USING (drive_id, ego_id, t_ns)
    JOIN trailer_reach t USING (drive_id, ego_id, t_ns)
    SEMI JOIN way_mark m ON m.drive_id = c.drive_id AND m.ego_id = c.ego_id AND m.chain_id = c.chain_id
    WHERE c.front_s_m IS NOT NULL
),
bumper_step AS (
    SELECT
        *, lag({'k': k, 'seg': seg, 'front_s_m': front_s_m, 'rear_s_m': rear_s_m}) OVER (PARTITION BY drive_id, ego_id, chain_id ORDER BY t_ns) AS previous
    FROM bumper_place
)
SELECT
    w.drive_id, w.ego_id, w.chain_id, m.kind, m.mark_id, m.s_start_m, w.t_ns, w.k, w.seg,
    w.front_s_m - m.s_start_m AS front_m, w.rear_s_m - m.s_end_m AS rear_m,
    w.previous.front_s_m - m.s_start_m AS front_before_m, w.previous.rear_s_m - m.s_end_m AS rear_before_m,
    coalesce(w.previous.k = w.k - 1 AND w.previous.seg = w.seg, false) AS joined,
    -- An ego that is beside the lane by more than a lane's width (4 m) is on another path.
    e.chain_id IS NOT DISTINCT FROM w.chain_id AND w.beside_m < 4 AS running
FROM bumper_step w
JOIN way_mark m ON m.drive_id = w.drive_id AND m.ego_id = w.ego_id AND m.chain_id = w.chain_id
    AND w.front_s_m >= m.s_start_m - near_mark_m() AND coalesce(least(w.previous.rear_s_m, w.rear_s_m), w.rear_s_m) <= m.s_end_m + near_mark_m()
JOIN ego_state e ON e.drive_id = w.drive_id AND e.ego_id = w.ego_id AND e.t_ns = w.t_ns
