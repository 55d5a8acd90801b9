-- Lanelets cut into straight pieces between consecutive points, with the tangents at both ends.
-- lifetime: map
CREATE TABLE _lane_segment (
    environment_id VARCHAR NOT NULL,  -- the map
    lanelet_id VARCHAR NOT NULL,      -- the lanelet
    k INTEGER NOT NULL,               -- number of the segment, which runs from point k to point k + 1
    s0_m DOUBLE NOT NULL,             -- station (distance along the lanelet's centre line) of the segment's start
    len_m DOUBLE NOT NULL,            -- length along the centre line
    x0_m DOUBLE NOT NULL,             -- start, x
    y0_m DOUBLE NOT NULL,             -- start, y
    tx0 DOUBLE NOT NULL,              -- unit tangent at the start, x
    ty0 DOUBLE NOT NULL,              -- unit tangent at the start, y
    hw0_m DOUBLE NOT NULL,            -- half width at the start
    x1_m DOUBLE NOT NULL,             -- end, x
    y1_m DOUBLE NOT NULL,             -- end, y
    tx1 DOUBLE NOT NULL,              -- unit tangent at the end, x
    ty1 DOUBLE NOT NULL,              -- unit tangent at the end, y
    hw1_m DOUBLE NOT NULL,            -- half width at the end
    slack0_m DOUBLE NOT NULL,         -- how far the segment extends beyond its start: 0.05 at the ends of the lanelet, where tangents may differ slightly; else 0
    slack1_m DOUBLE NOT NULL          -- how far the segment extends beyond its end, as slack0_m
);

INSERT INTO _lane_segment BY NAME
SELECT
    environment_id, lanelet_id, k, s_m AS s0_m, next.s_m - s_m AS len_m,
    x_m AS x0_m, y_m AS y0_m, tx AS tx0, ty AS ty0, half_width_m AS hw0_m,
    next.x_m AS x1_m, next.y_m AS y1_m, next.tx AS tx1, next.ty AS ty1, next.half_width_m AS hw1_m,
    CASE WHEN k = 0 THEN 0.05 ELSE 0.0 END AS slack0_m,
    CASE WHEN next.is_last THEN 0.05 ELSE 0.0 END AS slack1_m
FROM (
    SELECT
        *,
        lead({
            's_m': s_m, 'x_m': x_m, 'y_m': y_m, 'tx': tx, 'ty': ty, 'half_width_m': half_width_m,
            'is_last': k = n_points - 1
        }) OVER (PARTITION BY environment_id, lanelet_id ORDER BY k) AS next
    FROM (SELECT *, count(*) OVER (PARTITION BY environment_id, lanelet_id) AS n_points FROM lane_point)
)
WHERE next IS NOT NULL AND next.s_m > s_m
