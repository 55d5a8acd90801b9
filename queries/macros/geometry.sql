-- Plane geometry as arithmetic. It is fast, and so used for values of every row, and for the depth of an overlap, which no ST_ function
-- returns. shapes.sql has shapes for the ST_ functions; tests check that both give the same results.

-- Angle wrapped to [-pi, pi).
CREATE OR REPLACE MACRO wrap_rad(a) AS a - 2 * pi() * floor((a + pi()) / (2 * pi()));

-- Direction in which an actor travels: that of its motion if it moves, else its heading. A vehicle travels in the direction of its heading
-- or straight back (`backs`: its velocity points backwards at this sample and at those before and after it; an impact lasts only one
-- sample). An actor that is or may be on foot travels in any direction. Below moves_mps, a motion is noise.
CREATE OR REPLACE MACRO moves_mps() AS 1.5;
CREATE OR REPLACE MACRO travel_rad(actor_class, speed_mps, vx_mps, vy_mps, yaw_rad, backs) AS
    CASE
        WHEN may_walk(actor_class) AND speed_mps > standing_mps() THEN atan2(vy_mps, vx_mps)
        WHEN speed_mps > moves_mps() AND backs THEN wrap_rad(yaw_rad + pi())
        ELSE yaw_rad
    END;
-- The heading of a box, turned by 180 degrees if it travels backwards: the two ends of a box are equal.
CREATE OR REPLACE MACRO yaw_along_travel_rad(yaw_rad, travel_rad) AS CASE WHEN cos(travel_rad - yaw_rad) < 0 THEN wrap_rad(yaw_rad + pi()) ELSE yaw_rad END;

-- The angle by which a box turns, in [-pi/2, pi/2): a box that is turned by 180 degrees covers the same ground.
CREATE OR REPLACE MACRO box_turn_rad(a) AS a - pi() * floor((a + pi() / 2) / pi());

-- Keys of the 2 m grid that finds lanes and of the 4 m grid that finds corridors. The factor gives every cell of a map its own key: no map
-- extends 2,000 km from south to north (4,000 km on the 4 m grid).
CREATE OR REPLACE MACRO cell_key(ix, iy) AS ix::BIGINT * 1000003 + iy::BIGINT;
CREATE OR REPLACE MACRO lane_cell_of(x, y) AS cell_key(floor(x / 2), floor(y / 2));
CREATE OR REPLACE MACRO corridor_cell_of(x, y) AS cell_key(floor(x / 4), floor(y / 4));

-- A segment of a centre line with unit tangents t0, t1 at its ends contains the points between the normals at its ends: along0 >= 0 beyond
-- the first normal, along1 > 0 before the second one. Consecutive segments share a tangent, so that they tile the strip.
CREATE OR REPLACE MACRO along0(x, y, x0, y0, tx0, ty0) AS (x - x0) * tx0 + (y - y0) * ty0;
CREATE OR REPLACE MACRO along1(x, y, x1, y1, tx1, ty1) AS (x1 - x) * tx1 + (y1 - y) * ty1;

-- Offset to the left of the centre line at the fraction u of a segment.
CREATE OR REPLACE MACRO offset_left(x, y, u, x0, y0, tx0, ty0, x1, y1, tx1, ty1) AS
    (y - y0 - u * (y1 - y0)) * (tx0 + u * (tx1 - tx0)) - (x - x0 - u * (x1 - x0)) * (ty0 + u * (ty1 - ty0));

-- Squared distance from a point, given in a box's own frame, to that box of half lengths hl, hw.
CREATE OR REPLACE MACRO squared_distance_to_box(px, py, hl, hw) AS
    greatest(abs(px) - hl, 0.0) ** 2 + greatest(abs(py) - hw, 0.0) ** 2;

-- Least squared distance from the four corners of box b to box a. (dx, dy): centre of b in the frame of a; (c, s): cosine and sine of b's
-- heading in that frame.
CREATE OR REPLACE MACRO squared_distance_of_corners_to_box(dx, dy, c, s, hla, hwa, hlb, hwb) AS
    least(
        squared_distance_to_box(dx + c * hlb - s * hwb, dy + s * hlb + c * hwb, hla, hwa),
        squared_distance_to_box(dx + c * hlb + s * hwb, dy + s * hlb - c * hwb, hla, hwa),
        squared_distance_to_box(dx - c * hlb - s * hwb, dy - s * hlb + c * hwb, hla, hwa),
        squared_distance_to_box(dx - c * hlb + s * hwb, dy - s * hlb - c * hwb, hla, hwa)
    );

