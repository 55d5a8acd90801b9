-- The lanelet beyond each boundary of a drivable lanelet. If the map names no neighbour, the neighbour is the drivable lane that runs along
-- the boundary, found for each piece of at most 10 m. No neighbour is named in maps with one road per direction, with different sections
-- for the two directions, or with separate lane numbers. Junctions are left out, because lanes of all directions overlap there. A narrow
-- strip that the map draws as a lane between the two directions is skipped, like the space between two painted lines.
-- lifetime: map
CREATE TABLE lane_beside (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- a drivable lanelet
    side VARCHAR NOT NULL,            -- [side] the side of the boundary
    s_start_m DOUBLE NOT NULL,        -- start of the piece, along the lanelet's centre line; no row: the map has nothing beyond the boundary here
    s_end_m DOUBLE NOT NULL,          -- end of the piece
    beside_id VARCHAR NOT NULL,       -- the lanelet beyond the boundary: the neighbour that the map names, else the drivable lanelet of any road that runs along the boundary at most 2 m away; behind a narrow strip, the opposing lane
    against BOOLEAN NOT NULL,         -- that lanelet is driven in the opposite direction
    gap_m DOUBLE NOT NULL,            -- from the boundary to the nearer bound of beside_id; 0: the map names it as neighbour
    strip VARCHAR,                    -- [lane_strip] the strip between the two; NULL: none
    drivable BOOLEAN NOT NULL,        -- see lanelet
    lane_type VARCHAR NOT NULL,       -- [lane_type] see lanelet
    width_m DOUBLE NOT NULL           -- width of beside_id
);

