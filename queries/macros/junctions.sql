-- Numbers of the library where ways meet, named once.

-- Two ways that are used further apart in time than this do not concern each other.
CREATE OR REPLACE MACRO conflict_ns() AS 10_000_000_000;
-- Ways that meet at a smaller angle run along each other: that is following, not crossing or merging.
CREATE OR REPLACE MACRO conflict_angle_rad() AS radians(20);
-- Off the shared ground for longer than this, and back on it, is another encounter.
CREATE OR REPLACE MACRO conflict_apart_ns() AS 2_000_000_000;
-- Headings in steps of 5 degrees: those at most three steps apart differ by less than 20 degrees.
CREATE OR REPLACE MACRO heading_step(yaw_rad) AS floor(yaw_rad / radians(5))::INTEGER;
CREATE OR REPLACE MACRO steps_apart(a, b) AS abs(((a - b + 36) % 72 + 72) % 72 - 36);
-- Slower than this for at least a second is a standstill (UKHC and ALKS rules ask for a stop, not for slow driving).
CREATE OR REPLACE MACRO stood_mps() AS 0.1;
-- From one half of a pedestrian crossing to the other; who takes longer waits on an island between them.
CREATE OR REPLACE MACRO straight_on_ns() AS 3_000_000_000;
-- How far two boxes are apart (negative: how deep one is in the other) on the axis on which that is most, of the four of their sides: (dx, dy) from the first one's centre to the second one's in map axes, (ca, sa) and (cb, sb) the cosine and
-- sine of their headings.
CREATE OR REPLACE MACRO boxes_apart_m(dx, dy, ca, sa, cb, sb, hla, hwa, hlb, hwb) AS
    box_separation(dx * ca + dy * sa, dy * ca - dx * sa, ca * cb + sa * sb, ca * sb - sa * cb, hla, hwa, hlb, hwb);
-- The same for each of the eight sides (box_sides).
CREATE OR REPLACE MACRO boxes_sides(dx, dy, ca, sa, cb, sb, hla, hwa, hlb, hwb) AS
    box_sides(dx * ca + dy * sa, dy * ca - dx * sa, ca * cb + sa * sb, ca * sb - sa * cb, hla, hwa, hlb, hwb);
-- Two boxes overlap or touch.
CREATE OR REPLACE MACRO boxes_meet(dx, dy, ca, sa, cb, sb, hla, hwa, hlb, hwb) AS
    dx * dx + dy * dy <= (hla + hwa + hlb + hwb) * (hla + hwa + hlb + hwb)
    AND boxes_apart_m(dx, dy, ca, sa, cb, sb, hla, hwa, hlb, hwb) <= 0;