-- Largest separation of two boxes over their four axes; negative: the boxes overlap, by that depth (separating axis theorem).
CREATE OR REPLACE MACRO box_separation(dx, dy, c, s, hla, hwa, hlb, hwb) AS
    greatest(
        abs(dx) - hla - hlb * abs(c) - hwb * abs(s),
        abs(dy) - hwa - hlb * abs(s) - hwb * abs(c),
        abs(dx * c + dy * s) - hlb - hla * abs(c) - hwa * abs(s),
        abs(dy * c - dx * s) - hwb - hla * abs(s) - hwa * abs(c)
    );

-- Depth of the overlap of two boxes; negative: they are apart. NULL if an argument is NULL (greatest() alone would ignore it).
CREATE OR REPLACE MACRO box_depth(dx, dy, c, s, hla, hwa, hlb, hwb) AS
    CASE WHEN dx + dy + c + s + hla + hwa + hlb + hwb IS NOT NULL THEN -box_separation(dx, dy, c, s, hla, hwa, hlb, hwb) END;

-- The separation for each of the eight sides of the four axes, as a list: the boxes touch if none of them is positive.
CREATE OR REPLACE MACRO box_sides(dx, dy, c, s, hla, hwa, hlb, hwb) AS
    [
        dx - hla - hlb * abs(c) - hwb * abs(s), -dx - hla - hlb * abs(c) - hwb * abs(s),
        dy - hwa - hlb * abs(s) - hwb * abs(c), -dy - hwa - hlb * abs(s) - hwb * abs(c),
        dx * c + dy * s - hlb - hla * abs(c) - hwa * abs(s), -dx * c - dy * s - hlb - hla * abs(c) - hwa * abs(s),
        dy * c - dx * s - hwb - hla * abs(s) - hwa * abs(c), dx * s - dy * c - hwb - hla * abs(s) - hwa * abs(c)
    ];

-- The share of the path from one moment to another after which a box that moves straight on first touches another box; NULL: it does not
-- touch it on that path. `a` and `b` are the sides (box_sides) at the two moments; each side changes linearly. The contact begins when the
-- last side stops being positive (contact_begins) and ends when the first side becomes positive (contact_ends).
CREATE OR REPLACE MACRO contact_begins(a, b) AS
    list_max(list_transform(list_zip(a, b), lambda g: CASE WHEN g[1] <= 0 THEN 0.0 WHEN g[2] > 0 THEN 2.0 ELSE g[1] / (g[1] - g[2]) END));
CREATE OR REPLACE MACRO contact_ends(a, b) AS
    list_min(list_transform(list_zip(a, b), lambda g: CASE WHEN g[2] <= 0 THEN 1.0 WHEN g[1] > 0 THEN -1.0 ELSE g[1] / (g[1] - g[2]) END));
CREATE OR REPLACE MACRO first_touch(a, b) AS CASE WHEN contact_begins(a, b) <= contact_ends(a, b) THEN contact_begins(a, b) END;

-- Exact distance between two boxes; if they overlap, minus the depth. Arguments as above; all must be known. If two convex boxes are apart,
-- at least one of their two nearest points is a corner. (ST_Distance of two polygons cannot be used: see apart_m in shapes.sql.)
CREATE OR REPLACE MACRO box_clearance(dx, dy, c, s, hla, hwa, hlb, hwb) AS
    CASE
        WHEN box_separation(dx, dy, c, s, hla, hwa, hlb, hwb) <= 0 THEN box_separation(dx, dy, c, s, hla, hwa, hlb, hwb)
        ELSE sqrt(least(
            squared_distance_of_corners_to_box(dx, dy, c, s, hla, hwa, hlb, hwb),
            squared_distance_of_corners_to_box(-(dx * c + dy * s), -(dy * c - dx * s), c, -s, hlb, hwb, hla, hwa)
        ))
    END;

-- Depth of the overlap of two boxes along the lane: the least of its depths from the front, from the rear and across; NULL if one of these
-- is NULL (least() alone would ignore it).
CREATE OR REPLACE MACRO least_of_three(a, b, c) AS CASE WHEN a IS NOT NULL AND b IS NOT NULL AND c IS NOT NULL THEN least(a, b, c) END;