INSERT INTO lane_beside BY NAME
WITH RECURSIVE side AS (
    SELECT n.environment_id, n.lanelet_id, n.length_m, v.side, CASE v.side WHEN 1 THEN n.left_id ELSE n.right_id END AS beside_id,
        CASE v.side WHEN 1 THEN n.left_against ELSE n.right_against END AS against
    FROM lanelet n
    CROSS JOIN (VALUES (1), (-1)) AS v(side)
    WHERE n.drivable
),
-- The lanelets beyond each boundary, searched across narrow strips. beside_id is the lanelet beyond the strips found so far, gap_m their
-- total width.
lanelet_beyond AS (
    SELECT environment_id, lanelet_id, side, lanelet_id AS from_id, beside_id, against, 0.0::DOUBLE AS gap_m, NULL::VARCHAR AS strip FROM side WHERE beside_id IS NOT NULL
    UNION ALL
    SELECT
        t.environment_id, t.lanelet_id, t.side, t.beside_id, CASE WHEN b.left_id = t.from_id THEN b.right_id ELSE b.left_id END,
        t.against <> CASE WHEN b.left_id = t.from_id THEN b.right_against ELSE b.left_against END, t.gap_m + b.width_m,
        CASE WHEN t.strip = 'median' OR b.lane_type = 'none' THEN coalesce(t.strip, b.lane_type) ELSE b.lane_type END
    FROM lanelet_beyond t
    JOIN lanelet b ON b.environment_id = t.environment_id AND b.lanelet_id = t.beside_id AND NOT b.drivable
        AND b.lane_type IN ('median', 'border', 'restricted', 'none') AND t.gap_m + b.width_m <= CASE b.lane_type WHEN 'median' THEN reservation_m() ELSE 2.0 END
),
opposing_lane AS (
    SELECT t.environment_id, t.lanelet_id, t.side, t.beside_id, t.gap_m, t.strip, b.lane_type, b.width_m
    FROM lanelet_beyond t
    JOIN lanelet b ON b.environment_id = t.environment_id AND b.lanelet_id = t.beside_id AND b.drivable
    WHERE t.against AND t.strip <> 'none'
),
named_neighbour AS (
    SELECT s.environment_id, s.lanelet_id, s.side, 0.0::DOUBLE AS s_start_m, s.length_m AS s_end_m, s.beside_id, s.against, 0.0::DOUBLE AS gap_m, NULL::VARCHAR AS strip, b.drivable, b.lane_type, b.width_m
    FROM side s
    -- A lane of type none is no lane, but a strip that some maps draw between the directions.
    JOIN lanelet b ON b.environment_id = s.environment_id AND b.lanelet_id = s.beside_id AND b.lane_type <> 'none'
    ANTI JOIN opposing_lane o ON o.environment_id = s.environment_id AND o.lanelet_id = s.lanelet_id AND o.side = s.side
    UNION ALL
    SELECT s.environment_id, s.lanelet_id, s.side, 0.0::DOUBLE, s.length_m, o.beside_id, true, round(o.gap_m, 3), o.strip, true, o.lane_type, o.width_m
    FROM side s
    JOIN opposing_lane o ON o.environment_id = s.environment_id AND o.lanelet_id = s.lanelet_id AND o.side = s.side
),
boundary_piece AS (
    SELECT g.*, s.side, z.z_m, ceil(len_m / 10) AS n, unnest(range(ceil(len_m / 10)::BIGINT)) AS i
    FROM _lane_segment g
    JOIN side s USING (environment_id, lanelet_id)
    JOIN lane_point z USING (environment_id, lanelet_id, k)
    JOIN lanelet j ON j.environment_id = s.environment_id AND j.lanelet_id = s.lanelet_id AND j.junction_id IS NULL
    ANTI JOIN named_neighbour b ON b.environment_id = s.environment_id AND b.lanelet_id = s.lanelet_id AND b.side = s.side
),
piece_middle AS (
    SELECT environment_id, lanelet_id, side, s0_m + i * len_m / n AS s_start_m, s0_m + (i + 1) * len_m / n AS s_end_m,
        (i + 0.5) / n AS u, z_m, hw0_m, hw1_m, x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1
    FROM boundary_piece
),
-- Points beyond the boundary. Their distance from each other is less than the width of any lane.
probe_point AS (
    SELECT
        environment_id, lanelet_id, side, s_start_m, s_end_m, o.out_m, tx, ty, z_m,
        x_m - side * (half_width_m + o.out_m) * ty AS x_m, y_m + side * (half_width_m + o.out_m) * tx AS y_m
    FROM (
        SELECT
            *, hw0_m + u * (hw1_m - hw0_m) AS half_width_m, x0_m + u * (x1_m - x0_m) AS x_m, y0_m + u * (y1_m - y0_m) AS y_m,
            (tx0 + u * (tx1 - tx0)) / tangent_length AS tx, (ty0 + u * (ty1 - ty0)) / tangent_length AS ty
        FROM (SELECT *, sqrt((tx0 + u * (tx1 - tx0)) ** 2 + (ty0 + u * (ty1 - ty0)) ** 2) AS tangent_length FROM piece_middle)
    )
    CROSS JOIN (VALUES (0.1), (1.0), (2.0)) AS o(out_m)
),
probe_hit AS (
    SELECT
        p.*, c.lanelet_id AS beside_id, c.hw0_m, c.hw1_m, c.tx0, c.ty0, c.tx1, c.ty1,
        along0(p.x_m, p.y_m, c.x0_m, c.y0_m, c.tx0, c.ty0) AS a0, along1(p.x_m, p.y_m, c.x1_m, c.y1_m, c.tx1, c.ty1) AS a1,
        c.x0_m, c.y0_m, c.x1_m, c.y1_m, c.slack0_m, c.slack1_m
    FROM probe_point p
    JOIN _lane_cell c ON c.environment_id = p.environment_id AND c.cell = lane_cell_of(p.x_m, p.y_m) AND c.drivable AND c.lanelet_id <> p.lanelet_id
    JOIN lanelet n ON n.environment_id = c.environment_id AND n.lanelet_id = c.lanelet_id AND n.junction_id IS NULL
    JOIN lane_point z ON z.environment_id = c.environment_id AND z.lanelet_id = c.lanelet_id AND z.k = c.k
    -- A lane on a bridge above it is not beside it.
    WHERE coalesce(abs(z.z_m - p.z_m) < 3, true)
),
-- Lanes that run along the boundary: within 30 degrees of it, in either direction.
lane_along AS (
    SELECT environment_id, lanelet_id, side, s_start_m, s_end_m, beside_id, half_width_m, along_cos < 0 AS against,
        -- From the boundary to the nearer bound of that lane.
        out_m - half_width_m + CASE WHEN along_cos < 0 THEN side ELSE -side END * d_m AS gap_m
    FROM (
        SELECT
            *, hw0_m + v * (hw1_m - hw0_m) AS half_width_m, offset_left(x_m, y_m, v, x0_m, y0_m, tx0, ty0, x1_m, y1_m, tx1, ty1) AS d_m,
            tx * (tx0 + v * (tx1 - tx0)) + ty * (ty0 + v * (ty1 - ty0)) AS along_cos
        FROM (SELECT *, a0 / (a0 + a1) AS v FROM probe_hit WHERE a0 >= -slack0_m AND a1 > -slack1_m AND a0 + a1 > 0)
    )
    WHERE abs(d_m) <= half_width_m + 0.02 AND abs(along_cos) > cos(radians(30))
),
nearest_lane AS (
    SELECT environment_id, lanelet_id, side, s_start_m, s_end_m, min({'gap_m': round(gap_m, 3), 'id': beside_id, 'against': against, 'width_m': 2 * half_width_m}) AS b
    FROM lane_along
    -- A lane on the same ground, as where lanes fork, is not beside it.
    WHERE gap_m > -0.5
    GROUP BY ALL
)
SELECT environment_id, lanelet_id, CASE side WHEN 1 THEN 'left' ELSE 'right' END AS side, s_start_m, s_end_m, beside_id, against, gap_m, strip, drivable, lane_type, width_m
FROM named_neighbour
UNION ALL
SELECT
    k.environment_id, k.lanelet_id, CASE k.side WHEN 1 THEN 'left' ELSE 'right' END, k.s_start_m, k.s_end_m, k.b.id, k.b.against, greatest(k.b.gap_m, 0.0), NULL, n.drivable, n.lane_type, k.b.width_m
FROM nearest_lane k
JOIN lanelet n ON n.environment_id = k.environment_id AND n.lanelet_id = k.b.id
