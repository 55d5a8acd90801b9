-- Constants and macros for junctions, stop lines, crossings and conflict areas.

-- If two actors are on the same ground at times further apart than this, there is no conflict between them.
CREATE OR REPLACE MACRO conflict_ns() AS 10_000_000_000;
-- Paths that meet at a smaller angle than this have the same direction: one actor follows the other, and the paths do not cross or merge.
CREATE OR REPLACE MACRO conflict_angle_rad() AS radians(20);
-- An actor that leaves the common ground for longer than this and then returns begins another encounter.
CREATE OR REPLACE MACRO conflict_apart_ns() AS 2_000_000_000;
-- Headings in steps of 5 degrees: those at most three steps apart differ by less than 20 degrees.
CREATE OR REPLACE MACRO heading_step(yaw_rad) AS floor(yaw_rad / radians(5))::INTEGER;
CREATE OR REPLACE MACRO heading_steps_apart(a, b) AS abs(((a - b + 36) % 72 + 72) % 72 - 36);
-- An actor that is slower than this for at least a second stands still (UKHC and ALKS rules demand a stop, not slow driving).
CREATE OR REPLACE MACRO standstill_mps() AS 0.1;
-- The longest time from one half of a pedestrian crossing to the other. A person who takes longer waits on an island between the two.
CREATE OR REPLACE MACRO half_to_half_ns() AS 3_000_000_000;
-- The largest separation of two boxes over their four axes (negative: the depth of their overlap). (dx, dy) leads from the centre of the
-- first box to that of the second in map axes; (ca, sa) and (cb, sb) are the cosine and sine of their headings.
CREATE OR REPLACE MACRO boxes_apart_m(dx, dy, ca, sa, cb, sb, hla, hwa, hlb, hwb) AS
    box_separation(dx * ca + dy * sa, dy * ca - dx * sa, ca * cb + sa * sb, ca * sb - sa * cb, hla, hwa, hlb, hwb);
-- The same for each of the eight sides (box_sides).
CREATE OR REPLACE MACRO boxes_sides(dx, dy, ca, sa, cb, sb, hla, hwa, hlb, hwb) AS
    box_sides(dx * ca + dy * sa, dy * ca - dx * sa, ca * cb + sa * sb, ca * sb - sa * cb, hla, hwa, hlb, hwb);
-- Whether two boxes overlap or touch.
CREATE OR REPLACE MACRO boxes_meet(dx, dy, ca, sa, cb, sb, hla, hwa, hlb, hwb) AS
    dx * dx + dy * dy <= (hla + hwa + hlb + hwb) * (hla + hwa + hlb + hwb)
    AND boxes_apart_m(dx, dy, ca, sa, cb, sb, hla, hwa, hlb, hwb) <= 0;