-- The depth of the overlap of two boxes whose overlap is known along one axis only. If they are apart along this axis, it is this
-- (negative) value; else NULL, because they may be apart along another axis.
CREATE OR REPLACE MACRO depth_if_apart(along_m) AS CASE WHEN along_m < 0 THEN along_m END;

-- Lengths in whole picometres, and back. Their running sums are exact: the same in any order, whatever other drives are in the table. (A
-- window sum of doubles depends on the other rows of the table, because these change how it is split.)
CREATE OR REPLACE MACRO to_picometres(x_m) AS round(1e12 * x_m)::HUGEINT;
CREATE OR REPLACE MACRO from_picometres(x_pm) AS x_pm / 1e12;

-- Motion between two samples: the greatest acceleration by braking or swerving, which is the limit of tyres.
CREATE OR REPLACE MACRO swerve_mps2() AS 8.0;
-- The greatest speed that a vehicle can have had between two samples with the speeds v and v_next: it accelerates by at most 3.5 m/s2 (a
-- brisk start), then brakes as hard as tyres allow. After the last sample of a stretch (v_next is NULL), the result is v.
CREATE OR REPLACE MACRO peak_between_mps(v_mps, v_next_mps, dt_s) AS
    greatest(v_mps, (swerve_mps2() * v_mps + 3.5 * v_next_mps + dt_s * 3.5 * swerve_mps2()) / (3.5 + swerve_mps2()));
-- The least speed that a vehicle can have had between two samples with the speeds v and v_next: it brakes as hard as tyres allow, then
-- starts briskly. One of the two speeds may be NULL: not known.
CREATE OR REPLACE MACRO trough_between_mps(v_mps, v_next_mps, dt_s) AS
    greatest(0.0, CASE
        WHEN v_next_mps IS NULL THEN v_mps - swerve_mps2() * dt_s
        WHEN v_mps IS NULL THEN v_next_mps - 3.5 * dt_s
        ELSE least(v_mps, v_next_mps, (3.5 * v_mps + swerve_mps2() * v_next_mps - dt_s * 3.5 * swerve_mps2()) / (3.5 + swerve_mps2())) END);
-- Upper bound of a speed that is not known.
CREATE OR REPLACE MACRO unknown_speed_mps() AS 40.0;
-- The least and the greatest distance that a vehicle with the speed v drives in the t seconds after, or before. It brakes or accelerates by
-- at most 10 m/s2, neither turns round nor reverses, and drives at 40 m/s at most, unless it is already faster.
CREATE OR REPLACE MACRO drives_least_m(v_mps, t_s) AS CASE WHEN 10.0 * t_s < v_mps THEN v_mps * t_s - 5.0 * t_s * t_s ELSE v_mps * v_mps / 20.0 END;
CREATE OR REPLACE MACRO drives_most_m(v_mps, t_s) AS least(v_mps * t_s + 5.0 * t_s * t_s, greatest(v_mps, unknown_speed_mps()) * t_s);
-- If everything within this distance around the ego is in plain view, no vehicle can pass it unseen in two lanes on either side. Even at
-- the greatest speed difference in the same direction, a passing vehicle stays within this distance for longer than a tracker's delay plus
-- one step.
CREATE OR REPLACE MACRO watched_m(v_mps, step_s) AS
    sqrt(7.0 ** 2 + (greatest(v_mps, unknown_speed_mps() - v_mps) * (track_delay_ns() / 1e9 + step_s) / 2) ** 2);

-- The path of a box from one sample to the next, as a cubic. (x, y) is the chord, from the first position to the second. p: where the
-- velocity at the start would lead, minus where the chord leads; q: the same for the velocity at the end. Velocities that tyres cannot
-- produce on that path are left out (then `told` is false).
CREATE OR REPLACE MACRO between_way(x0, y0, x1, y1, vx0, vy0, vx1, vy1, dt_s) AS
    CASE
        WHEN coalesce(greatest((vx0 * dt_s - x1 + x0) ** 2 + (vy0 * dt_s - y1 + y0) ** 2, (vx1 * dt_s - x1 + x0) ** 2 + (vy1 * dt_s - y1 + y0) ** 2)
            <= (swerve_mps2() * dt_s ** 2 / 2) ** 2, false)
        THEN {
            'told': true, 'x': x1 - x0, 'y': y1 - y0, 'px': vx0 * dt_s - x1 + x0, 'py': vy0 * dt_s - y1 + y0, 'qx': vx1 * dt_s - x1 + x0, 'qy': vy1 * dt_s - y1 + y0,
            'long_m': (sqrt(vx0 ** 2 + vy0 ** 2) + sqrt(vx1 ** 2 + vy1 ** 2)) * dt_s / 2
        }
        ELSE {
            'told': false, 'x': x1 - x0, 'y': y1 - y0, 'px': 0.0::DOUBLE, 'py': 0.0::DOUBLE, 'qx': 0.0::DOUBLE, 'qy': 0.0::DOUBLE,
            'long_m': sqrt((x1 - x0) ** 2 + (y1 - y0) ** 2)
        }
    END;
