-- Lanes of different roads that lie over each other in plan, where neither the map's heights nor a junction or link say that they meet:
-- a bridge, or a map that does not say. The centre line of the one, metre by metre, is looked for in the area of the other.
WITH RECURSIVE told AS (SELECT environment_id FROM lane_point GROUP BY environment_id HAVING max(z_m) > min(z_m)),
height AS (
    SELECT p.environment_id, p.lanelet_id, p.k, p.z_m, lead(p.z_m) OVER (PARTITION BY p.environment_id, p.lanelet_id ORDER BY p.k) AS z1_m
    FROM lane_point p SEMI JOIN told USING (environment_id)
),
spot AS (
    SELECT
        g.environment_id, g.lanelet_id, n.road_id, g.x0_m + i.u * (g.x1_m - g.x0_m) AS x_m, g.y0_m + i.u * (g.y1_m - g.y0_m) AS y_m,
        h.z_m + i.u * (h.z1_m - h.z_m) AS z_m
    FROM lane_segment g
    JOIN lanelet n USING (environment_id, lanelet_id)
    LEFT JOIN height h USING (environment_id, lanelet_id, k)
    CROSS JOIN LATERAL (SELECT unnest(range(ceil(g.len_m)::BIGINT)) / ceil(g.len_m) AS u) i
    WHERE n.drivable
),
candidate AS (
    SELECT
        s.*, c.* EXCLUDE (environment_id, lanelet_id, cell, drivable, footway), c.lanelet_id AS other_id,
        along0(s.x_m, s.y_m, c.x0_m, c.y0_m, c.tx0, c.ty0) AS a0, along1(s.x_m, s.y_m, c.x1_m, c.y1_m, c.tx1, c.ty1) AS a1
    FROM spot s
    JOIN lane_cell c ON c.environment_id = s.environment_id AND c.cell = lane_cell_of(s.x_m, s.y_m)
    WHERE c.drivable AND c.lanelet_id <> s.lanelet_id
),
covered AS (
    SELECT s.environment_id, s.lanelet_id, s.road_id, s.other_id, n.road_id AS other_road_id, s.z_m - h.z_m - a0 / (a0 + a1) * (h.z1_m - h.z_m) AS dz_m
    FROM candidate s
    JOIN lanelet n ON n.environment_id = s.environment_id AND n.lanelet_id = s.other_id
    LEFT JOIN height h ON h.environment_id = s.environment_id AND h.lanelet_id = s.other_id AND h.k = s.k
    WHERE a0 >= 0 AND a1 > 0 AND n.road_id <> s.road_id
        AND abs(offset_left(x_m, y_m, a0 / (a0 + a1), x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1)) < least(hw0_m, hw1_m) - 0.1
),
over AS (
    SELECT environment_id, lanelet_id, road_id, other_id, other_road_id
    FROM covered
    GROUP BY ALL
    HAVING bool_or(coalesce(abs(dz_m) > level_m(), true))
),
-- the lanes of a road that run one way, and what they lead to: lanes beside each other begin and end together
way AS (
    SELECT environment_id, lanelet_id, road_id, along_road, junction_id, length_m FROM lanelet WHERE drivable
),
link AS (
    SELECT DISTINCT l.environment_id, {'road': a.road_id, 'along': a.along_road} AS from_way, {'road': b.road_id, 'along': b.along_road} AS to_way
    FROM lane_link l
    JOIN way a ON a.environment_id = l.environment_id AND a.lanelet_id = l.from_id
    JOIN way b ON b.environment_id = l.environment_id AND b.lanelet_id = l.to_id
),
-- one leads into the other, or both begin or end with the same
next_to AS (
    SELECT environment_id, from_way AS a, to_way AS b FROM link
    UNION
    SELECT environment_id, to_way, from_way FROM link
    UNION
    SELECT x.environment_id, x.to_way, y.to_way FROM link x JOIN link y USING (environment_id, from_way)
    UNION
    SELECT x.environment_id, x.from_way, y.from_way FROM link x JOIN link y USING (environment_id, to_way)
),
at_junction AS (
    SELECT environment_id, road_id, junction_id FROM way
    UNION
    SELECT l.environment_id, l.from_way.road, w.junction_id FROM link l JOIN way w ON w.environment_id = l.environment_id AND w.road_id = l.to_way.road
    UNION
    SELECT l.environment_id, l.to_way.road, w.junction_id FROM link l JOIN way w ON w.environment_id = l.environment_id AND w.road_id = l.from_way.road
),
unjoined AS MATERIALIZED (
    SELECT *
    FROM over
    ANTI JOIN (
        SELECT x.environment_id, x.road_id, y.road_id AS other_road_id FROM at_junction x JOIN at_junction y USING (environment_id, junction_id)
    ) USING (environment_id, road_id, other_road_id)
),
-- a crossing without a junction in the map is one all the same where short lanes lead from the one to the other; a ramp is longer
reached AS (
    SELECT environment_id, a AS start, b, 0.0::DOUBLE AS by_m, 1 AS hop
    FROM next_to
    SEMI JOIN unjoined u ON u.environment_id = next_to.environment_id AND u.road_id = next_to.a.road
    UNION
    SELECT r.environment_id, r.start, n.b, r.by_m + m.length_m, r.hop + 1
    FROM reached r
    JOIN (SELECT environment_id, {'road': road_id, 'along': along_road} AS b, max(length_m) AS length_m FROM way GROUP BY ALL) m USING (environment_id, b)
    JOIN next_to n ON n.environment_id = r.environment_id AND n.a = r.b
    WHERE r.hop < 5 AND r.by_m + m.length_m <= turning_way_m()
),
met AS (SELECT DISTINCT environment_id, start.road AS road_id, b.road AS other_road_id FROM reached),
-- and lanes that begin or end in one point, where the map is cropped or lacks the links
tip AS (
    SELECT environment_id, lanelet_id, min({'k': k, 'x': x_m, 'y': y_m}) AS f, max({'k': k, 'x': x_m, 'y': y_m}) AS l FROM lane_point GROUP BY ALL
),
apart AS (
    SELECT o.environment_id, o.lanelet_id, o.other_id
    FROM unjoined o
    ANTI JOIN met USING (environment_id, road_id, other_road_id)
    JOIN tip a ON a.environment_id = o.environment_id AND a.lanelet_id = o.lanelet_id
    JOIN tip b ON b.environment_id = o.environment_id AND b.lanelet_id = o.other_id
    WHERE least(
        (a.f.x - b.f.x) ** 2 + (a.f.y - b.f.y) ** 2, (a.l.x - b.l.x) ** 2 + (a.l.y - b.l.y) ** 2,
        (a.f.x - b.l.x) ** 2 + (a.f.y - b.l.y) ** 2, (a.l.x - b.f.x) ** 2 + (a.l.y - b.f.y) ** 2
    ) > 1
)
SELECT environment_id, lanelet_id, other_id FROM apart
UNION
SELECT environment_id, other_id, lanelet_id FROM apart