-- No actor drives faster than this: a higher speed is a jump in the log.
CREATE OR REPLACE MACRO jump_mps() AS 70.0;
-- Half length of the ground that a box covers from one sample to the next, so that the ground between two samples is complete even in a log
-- with few samples a second.
CREATE OR REPLACE MACRO swept_half_m(length_m, speed_mps, period_s) AS greatest(length_m, least(coalesce(speed_mps, 0.0), jump_mps()) * period_s) / 2;
-- Half length of the ground that a box covers at any moment between halfway to the sample before and halfway to the sample after.
CREATE OR REPLACE MACRO driven_half_m(length_m, speed_mps, gap_s) AS (length_m + least(coalesce(speed_mps, 0.0), jump_mps()) * gap_s) / 2;
-- Grid of a drive. A cell is as wide as the greatest distance between the centres of two boxes that touch: such centres are in one cell or
-- in neighbouring cells.
CREATE OR REPLACE MACRO meeting_cell(x_m, y_m, cell_m) AS cell_key(floor(x_m / cell_m), floor(y_m / cell_m));
CREATE OR REPLACE MACRO meeting_slot(t_ns) AS (t_ns // conflict_ns())::INTEGER;
-- A signal and a stop line that are at most this far apart along the chain belong together.
CREATE OR REPLACE MACRO line_reach_m() AS 30.0;
-- An arrow at most this far before a junction is for the turn there.
CREATE OR REPLACE MACRO turn_reach_m() AS 60.0;
-- The turns that the designer of the lights may have meant for a change of heading (left positive): the same bend may be called straight on
-- at one place and a turn at another.
CREATE OR REPLACE MACRO possible_turns(turn_rad) AS
    CASE WHEN abs(turn_rad) <= radians(45) THEN ['straight'] ELSE [] END
    || CASE WHEN turn_rad BETWEEN radians(10) AND radians(170) THEN ['left'] ELSE [] END
    || CASE WHEN turn_rad BETWEEN radians(-170) AND radians(-10) THEN ['right'] ELSE [] END
    || CASE WHEN abs(turn_rad) >= radians(135) THEN ['u_turn'] ELSE [] END;
-- A signal at most this far before a junction, with no other junction in between, governs the entry.
CREATE OR REPLACE MACRO governed_m() AS 50.0;
-- _near_mark has the steps from this far before a mark (a junction, a stop line or a crossing, see way_mark) until this far beyond it.
CREATE OR REPLACE MACRO near_mark_m() AS 10.0;
-- A vehicle that turns into the ego's road this long after the ego may only follow it, or may have had to wait for it.
CREATE OR REPLACE MACRO merging_s() AS 1.0;
-- The least time that a rule requires between the ego and another vehicle at a junction.
CREATE OR REPLACE MACRO least_junction_s() AS 2.0;
-- To state that no actor came, the log must continue for at least this long after the ego has left (twice the time that rules require).
CREATE OR REPLACE MACRO watched_ns() AS 4_000_000_000;
-- An actor that is not seen for a while may have been at a junction or crossing if it was this near, or could have come this near.
CREATE OR REPLACE MACRO meeting_near_m() AS 30.0;
-- Distance from a point to the piece from a to b metres along a straight line that begins at (x0, y0) with unit direction (tx, ty).
CREATE OR REPLACE MACRO piece_distance_m(x, y, x0, y0, tx, ty, a, b) AS
    sqrt(
        ((x - x0) * tx + (y - y0) * ty - greatest(a, least(b, (x - x0) * tx + (y - y0) * ty))) ** 2 + ((y - y0) * tx - (x - x0) * ty) ** 2
    );
-- An impact: two boxes are this near, and one of the two loses or gains speed faster than dry tyres can. As in the rule contact-signature.
CREATE OR REPLACE MACRO impact_within_m() AS 0.5;
CREATE OR REPLACE MACRO tyre_mps2() AS 12.0;
-- The jolt of a pair: the greatest change of speed of the two. For an actor that may be on foot, only a loss counts: recorded speeds of
-- pedestrians jump.
CREATE OR REPLACE MACRO jolt_mps2(actor_class, accel_mps2, ego_accel_mps2) AS
    greatest(-accel_mps2, CASE WHEN NOT may_walk(actor_class) THEN accel_mps2 END, abs(ego_accel_mps2));
-- A deceleration beyond releasing the accelerator: the lowest that any rule uses.
CREATE OR REPLACE MACRO least_braking_mps2() AS 1.5;
-- Our default: a deceleration that is not noise. A driver who sees early that they must wait lets the vehicle roll out.
CREATE OR REPLACE MACRO gentle_mps2() AS 0.3;
-- Our default: a vehicle that waits for the ego moves off at most waits_ns before the ego has left, and at most drives_on_ns after that.
CREATE OR REPLACE MACRO waits_ns() AS 2_000_000_000;
CREATE OR REPLACE MACRO drives_on_ns() AS 5_000_000_000;
-- A vehicle may have braked for the ego if, at its speed before, it would have arrived within this time before or after the ego.
CREATE OR REPLACE MACRO forced_apart_ns() AS 4_000_000_000;
CREATE OR REPLACE MACRO forced_slot(t_ns) AS t_ns // (2 * forced_apart_ns());
-- An actor comes head on if its path is within 30 degrees of the reverse of the ego's path.
CREATE OR REPLACE MACRO head_on_rad() AS 5 * pi() / 6;
-- Two actors that meet head on have hardly any room if their sides are nearer to each other than this: mirrors use 0.2 m of it on each
-- side.
CREATE OR REPLACE MACRO hardly_room_m() AS 0.5;
-- Actors farther away than this are not examined for braking that the ego forced.
CREATE OR REPLACE MACRO forced_near_m() AS 200.0;
-- Drivers stop within this distance before a light or a queue.
CREATE OR REPLACE MACRO stopping_before_m() AS 20.0;
-- Our limit for a bend: a vehicle that would have more lateral acceleration slows down for the bend.
CREATE OR REPLACE MACRO bend_mps2() AS 3.0;
-- The direction from which an actor came at a junction, by its heading relative to the ego's heading at the entry.
CREATE OR REPLACE MACRO relation_of(from_rad) AS
    CASE
        WHEN abs(from_rad) >= radians(135) THEN 'oncoming' WHEN abs(from_rad) <= radians(45) THEN 'ahead_going'
        WHEN from_rad < 0 THEN 'from_left' WHEN from_rad IS NOT NULL THEN 'from_right'
    END;
-- Pedestrians cross the mouth of the road at most this far from a junction.
CREATE OR REPLACE MACRO mouth_m() AS 12.0;
-- If a way out turns by this much more than another way out, it leads off the road.
CREATE OR REPLACE MACRO fork_rad() AS radians(10);
-- Whether an actor came from the road into which the ego's own road continues. That road may bend and lead off at an angle of up to 80
-- degrees: a road at a greater angle crosses.
CREATE OR REPLACE MACRO comes_by_road_ahead(from_rad, straightest_rad) AS
    abs(from_rad) >= pi() - least(greatest(radians(45), abs(straightest_rad) + fork_rad()), radians(80));
-- The relations of an actor, as a list: the result of relation_of, and oncoming as well if the actor came from the road ahead although that
-- road leads off at an angle.
CREATE OR REPLACE MACRO relations_of(from_rad, straightest_rad) AS
    CASE WHEN comes_by_road_ahead(from_rad, straightest_rad) AND relation_of(from_rad) <> 'oncoming' THEN [relation_of(from_rad), 'oncoming'] ELSE [relation_of(from_rad)] END;
-- Whether the ego went nearly straight on while another way out is straighter. The map does not state whether the ego turned off there or
-- its road bends.
CREATE OR REPLACE MACRO at_fork(turn, turn_rad, straightest_rad) AS coalesce(turn = 'straight' AND abs(turn_rad) > abs(straightest_rad) + fork_rad(), false);
-- The reason why it is not known whether the ego turned across the road: its turn is not recorded, or the driving side is not known.
CREATE OR REPLACE MACRO across_doubt(turn) AS CASE WHEN turn IS NULL THEN why('turn_across_unknown') ELSE why('turn_side_unknown') END;
CREATE OR REPLACE MACRO fork_doubt() AS why('fork');
