-- Steps at which the running lane changes: the ego's centre is over a boundary, in a lane whose direction it follows. The end of a chain in
-- the map is no crossing, because the centre is still inside the old lane. Turning round is no crossing, because the ego heads against the
-- new lane.
-- lifetime: part
CREATE TABLE lane_crossing (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    from_chain_id INTEGER NOT NULL,   -- the running chain before
    to_chain_id INTEGER NOT NULL,     -- the running chain from this step on
    to_lanelet_id VARCHAR,            -- the lanelet of the new lane
    t_ns BIGINT NOT NULL,             -- first step with the ego's centre in another lane of the same direction
    k INTEGER NOT NULL,               -- see step
    t_before_ns BIGINT NOT NULL,      -- the step before {position}
    seen BOOLEAN NOT NULL,            -- there is no hole between the two steps {position}
    side INTEGER NOT NULL             -- the side to which the ego crosses: 1 left, -1 right {position}
);

INSERT INTO lane_crossing BY NAME
WITH chain_step AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, st.k, st.seg, e.chain_id AS to_chain_id, e.lanelet_id AS to_lanelet_id,
        lag({'t_ns': e.t_ns, 'seg': st.seg, 'chain_id': e.chain_id}) OVER (PARTITION BY e.drive_id, e.ego_id ORDER BY st.k) AS previous
    FROM ego_state e
    JOIN step st USING (drive_id, ego_id, t_ns)
)
SELECT
    c.drive_id, c.ego_id, c.previous.chain_id AS from_chain_id, c.to_chain_id, c.to_lanelet_id, c.t_ns, c.k, c.previous.t_ns AS t_before_ns,
    c.previous.seg = c.seg AS seen, CASE WHEN x.d_m > 0 THEN 1 ELSE -1 END AS side
FROM chain_step c
JOIN ego_corridor x ON x.drive_id = c.drive_id AND x.ego_id = c.ego_id AND x.chain_id = c.previous.chain_id AND x.t_ns = c.t_ns
-- Within 5 cm of the line, the centre is on both lanes.
WHERE c.previous.chain_id <> c.to_chain_id AND abs(x.d_m) > x.half_width_m - 0.05 AND abs(x.heading_diff_rad) < pi() / 2
