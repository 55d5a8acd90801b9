-- Plane geometry as arithmetic, so that no geometry object is built on the hot path.

-- Angle wrapped to [-pi, pi).
CREATE OR REPLACE MACRO wrap_rad(a) AS a - 2 * pi() * floor((a + pi()) / (2 * pi()));

-- Keys of the 2 m grid that finds lanes and of the 4 m grid that finds corridors.
-- The factor keeps cells of one map apart: no map is 4,000 km high.
CREATE OR REPLACE MACRO cell_key(ix, iy) AS ix::BIGINT * 1000003 + iy::BIGINT;
CREATE OR REPLACE MACRO lane_cell_of(x, y) AS cell_key(floor(x / 2), floor(y / 2));
CREATE OR REPLACE MACRO corridor_cell_of(x, y) AS cell_key(floor(x / 4), floor(y / 4));

-- A segment of a centre line with unit tangents t0, t1 at its ends claims the points between the normals at its ends:
-- a0 >= 0 behind the first, a1 > 0 before the second. Consecutive segments share a tangent, so they tile the strip.
CREATE OR REPLACE MACRO along0(x, y, x0, y0, tx0, ty0) AS (x - x0) * tx0 + (y - y0) * ty0;
CREATE OR REPLACE MACRO along1(x, y, x1, y1, tx1, ty1) AS (x1 - x) * tx1 + (y1 - y) * ty1;

-- Offset to the left of the centre line at the fraction u of a segment.
CREATE OR REPLACE MACRO offset_left(x, y, u, x0, y0, tx0, ty0, x1, y1, tx1, ty1) AS
    (y - y0 - u * (y1 - y0)) * (tx0 + u * (tx1 - tx0)) - (x - x0 - u * (x1 - x0)) * (ty0 + u * (ty1 - ty0));

-- Squared distance from a point, given in a box's own frame, to that box of half lengths hl, hw.
CREATE OR REPLACE MACRO outside2(px, py, hl, hw) AS
    CASE WHEN abs(px) > hl THEN (abs(px) - hl) ** 2 ELSE 0.0 END + CASE WHEN abs(py) > hw THEN (abs(py) - hw) ** 2 ELSE 0.0 END;

-- Least squared distance from the four corners of box b to box a. (dx, dy): centre of b in the frame of a; (c, s): cosine and
-- sine of b's heading in that frame.
CREATE OR REPLACE MACRO corners_outside2(dx, dy, c, s, hla, hwa, hlb, hwb) AS
    least(
        outside2(dx + c * hlb - s * hwb, dy + s * hlb + c * hwb, hla, hwa),
        outside2(dx + c * hlb + s * hwb, dy + s * hlb - c * hwb, hla, hwa),
        outside2(dx - c * hlb - s * hwb, dy - s * hlb + c * hwb, hla, hwa),
        outside2(dx - c * hlb + s * hwb, dy - s * hlb - c * hwb, hla, hwa)
    );

-- Largest separation of two boxes over their four axes; negative: the boxes overlap, by that depth (separating axis theorem).
CREATE OR REPLACE MACRO box_separation(dx, dy, c, s, hla, hwa, hlb, hwb) AS
    greatest(
        abs(dx) - hla - hlb * abs(c) - hwb * abs(s),
        abs(dy) - hwa - hlb * abs(s) - hwb * abs(c),
        abs(dx * c + dy * s) - hlb - hla * abs(c) - hwa * abs(s),
        abs(dy * c - dx * s) - hwb - hla * abs(s) - hwa * abs(c)
    );

-- Exact distance between two boxes; overlapping: minus the depth. Arguments as above; every one must be known.
-- Of two convex boxes apart, the nearest pair has a corner of one of them.
CREATE OR REPLACE MACRO box_clearance(dx, dy, c, s, hla, hwa, hlb, hwb) AS
    CASE
        WHEN box_separation(dx, dy, c, s, hla, hwa, hlb, hwb) <= 0 THEN box_separation(dx, dy, c, s, hla, hwa, hlb, hwb)
        ELSE sqrt(least(
            corners_outside2(dx, dy, c, s, hla, hwa, hlb, hwb),
            corners_outside2(-(dx * c + dy * s), -(dy * c - dx * s), c, -s, hlb, hwb, hla, hwa)
        ))
    END;

-- Depth of an overlap from its three one-sided depths; unknown as soon as one is (least() alone would leave it out).
CREATE OR REPLACE MACRO inside3(a, b, c) AS CASE WHEN a IS NOT NULL AND b IS NOT NULL AND c IS NOT NULL THEN least(a, b, c) END;

-- Lengths as whole picometres, and back: their running sums are the same to the last bit in every order and beside any other drive.
-- (A sum of doubles over a window is not: how it is split depends on what else is in the table.)
CREATE OR REPLACE MACRO whole_pm(x_m) AS round(1e12 * x_m)::HUGEINT;
CREATE OR REPLACE MACRO of_pm(x_pm) AS x_pm / 1e12;
