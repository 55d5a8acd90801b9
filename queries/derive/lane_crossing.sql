-- Where the running lane becomes another one: the ego's centre is over a boundary, in a lane that it drives with the traffic. A chain that
-- only ends in the map, and turning round, are none: there the centre is still inside the lane that was left, or the ego heads against it.
WITH changed AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, st.k, st.seg, e.chain_id AS to_chain_id, e.lanelet_id AS to_lanelet_id,
        lag({'t_ns': e.t_ns, 'seg': st.seg, 'chain_id': e.chain_id}) OVER (PARTITION BY e.drive_id, e.ego_id ORDER BY st.k) AS before
    FROM ego_state e
    JOIN step st USING (drive_id, ego_id, t_ns)
)
SELECT
    c.drive_id, c.ego_id, c.before.chain_id AS from_chain_id, c.to_chain_id, c.to_lanelet_id, c.t_ns, c.k, c.before.t_ns AS t_before_ns,
    c.before.seg = c.seg AS seen, CASE WHEN x.d_m > 0 THEN 1 ELSE -1 END AS side
FROM changed c
JOIN ego_corridor x ON x.drive_id = c.drive_id AND x.ego_id = c.ego_id AND x.chain_id = c.before.chain_id AND x.t_ns = c.t_ns
-- a centre is on both lanes within 2 cm of the line
WHERE c.before.chain_id <> c.to_chain_id AND abs(x.d_m) > x.half_width_m - 0.05 AND abs(x.heading_diff_rad) < pi() / 2
