-- Shapes as geometries, for the candidates that remain after a fast check by arithmetic, and for output. All are in metres of the map, NULL
-- if an argument is NULL. `shapes_meet(danger_space(...), actor_box(...))` can be read as the rule's sentence.

-- Whether a shape has no position: it is empty, or a coordinate is not finite. DuckDB 1.5.5 makes an empty point of two NaN, and returns 0
-- for the distance to an empty shape.
CREATE OR REPLACE MACRO has_no_place(shape) AS
    -- The lambda makes the shape only once.
    list_transform([shape], lambda s: ST_IsEmpty(s) OR NOT isfinite(ST_Length(s) + ST_Perimeter(s))
        OR NOT isfinite(ST_XMin(s) + ST_XMax(s) + ST_YMin(s) + ST_YMax(s)) OR NOT (ST_XMin(s) <= ST_XMax(s) AND ST_YMin(s) <= ST_YMax(s)))[1];

-- The box of an actor: its centre, heading, length and width.
CREATE OR REPLACE MACRO actor_box(x_m, y_m, yaw_rad, length_m, width_m) AS
    ST_Affine(ST_MakeEnvelope(-length_m / 2, -width_m / 2, length_m / 2, width_m / 2), cos(yaw_rad), -sin(yaw_rad), sin(yaw_rad), cos(yaw_rad), x_m, y_m);

-- The danger space of an actor on a straight road: as wide as the actor, and from its front as long as its stopping distance (Harper et al.
-- 2021). In a bend it follows the lane: see overtake_step, and spaces.parquet for its shape.
CREATE OR REPLACE MACRO danger_space(x_m, y_m, yaw_rad, length_m, width_m, stopping_m) AS
    ST_Affine(ST_MakeEnvelope(length_m / 2, -width_m / 2, length_m / 2 + stopping_m, width_m / 2), cos(yaw_rad), -sin(yaw_rad), sin(yaw_rad), cos(yaw_rad), x_m, y_m);

-- The area that a box covers on its straight path from one position to the next: the convex hull of both.
CREATE OR REPLACE MACRO swept_path(from_box, to_box) AS
    CASE WHEN NOT has_no_place(from_box) AND NOT has_no_place(to_box) THEN ST_ConvexHull(ST_Collect([from_box, to_box])) END;

-- Whether two shapes have a point in common; NULL if one has no position.
CREATE OR REPLACE MACRO shapes_meet(a, b) AS CASE WHEN has_no_place(a) OR has_no_place(b) THEN NULL ELSE ST_Intersects(a, b) END;

-- The distance between two shapes, 0 if they touch; NULL if one has no position. For two separate polygons, DuckDB 1.5.5 returns an
-- ST_Distance of 0 if a corner of one is level with an edge of the other; ST_DWithin does the same. The distance of their boundaries is
-- right.
CREATE OR REPLACE MACRO apart_m(a, b) AS
    CASE
        WHEN has_no_place(a) OR has_no_place(b) THEN NULL
        WHEN ST_Intersects(a, b) THEN 0.0
        ELSE ST_Distance(CASE WHEN ST_Dimension(a) = 2 THEN ST_Boundary(a) ELSE a END, CASE WHEN ST_Dimension(b) = 2 THEN ST_Boundary(b) ELSE b END)
    END;

-- The corners of an outline.
CREATE OR REPLACE MACRO outline_points(outline_x_m, outline_y_m) AS list_transform(list_zip(outline_x_m, outline_y_m), lambda p: ST_Point(p[1], p[2]));

-- The area between two bounds: along the points of one, and back along those of the other. Bounds that cross each other, as in a bend
-- tighter than the lane is wide, give several areas.
CREATE OR REPLACE MACRO area_between(bound, opposite_bound_backwards) AS
    ST_MakePolygon(ST_MakeLine(list_concat(bound, opposite_bound_backwards, bound[1:1])));
CREATE OR REPLACE MACRO valid_area(area) AS CASE WHEN ST_IsValid(area) THEN area ELSE ST_CollectionExtract(ST_MakeValid(area), 3) END;