-- Error bound of that path, if the acceleration of the box is at most a = swerve_mps2: a dt^2 / 16 for the cubic (Peano kernel), a dt^2 / 8
-- for the chord.
CREATE OR REPLACE MACRO between_blur_m(way, dt_s) AS swerve_mps2() * dt_s ** 2 / CASE WHEN way.told THEN 16 ELSE 8 END;
-- Position of the object relative to the ego after the fraction u of that time, on one axis. a: its position at the start, g: the change of
-- this position, p and q as above.
CREATE OR REPLACE MACRO between_offset(u, a, g, p, q) AS a + g * u + p * u * (1 - u) ** 2 - q * u ** 2 * (1 - u);

-- The ego's own path: the distance between its points, and the length by which it is extrapolated with constant curvature beyond its
-- recorded end (3 s at the last speed).
CREATE OR REPLACE MACRO way_point_m() AS 2.0;
CREATE OR REPLACE MACRO way_on_m(v_mps) AS greatest(25.0, 3.0 * coalesce(v_mps, 0.0));
-- The name of the lanelet that a piece of the ego's own path forms, and how much wider than the ego's box it is on each side.
CREATE OR REPLACE MACRO own_lanelet(seg) AS 'own way ' || seg;
CREATE OR REPLACE MACRO own_lane_beside_m() AS 0.2;
-- The sharpest bend: no vehicle turns with a radius of less than 4 m.
CREATE OR REPLACE MACRO sharpest_bend_per_m() AS 0.25;
-- How far the ego may deviate from a path of constant curvature, after on_m at the speed v. Roads begin to bend with a radius of at least
-- 100 m, and drivers change the lateral acceleration by at most 1 m/s2 unless they turn off.
CREATE OR REPLACE MACRO bends_otherwise_m(on_m, v_mps) AS least(0.01 / 2 * greatest(0.0, on_m) ** 2, 1.0 / 2 * (greatest(0.0, on_m) / nullif(v_mps, 0)) ** 2);
-- Offset of the point (dx, dy) to the left of an arc that starts at the origin along x with the curvature bend_per_m.
CREATE OR REPLACE MACRO arc_offset_m(dx, dy, bend_per_m) AS
    (2 * dy - bend_per_m * (dx * dx + dy * dy)) / (1 + sqrt(greatest(0.0, 1 - bend_per_m * (2 * dy - bend_per_m * (dx * dx + dy * dy)))));
-- Half the extent of a box across a direction from which it is turned by turn_rad.
CREATE OR REPLACE MACRO box_half_across_m(length_m, width_m, turn_rad) AS length_m / 2 * abs(sin(turn_rad)) + width_m / 2 * abs(cos(turn_rad));
-- Half the width of the strip that a box sweeps in a bend: its outer corners extend beyond its side.
CREATE OR REPLACE MACRO swept_in_bend_half_m(length_m, width_m, bend_per_m) AS width_m / 2 + length_m ** 2 / 8 * abs(bend_per_m);
-- A box is outside the ego's own path if the path passes it at this distance or more: positions of standing vehicles have a noise of some
-- 0.1 m.
CREATE OR REPLACE MACRO passes_beside_m() AS 0.2;
-- An ego swerves if it steers round a vehicle that it would have hit within this time: one second of reaction and one of steering.
CREATE OR REPLACE MACRO late_s() AS 2.0;
-- An ego that needs less lateral acceleration than this to leave its course steers round a vehicle in good time: UN R79 allows an automatic
-- lane change 1 m/s2 in addition to that of the bend. An ego with more than swerves_from_mps2 swerves, even if it needed less.
CREATE OR REPLACE MACRO changes_lane_mps2() AS 1.0;
CREATE OR REPLACE MACRO swerves_from_mps2() AS 2.5;
-- No vehicle can leave a course in less time: an actor that is nearer, and is not hit, was passed.
CREATE OR REPLACE MACRO steering_s() AS 0.5;
