-- The paper's questions in PostGIS, set-based and indexed. Sections are run one after the other; :states and :lanes are CSV files.
-- Rectangles: boxes, and danger spaces as the paper draws them.

-- @load
CREATE UNLOGGED TABLE state (
    actor_id text, t_ns bigint, x_m float8, y_m float8, yaw_rad float8, speed_mps float8, length_m float8, width_m float8, ego boolean
);
CREATE UNLOGGED TABLE lanelet (lanelet_id text, shape geometry);
\copy state FROM '{states}' CSV
\copy lanelet FROM '{lanes}' CSV

-- @index
CREATE INDEX ON lanelet USING gist (shape);
ANALYZE lanelet;

-- @derive
CREATE UNLOGGED TABLE placed AS
SELECT actor_id, t_ns, ego, ST_Point(x_m, y_m) AS centre,
    ST_MakePolygon(ST_MakeLine(ARRAY[
        ST_Point(x_m + lx + wx, y_m + ly + wy), ST_Point(x_m + lx - wx, y_m + ly - wy), ST_Point(x_m - lx - wx, y_m - ly - wy),
        ST_Point(x_m - lx + wx, y_m - ly + wy), ST_Point(x_m + lx + wx, y_m + ly + wy)
    ])) AS box,
    CASE WHEN sd > 0 THEN ST_MakePolygon(ST_MakeLine(ARRAY[
        ST_Point(x_m + lx + wx, y_m + ly + wy), ST_Point(x_m + lx - wx, y_m + ly - wy),
        ST_Point(x_m + lx - wx + sd * c, y_m + ly - wy + sd * s), ST_Point(x_m + lx + wx + sd * c, y_m + ly + wy + sd * s),
        ST_Point(x_m + lx + wx, y_m + ly + wy)
    ])) END AS danger
FROM (
    SELECT *, cos(yaw_rad) AS c, sin(yaw_rad) AS s, cos(yaw_rad) * length_m / 2 AS lx, sin(yaw_rad) * length_m / 2 AS ly,
        -sin(yaw_rad) * width_m / 2 AS wx, cos(yaw_rad) * width_m / 2 AS wy,
        CASE WHEN speed_mps < 0.05 THEN 0 ELSE 0.300 * v + 0.058 - 0.011 * v + 0.015 * v * v END AS sd
    FROM (SELECT *, speed_mps / 0.44704 AS v FROM state) m
) p;
CREATE INDEX ON placed (t_ns, ego);
ANALYZE placed;

-- @assert
CREATE UNLOGGED TABLE lane_of AS
SELECT p.actor_id, p.t_ns, l.lanelet_id FROM placed p JOIN lanelet l ON ST_Intersects(l.shape, p.centre);
CREATE UNLOGGED TABLE pair AS
SELECT o.t_ns, o.actor_id,
    CASE WHEN ST_DWithin(e.box, o.box, 30) THEN ST_Distance(e.box, o.box) END AS gap_m,
    coalesce(ST_Intersects(e.danger, o.box), false) AS in_ours,
    coalesce(ST_Intersects(e.box, o.danger), false) AS in_theirs,
    coalesce(ST_Intersects(e.danger, o.danger), false) AS both_spaces
FROM placed e JOIN placed o ON o.t_ns = e.t_ns AND NOT o.ego
WHERE e.ego;
SELECT (SELECT count(*) FROM lane_of), count(gap_m), coalesce(sum(gap_m), 0), count(*) FILTER (WHERE gap_m <= 0),
    count(*) FILTER (WHERE in_ours), count(*) FILTER (WHERE in_theirs), count(*) FILTER (WHERE both_spaces)
FROM pair;

-- @step
SELECT (SELECT count(*) FROM placed p JOIN lanelet l ON ST_Intersects(l.shape, p.centre) WHERE p.t_ns = {t_ns}),
    count(*) FILTER (WHERE ST_DWithin(e.box, o.box, 30)),
    coalesce(sum(ST_Distance(e.box, o.box)) FILTER (WHERE ST_DWithin(e.box, o.box, 30)), 0),
    count(*) FILTER (WHERE ST_Intersects(e.box, o.box)), count(*) FILTER (WHERE ST_Intersects(e.danger, o.box)),
    count(*) FILTER (WHERE ST_Intersects(e.box, o.danger)), count(*) FILTER (WHERE ST_Intersects(e.danger, o.danger))
FROM placed e JOIN placed o ON o.t_ns = e.t_ns AND NOT o.ego
WHERE e.ego AND e.t_ns = {t_ns};
