-- The running lane as a chain of lanelets: those that the ego drove, continued straight on at both ends. It extends for at least 1000 m
-- (corridor_ahead_m) beyond the last driven lanelet and 200 m (corridor_behind_m) before the first, unless the lane or the map ends
-- earlier. Steps in an opposing lane (an overtake) or off the lanes do not interrupt the chain. A change to another lane of the same
-- direction begins a new chain. Without a map, the chain is the ego's own recorded path (own_way).
-- lifetime: part
CREATE TABLE chain (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- number of the chain, from 0, in time order; each change to another running lane begins a new chain
    seq INTEGER NOT NULL,             -- order along the chain, from its end far behind
    lanelet_id VARCHAR NOT NULL,      -- the lanelet; without a map, a piece of own_way
    s_start_m DOUBLE NOT NULL,        -- chain station of the lanelet's start; 0: start of the first lanelet that the ego drove in this chain
    length_m DOUBLE NOT NULL,         -- length of the lanelet
    t_first_ns BIGINT,                -- first step at which the ego drove the lanelet in its direction; NULL: not driven: it continues straight on, or the ego cut the corner beside it
    t_last_ns BIGINT                  -- last step at which the ego drove it; NULL: as t_first_ns
);

INSERT INTO chain BY NAME
WITH RECURSIVE lane_step AS (
    SELECT
        drive_id, ego_id, t_ns, lanelet_id,
        -- A lanelet that continues into itself is a ring: each new round on it is a new visit.
        lanelet_id IS DISTINCT FROM lag(lanelet_id) OVER w OR s_m < lag(s_m) OVER w - n.length_m / 2 AS begins_visit
    FROM ego_lane e
    JOIN data_log l USING (drive_id)
    JOIN lanelet n USING (environment_id, lanelet_id)
    WHERE e.with_direction
    WINDOW w AS (PARTITION BY drive_id, ego_id ORDER BY t_ns)
),
-- The ego's visits to lanelets, numbered v = 0.. in time order.
visit AS (
    SELECT drive_id, ego_id, v, any_value(lanelet_id) AS lanelet_id, min(t_ns) AS t_first_ns, max(t_ns) AS t_last_ns
    FROM (
        SELECT *, (sum(begins_visit::INTEGER) OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns ROWS UNBOUNDED PRECEDING) - 1)::INTEGER AS v
        FROM lane_step
    )
    GROUP BY ALL
),
visited_lanelet AS (SELECT DISTINCT v.drive_id, v.ego_id, l.environment_id, v.lanelet_id FROM visit v JOIN data_log l USING (drive_id)),
-- The ego's route is known: a link between two lanelets that it drove has priority over the link straight on.
driven_link AS (
    SELECT a.drive_id, a.ego_id, a.lanelet_id, {'beside': false, 'abs_turn_rad': abs(l.turn_rad), 'id': l.to_id} AS next
    FROM visited_lanelet a
    JOIN lane_link l ON l.environment_id = a.environment_id AND l.from_id = a.lanelet_id
    JOIN visited_lanelet b ON b.drive_id = a.drive_id AND b.ego_id = a.ego_id AND b.lanelet_id = l.to_id
),
-- A link into a junction is also known if the ego cut the corner, and so drove through the junction beside the connecting lanelet.
corner_cut AS (
    SELECT a.drive_id, a.ego_id, a.lanelet_id, {'beside': true, 'abs_turn_rad': abs(l.turn_rad), 'id': l.to_id} AS next
    FROM visit a
    JOIN visit b ON b.drive_id = a.drive_id AND b.ego_id = a.ego_id AND b.v = a.v + 1
    JOIN data_log g ON g.drive_id = a.drive_id
    JOIN lane_link l ON l.environment_id = g.environment_id AND l.from_id = a.lanelet_id
    JOIN lanelet j ON j.environment_id = l.environment_id AND j.lanelet_id = l.to_id AND j.junction_id IS NOT NULL
    JOIN lane_link o ON o.environment_id = l.environment_id AND o.from_id = l.to_id AND o.to_id = b.lanelet_id
    SEMI JOIN (
        SELECT e.drive_id, e.ego_id, e.t_ns, n.junction_id
        FROM ego_lane e JOIN data_log x ON x.drive_id = e.drive_id JOIN lanelet n ON n.environment_id = x.environment_id AND n.lanelet_id = e.lanelet_id
        WHERE n.junction_id IS NOT NULL
    ) e ON e.drive_id = a.drive_id AND e.ego_id = a.ego_id AND e.junction_id = j.junction_id AND e.t_ns > a.t_last_ns AND e.t_ns < b.t_first_ns
),
driven_next AS (
    SELECT drive_id, ego_id, lanelet_id, min(next).id AS next_id FROM (FROM driven_link UNION ALL FROM corner_cut) GROUP BY drive_id, ego_id, lanelet_id
),
lanelet_ahead AS (
    SELECT v.drive_id, v.ego_id, v.v, 0 AS hop, l.environment_id, v.lanelet_id, 0.0::DOUBLE AS beyond_m
    FROM visit v JOIN data_log l USING (drive_id)
    UNION ALL
    SELECT a.drive_id, a.ego_id, a.v, a.hop + 1, a.environment_id, n.lanelet_id, a.beyond_m + n.length_m
    FROM lanelet_ahead a
    LEFT JOIN driven_next w ON w.drive_id = a.drive_id AND w.ego_id = a.ego_id AND w.lanelet_id = a.lanelet_id
    JOIN lane_next s ON s.environment_id = a.environment_id AND s.lanelet_id = a.lanelet_id
    JOIN lanelet n ON n.environment_id = a.environment_id AND n.lanelet_id = coalesce(w.next_id, s.ahead_id)
    WHERE a.beyond_m < corridor_ahead_m() AND a.hop < 500
),
-- If the next visit is on the extension ahead of this one, it continues the chain at that hop.
continuation AS (
    SELECT v.drive_id, v.ego_id, v.v, min(a.hop) AS hop
    FROM visit v
    LEFT JOIN visit w ON w.drive_id = v.drive_id AND w.ego_id = v.ego_id AND w.v = v.v + 1
    LEFT JOIN lanelet_ahead a ON a.drive_id = v.drive_id AND a.ego_id = v.ego_id AND a.v = v.v AND a.lanelet_id = w.lanelet_id AND a.hop > 0
    GROUP BY ALL
),
chain_visit AS (
    SELECT
        drive_id, ego_id, v, hop,
        (count(CASE WHEN hop IS NULL THEN 1 END) OVER (PARTITION BY drive_id, ego_id ORDER BY v ROWS UNBOUNDED PRECEDING) - (hop IS NULL)::BIGINT)::INTEGER AS chain_id
    FROM continuation
),
first_visit AS (SELECT drive_id, ego_id, chain_id, min(v) AS v FROM chain_visit GROUP BY ALL),
lanelet_behind AS (
    SELECT f.drive_id, f.ego_id, f.chain_id, 0 AS hop, l.environment_id, v.lanelet_id, 0.0::DOUBLE AS before_m
    FROM first_visit f JOIN visit v USING (drive_id, ego_id, v) JOIN data_log l USING (drive_id)
    UNION ALL
    SELECT b.drive_id, b.ego_id, b.chain_id, b.hop + 1, b.environment_id, n.lanelet_id, b.before_m + n.length_m
    FROM lanelet_behind b
    JOIN lane_next s ON s.environment_id = b.environment_id AND s.lanelet_id = b.lanelet_id
    JOIN lanelet n ON n.environment_id = b.environment_id AND n.lanelet_id = s.behind_id
    WHERE b.before_m < corridor_behind_m() AND b.hop < 200
),
-- The lanelets of each chain in order: those behind the first visit, then the lanelets of each visit and those ahead of it.
chain_lanelet AS (
    SELECT drive_id, ego_id, chain_id, -1 AS v, -hop AS hop, environment_id, lanelet_id FROM lanelet_behind WHERE hop > 0
    UNION ALL
    SELECT g.drive_id, g.ego_id, g.chain_id, g.v, a.hop, a.environment_id, a.lanelet_id
    FROM chain_visit g
    JOIN lanelet_ahead a USING (drive_id, ego_id, v)
    WHERE g.hop IS NULL OR a.hop < g.hop
),
chain_lanelet_with_end AS (
    SELECT
        k.drive_id, k.ego_id, k.chain_id, k.lanelet_id, n.length_m, k.v, k.hop,
        (row_number() OVER along - 1)::INTEGER AS seq,
        sum(to_picometres(n.length_m)) OVER (along ROWS UNBOUNDED PRECEDING) AS end_pm
    FROM chain_lanelet k JOIN lanelet n USING (environment_id, lanelet_id)
    WINDOW along AS (PARTITION BY k.drive_id, k.ego_id, k.chain_id ORDER BY k.v, k.hop)
)
SELECT
    o.drive_id, o.ego_id, o.chain_id, o.seq, o.lanelet_id, o.length_m, v.t_first_ns, v.t_last_ns,
    from_picometres(o.end_pm - to_picometres(o.length_m) - coalesce(max(CASE WHEN o.v < 0 THEN o.end_pm END) OVER (PARTITION BY o.drive_id, o.ego_id, o.chain_id), 0)) AS s_start_m
FROM chain_lanelet_with_end o
LEFT JOIN visit v ON v.drive_id = o.drive_id AND v.ego_id = o.ego_id AND v.v = CASE WHEN o.hop = 0 THEN o.v END
UNION ALL
-- Without a map, the ego's own path is its lane: each piece of it is a chain of one lanelet.
SELECT w.drive_id, w.ego_id, w.seg, 0, own_lanelet(w.seg), sum(w.len_m ORDER BY w.k), min(w.t_from_ns), min(s.t_last_ns), 0.0
FROM _own_way w
JOIN (SELECT drive_id, ego_id, seg, max(t_ns) AS t_last_ns FROM step GROUP BY ALL) s USING (drive_id, ego_id, seg)
SEMI JOIN (FROM data_log WHERE environment_id IS NULL) g ON g.drive_id = w.drive_id
GROUP BY w.drive_id, w.ego_id, w.seg