-- Faster than this nothing drives: it is a jump in the log.
CREATE OR REPLACE MACRO jump_mps() AS 70.0;
-- Half length of the ground that a box covers from one sample to the next: a log of few samples a second leaves no ground between two.
CREATE OR REPLACE MACRO swept_half_m(length_m, speed_mps, period_s) AS greatest(length_m, least(coalesce(speed_mps, 0.0), jump_mps()) * period_s) / 2;
-- The same with the whole box where it is at any moment halfway to the sample before and to the one after.
CREATE OR REPLACE MACRO driven_half_m(length_m, speed_mps, gap_s) AS (length_m + least(coalesce(speed_mps, 0.0), jump_mps()) * gap_s) / 2;
-- Grid of a drive, its cells as wide as two boxes reach: what touches has its centres in one cell or in neighbours.
CREATE OR REPLACE MACRO meeting_cell(x_m, y_m, cell_m) AS cell_key(floor(x_m / cell_m), floor(y_m / cell_m));
CREATE OR REPLACE MACRO meeting_slot(t_ns) AS (t_ns // conflict_ns())::INTEGER;
-- A signal and a stop line this far apart along the way belong together.
CREATE OR REPLACE MACRO line_reach_m() AS 30.0;
-- An arrow this far before a junction, or nearer, is for the turn there.
CREATE OR REPLACE MACRO turn_reach_m() AS 60.0;
-- What a change of heading (left positive) may be called by who set up the lights: a bend is called straight on here and a turn there.
CREATE OR REPLACE MACRO possible_turns(turn_rad) AS
    CASE WHEN abs(turn_rad) <= radians(45) THEN ['straight'] ELSE [] END
    || CASE WHEN turn_rad BETWEEN radians(10) AND radians(170) THEN ['left'] ELSE [] END
    || CASE WHEN turn_rad BETWEEN radians(-170) AND radians(-10) THEN ['right'] ELSE [] END
    || CASE WHEN abs(turn_rad) >= radians(135) THEN ['u_turn'] ELSE [] END;
-- A signal this far before a junction, and none in between, governs the way in.
CREATE OR REPLACE MACRO governed_m() AS 50.0;
-- Steps are kept from this far before a mark to as far beyond it.
CREATE OR REPLACE MACRO near_mark_m() AS 10.0;
-- "Nobody came" asks for the log to go on at least this long after the ego has left (twice what rules ask for).
CREATE OR REPLACE MACRO watched_ns() AS 4_000_000_000;
-- Who is unseen for a while this near to where ways meet, or could have come this near, may have been on them.
CREATE OR REPLACE MACRO meeting_near_m() AS 30.0;
-- Distance from a point to the piece from a to b metres along a straight line that begins at (x0, y0) with unit direction (tx, ty).
CREATE OR REPLACE MACRO end_distance_m(x, y, x0, y0, tx, ty, a, b) AS
    sqrt(
        ((x - x0) * tx + (y - y0) * ty - greatest(a, least(b, (x - x0) * tx + (y - y0) * ty))) ** 2 + ((y - y0) * tx - (x - x0) * ty) ** 2
    );
-- Braking that is more than letting off the accelerator: the least that any rule asks about.
CREATE OR REPLACE MACRO least_force_mps2() AS 1.5;
-- Our default: slowing that is not noise; a driver who sees from afar that he will have to wait lets the vehicle roll out.
CREATE OR REPLACE MACRO gentle_mps2() AS 0.3;
-- Our default: who waits goes on when the ego has as good as left, so long before, or has left, so long after.
CREATE OR REPLACE MACRO waits_ns() AS 2_000_000_000;
CREATE OR REPLACE MACRO goes_on_ns() AS 5_000_000_000;
-- A vehicle may have braked for the ego if, at the speed that it had, it would have arrived within this time before or after the ego.
CREATE OR REPLACE MACRO forced_apart_ns() AS 4_000_000_000;
CREATE OR REPLACE MACRO forced_slot(t_ns) AS t_ns // (2 * forced_apart_ns());
-- Within 30 degrees of the ego's way turned round, somebody comes head on.
CREATE OR REPLACE MACRO head_on_rad() AS 5 * pi() / 6;
-- Between the sides of two that meet head on, less is hardly room: mirrors take 0.2 m of it on each side.
CREATE OR REPLACE MACRO hardly_room_m() AS 0.5;
CREATE OR REPLACE MACRO forced_near_m() AS 200.0;
-- Drivers stop within this distance before a light or a queue.
CREATE OR REPLACE MACRO forced_beyond_m() AS 20.0;
-- A vehicle that would have more lateral acceleration than this in a bend slows down for the bend.
CREATE OR REPLACE MACRO bend_mps2() AS 3.0;
-- Where somebody came from at a junction, by its heading against the ego's on its way in.
CREATE OR REPLACE MACRO relation_of(from_rad) AS
    CASE
        WHEN abs(from_rad) >= radians(135) THEN 'oncoming' WHEN abs(from_rad) <= radians(45) THEN 'ahead_going'
        WHEN from_rad < 0 THEN 'from_left' WHEN from_rad IS NOT NULL THEN 'from_right'
    END;
-- So far from a junction people on foot still cross the mouth of the road.
CREATE OR REPLACE MACRO mouth_m() AS 12.0;
-- A way out that turns by so much more than another one leaves the road.
CREATE OR REPLACE MACRO fork_rad() AS radians(10);
-- Whether it came by the road that the ego's own goes on into: a bent one leads off at an angle, but not one that lies across (80 degrees).
CREATE OR REPLACE MACRO comes_by_road_ahead(from_rad, straightest_rad) AS
    abs(from_rad) >= pi() - least(greatest(radians(45), abs(straightest_rad) + fork_rad()), radians(80));
CREATE OR REPLACE MACRO relations_of(from_rad, straightest_rad) AS
    CASE WHEN comes_by_road_ahead(from_rad, straightest_rad) AND relation_of(from_rad) <> 'oncoming' THEN [relation_of(from_rad), 'oncoming'] ELSE [relation_of(from_rad)] END;
-- It went nearly straight on, but another way out goes on straighter: whether it turned off or its road bends there, maps do not say.
CREATE OR REPLACE MACRO at_fork(turn, turn_rad, straightest_rad) AS coalesce(turn = 'straight' AND abs(turn_rad) > abs(straightest_rad) + fork_rad(), false);
CREATE OR REPLACE MACRO fork_words() AS 'whether the ego turned off at the fork, or its road bends there, is not known';
