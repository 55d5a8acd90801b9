-- Pairs of lanes of different roads that overlap in plan without evidence, from heights, junctions or links, that they meet: a bridge, or a
-- map without this information. The centre line of one lane, metre by metre, is looked up in the area of the other.
-- lifetime: map
CREATE TABLE _lane_apart (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet
    other_id VARCHAR NOT NULL         -- a lanelet of another road over or under it, as far as the map shows: no junction, link or common end joins the two (only decks may begin and end together), and their heights differ by more than 2.5 m or are not known; each pair has two rows
);

INSERT INTO _lane_apart BY NAME
WITH RECURSIVE map_with_heights AS (SELECT environment_id FROM lane_point GROUP BY environment_id HAVING max(z_m) > min(z_m)),
segment_height AS (
    SELECT p.environment_id, p.lanelet_id, p.k, p.z_m, lead(p.z_m) OVER (PARTITION BY p.environment_id, p.lanelet_id ORDER BY p.k) AS z1_m
    FROM lane_point p SEMI JOIN map_with_heights USING (environment_id)
),
centre_point AS (
    SELECT
        g.environment_id, g.lanelet_id, n.road_id, g.x0_m + i.u * (g.x1_m - g.x0_m) AS x_m, g.y0_m + i.u * (g.y1_m - g.y0_m) AS y_m,
        h.z_m + i.u * (h.z1_m - h.z_m) AS z_m
    FROM _lane_segment g
    JOIN lanelet n USING (environment_id, lanelet_id)
    LEFT JOIN segment_height h USING (environment_id, lanelet_id, k)
    CROSS JOIN LATERAL (SELECT unnest(range(ceil(g.len_m)::BIGINT)) / ceil(g.len_m) AS u) i
    WHERE n.drivable
),
candidate AS (
    SELECT
        s.*, c.* EXCLUDE (environment_id, lanelet_id, cell, drivable, footway), c.lanelet_id AS other_id,
        along0(s.x_m, s.y_m, c.x0_m, c.y0_m, c.tx0, c.ty0) AS a0, along1(s.x_m, s.y_m, c.x1_m, c.y1_m, c.tx1, c.ty1) AS a1
    FROM centre_point s
    JOIN _lane_cell c ON c.environment_id = s.environment_id AND c.cell = lane_cell_of(s.x_m, s.y_m)
    WHERE c.drivable AND c.lanelet_id <> s.lanelet_id
),
covered_point AS (
    SELECT s.environment_id, s.lanelet_id, s.road_id, s.other_id, n.road_id AS other_road_id, s.z_m - h.z_m - a0 / (a0 + a1) * (h.z1_m - h.z_m) AS dz_m
    FROM candidate s
    JOIN lanelet n ON n.environment_id = s.environment_id AND n.lanelet_id = s.other_id
    LEFT JOIN segment_height h ON h.environment_id = s.environment_id AND h.lanelet_id = s.other_id AND h.k = s.k
    WHERE a0 >= 0 AND a1 > 0 AND n.road_id <> s.road_id
        AND abs(offset_left(x_m, y_m, a0 / (a0 + a1), x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1)) < least(hw0_m, hw1_m) - 0.1
),
overlap AS (
    SELECT environment_id, lanelet_id, road_id, other_id, other_road_id
    FROM covered_point
    GROUP BY ALL
    HAVING bool_or(coalesce(abs(dz_m) > level_m(), true))
),
-- occasion: overlap
-- The lanes of one road in one direction (a carriageway), and the carriageways that they lead to. Lanes beside each other begin and end
-- together.
carriageway_lane AS (
    SELECT environment_id, lanelet_id, road_id, along_road, junction_id, length_m FROM lanelet WHERE drivable
),
carriageway_link AS (
    SELECT DISTINCT l.environment_id, {'road': a.road_id, 'along': a.along_road} AS from_carriageway, {'road': b.road_id, 'along': b.along_road} AS to_carriageway
    FROM lane_link l
    JOIN carriageway_lane a ON a.environment_id = l.environment_id AND a.lanelet_id = l.from_id
    JOIN carriageway_lane b ON b.environment_id = l.environment_id AND b.lanelet_id = l.to_id
),
-- Two carriageways are adjacent if one leads into the other, or if both begin or both end at the same one.
next_to AS (
    SELECT environment_id, from_carriageway AS a, to_carriageway AS b FROM carriageway_link
    UNION
    SELECT environment_id, to_carriageway, from_carriageway FROM carriageway_link
    UNION
    SELECT x.environment_id, x.to_carriageway, y.to_carriageway FROM carriageway_link x JOIN carriageway_link y USING (environment_id, from_carriageway)
    UNION
    SELECT x.environment_id, x.from_carriageway, y.from_carriageway FROM carriageway_link x JOIN carriageway_link y USING (environment_id, to_carriageway)
),
at_junction AS (
    SELECT environment_id, road_id, junction_id FROM carriageway_lane
    UNION
    SELECT l.environment_id, l.from_carriageway.road, w.junction_id FROM carriageway_link l JOIN carriageway_lane w ON w.environment_id = l.environment_id AND w.road_id = l.to_carriageway.road
    UNION
    SELECT l.environment_id, l.to_carriageway.road, w.junction_id FROM carriageway_link l JOIN carriageway_lane w ON w.environment_id = l.environment_id AND w.road_id = l.from_carriageway.road
),
unjoined_overlap AS MATERIALIZED (
    SELECT *
    FROM overlap
    ANTI JOIN (
        SELECT x.environment_id, x.road_id, y.road_id AS other_road_id FROM at_junction x JOIN at_junction y USING (environment_id, junction_id)
    ) USING (environment_id, road_id, other_road_id)
),
-- Two roads that cross without a junction in the map also meet if short lanes lead from one road to the other. A ramp is longer.
reached AS (
    SELECT environment_id, a AS start, b, 0.0::DOUBLE AS between_m, 1 AS hop
    FROM next_to
    SEMI JOIN unjoined_overlap u ON u.environment_id = next_to.environment_id AND u.road_id = next_to.a.road
    UNION
    SELECT r.environment_id, r.start, n.b, r.between_m + m.length_m, r.hop + 1
    FROM reached r
    JOIN (SELECT environment_id, {'road': road_id, 'along': along_road} AS b, max(length_m) AS length_m FROM carriageway_lane GROUP BY ALL) m USING (environment_id, b)
    JOIN next_to n ON n.environment_id = r.environment_id AND n.a = r.b
    WHERE r.hop < 5 AND r.between_m + m.length_m <= turning_way_m()
),
joined_roads AS (SELECT DISTINCT environment_id, start.road AS road_id, b.road AS other_road_id FROM reached),
lanelet_tip AS (
    SELECT p.environment_id, p.lanelet_id, min({'k': p.k, 'x': p.x_m, 'y': p.y_m, 'z': h.z_m}) AS f, max({'k': p.k, 'x': p.x_m, 'y': p.y_m, 'z': h.z_m}) AS l
    FROM lane_point p
    LEFT JOIN segment_height h USING (environment_id, lanelet_id, k)
    GROUP BY ALL
),
-- Lanes that begin or end in one point meet, too: the map may be cropped or lack the links. Two lanes that both begin and end together do
-- not meet: one of them may be the upper deck of the other.
lane_pair AS (
    SELECT o.environment_id, o.lanelet_id, o.other_id
    FROM unjoined_overlap o
    ANTI JOIN joined_roads USING (environment_id, road_id, other_road_id)
    JOIN lanelet_tip a ON a.environment_id = o.environment_id AND a.lanelet_id = o.lanelet_id
    JOIN lanelet_tip b ON b.environment_id = o.environment_id AND b.lanelet_id = o.other_id
    CROSS JOIN LATERAL (
        SELECT
            is_one_point(a.f, b.f) AS begin_together, is_one_point(a.l, b.l) AS end_together, is_one_point(a.f, b.l) OR is_one_point(a.l, b.f) AS is_continued
    ) t
    WHERE begin_together = end_together AND NOT is_continued
)
SELECT environment_id, lanelet_id, other_id FROM lane_pair
UNION
SELECT environment_id, other_id, lanelet_id FROM lane_pair
