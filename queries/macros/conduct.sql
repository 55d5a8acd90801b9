-- Constants and measures of the ego's conduct.

-- Least-squares slope per second from whole-number sums over n samples: t in ns, y in billionths of its unit.
CREATE OR REPLACE MACRO exact_slope(n, sum_t, sum_y, sum_ty, sum_tt) AS
    (n * sum_ty - sum_t * sum_y)::DOUBLE / nullif(n * sum_tt - sum_t * sum_t, 0)::DOUBLE;

-- That slope with its standard error, from the deviation of the samples from the line; the error is NULL for less than three samples.
CREATE OR REPLACE MACRO line_through(n, sum_t, sum_y, sum_ty, sum_tt, sum_yy) AS {
    'slope': exact_slope(n, sum_t, sum_y, sum_ty, sum_tt),
    'error': sqrt(greatest(0.0, (n * sum_yy - sum_y * sum_y)::DOUBLE - (n * sum_ty - sum_t * sum_y)::DOUBLE ** 2 / nullif(n * sum_tt - sum_t * sum_t, 0)::DOUBLE)
        / nullif(greatest(n - 2, 0), 0) / nullif(n * sum_tt - sum_t * sum_t, 0)::DOUBLE)
};
-- The contradiction between two slopes of the same quantity: their difference beyond twice the error of the second slope.
CREATE OR REPLACE MACRO contradiction(slope, other, other_error) AS greatest(0.0, abs(slope - other) - 2 * other_error);

-- Half width of the window in which the ego's motion is filtered: 0.25 s, or 2.2 periods if that is more. NULL in logs with less than 5
-- samples a second; a period of 200 ms may be recorded as 201 ms.
CREATE OR REPLACE MACRO filter_half_ns(period_ns) AS
    CASE WHEN period_ns <= 210_000_000 THEN greatest(250_000_000, (2.2 * period_ns)::BIGINT) END;

-- How much further a value is from zero than the values half a window before and after it; 0 if it is not, or if one of the three values is
-- not known. A mean over the window lowers a pointed peak by at most 0.7 of this (at 20 samples a second or more), and a round peak by 0.2.
-- A slope is such a mean, too: a weighted mean of the derivative.
CREATE OR REPLACE MACRO peak_rise(value, past, next) AS
    CASE WHEN value + past + next IS NOT NULL THEN greatest(0.0, abs(value) - greatest(sign(value) * past, sign(value) * next)) ELSE 0.0 END;

-- Whether the samples of a window extend over 0.7 of its half width on both sides.
CREATE OR REPLACE MACRO whole_window(t_ns, first_ns, last_ns, half_ns) AS
    t_ns - first_ns >= 0.7 * half_ns AND last_ns - t_ns >= 0.7 * half_ns;

-- Half width of the window over which the jerk is the slope of the acceleration: 15 samples at 10 Hz.
CREATE OR REPLACE MACRO jerk_half_ns() AS 700_000_000;
-- Whether the samples of that window extend over 0.6 s on both sides, as they do at 5 Hz.
CREATE OR REPLACE MACRO whole_jerk_window(t_ns, first_ns, last_ns) AS t_ns - first_ns >= 590_000_000 AND last_ns - t_ns >= 590_000_000;

-- An unseen actor approaches the ego at unseen_closing_mps at most.
CREATE OR REPLACE MACRO unseen_closing_mps() AS 60.0;
-- Half the diagonal of the largest lorry (18.75 m by 2.55 m), and the sum of that and the half diagonal of a car.
CREATE OR REPLACE MACRO largest_half_diagonal_m() AS 9.5;
CREATE OR REPLACE MACRO both_half_diagonals_m() AS 12.0;

-- A recorder that loses an actor in plain view finds it again within longest_track_gap_ns. A new actor is recorded within track_delay_ns
-- after it came into view.
CREATE OR REPLACE MACRO longest_track_gap_ns() AS 2_500_000_000;
CREATE OR REPLACE MACRO track_delay_ns() AS 500_000_000;
-- Our default: an actor that was further from the ego than this just before its track began was not near (before_track).
CREATE OR REPLACE MACRO near_before_track_m() AS 1.0;
-- Error bound of a recorded position.
CREATE OR REPLACE MACRO sight_error_m() AS 1.0;
-- A lane is straight if its centre line deviates from its tangent by less than this: no object beside the lane is then between two points
-- on it.
CREATE OR REPLACE MACRO straight_m() AS 0.5;
-- Distance between the points on a lane that are tested for visibility. No vehicle fits into the hidden area of a box between two of them.
CREATE OR REPLACE MACRO sight_step_m() AS 2.0;
-- Our default: a box that reaches into a lane by less than this hides no vehicle that stands in the lane.
CREATE OR REPLACE MACRO hides_vehicle_m() AS 0.5;
-- Whether a box at (x, y) from the observer is in the line of sight to the point at (dx, dy) from the observer.
CREATE OR REPLACE MACRO blocks_sight(x_m, y_m, dx_m, dy_m, yaw_rad, length_m, width_m) AS
    x_m * dx_m + y_m * dy_m BETWEEN 0 AND dx_m ** 2 + dy_m ** 2
    AND abs(x_m * dy_m - y_m * dx_m)
        < length_m / 2 * abs(sin(yaw_rad) * dx_m - cos(yaw_rad) * dy_m) + width_m / 2 * abs(cos(yaw_rad) * dx_m + sin(yaw_rad) * dy_m);
-- The same for a box whose heading or size is not known.
CREATE OR REPLACE MACRO may_block_sight(x_m, y_m, dx_m, dy_m, half_diagonal_m) AS
    x_m * dx_m + y_m * dy_m BETWEEN 0 AND dx_m ** 2 + dy_m ** 2 AND abs(x_m * dy_m - y_m * dx_m) < half_diagonal_m * sqrt(dx_m ** 2 + dy_m ** 2);
-- Half the diagonal of a box; if its size is not known, that of the largest box of its class.
CREATE OR REPLACE MACRO box_half_diagonal_m(actor_class, length_m, width_m) AS coalesce(
    sqrt(length_m ** 2 + width_m ** 2) / 2,
    CASE WHEN coalesce(actor_class IN ('truck', 'bus', 'trailer', 'vehicle', 'object'), true) THEN largest_half_diagonal_m() ELSE both_half_diagonals_m() / 2 END
);
-- How far the ego's trailer reaches behind the ego's middle; NULL: no trailer. If its position is not known, it is as long as can be.
CREATE OR REPLACE MACRO trailer_reach_m(length_m, combination_m) AS
    CASE WHEN combination_m IS DISTINCT FROM length_m THEN coalesce(combination_m, 2 * both_half_diagonals_m()) - length_m / 2 END;

-- Upper bound of the distance between an actor and the position extrapolated from its last (or next) velocity over t seconds. Vehicles and
-- animals change their velocity by at most 10 m/s2, pedestrians move at 10 m/s at most, and an actor of unknown class may be either.
CREATE OR REPLACE MACRO strays_m(actor_class, t_s) AS
    CASE
        WHEN actor_class = 'pedestrian' THEN 10.0 * t_s
        WHEN actor_class IS NULL OR actor_class = 'object' THEN greatest(10.0 * t_s, 5.0 * t_s * t_s)
        ELSE 5.0 * t_s * t_s
    END;
-- Upper bound of the distance between a vehicle and the straight line through two sightings, at a time that is t_s from one of them and
-- other_s from the other. It changes its velocity by at most 10 m/s2.
CREATE OR REPLACE MACRO line_error_m(t_s, other_s) AS 5.0 * t_s * other_s;

-- Whether a doubt about a quantity of an actor is one about its position: at that time it may be elsewhere, or another one is there.
CREATE OR REPLACE MACRO doubts_place(quantity) AS quantity IN ('position', 'existence', 'identity');

-- How much nearer to a lane an actor can come within t seconds after (or before) it is seen beside the lane: by its lateral speed, by
-- steering or braking, and by a bend of the lane (50 m of radius).
CREATE OR REPLACE MACRO comes_beside_m(actor_class, across_mps, v_mps, t_s) AS across_mps * t_s + strays_m(actor_class, t_s) + 0.01 * (v_mps * t_s) ** 2;

-- Half the width of the widest lane.
CREATE OR REPLACE MACRO widest_lane_half_m() AS 3.0;

-- A place along a road has a different station in each lane. The stations differ by at most this: in a quarter turn, by about the width of
-- a lane times pi / 2.
CREATE OR REPLACE MACRO lane_station_error_m() AS 6.0;

-- The reason why the ego has no position on the corridor: the first of these values that is missing; NULL: none is missing.
CREATE OR REPLACE MACRO ego_lacks(x_m, yaw_rad, lanelet_id, front_s_m) AS CASE
    WHEN x_m IS NULL THEN why('ego_without_position')
    WHEN yaw_rad IS NULL THEN why('ego_without_heading')
    WHEN lanelet_id IS NULL THEN why('ego_off_lanes')
    WHEN front_s_m IS NULL THEN why('ego_beyond_lanes') END;

-- The reason if it is not known whether two boxes touch.
CREATE OR REPLACE MACRO graze_doubt(object_id) AS why('grazes', {'object_id': object_id});

-- The reason if it is not known whether the ego overtook this vehicle.
CREATE OR REPLACE MACRO overtake_doubt(vbp_id) AS CASE WHEN vbp_id IS NOT NULL THEN why('overtake_unsure', {'object_id': vbp_id}) END;

-- Whether it is uncertain that the ego overtakes: it may have only looked past the vehicle ahead, or changed lane behind it.
CREATE OR REPLACE MACRO may_be_no_overtake(status, sure) AS coalesce(status <> 'completed' AND NOT sure, false);

-- An actor without a position on the corridor may be beside the ego if it may be nearer than this.
CREATE OR REPLACE MACRO may_be_beside_m() AS 10.0;

-- The order of two fronts counts as changed when they are this far apart in the new order: the positions of vehicles side by side jitter.
CREATE OR REPLACE MACRO order_change_m() AS 0.25;

-- Whether part of a box is in the running lane. d_m is the distance of its centre from the lane's centre line, lat_half_m half its extent
-- across the lane.
CREATE OR REPLACE MACRO in_lane(d_m, lat_half_m, half_width_m) AS abs(d_m) - lat_half_m < half_width_m - over_boundary_m();
-- The most that a pedestrian reaches to each side of its middle: half its extent across the lane, or half its diagonal if its heading is not
-- known.
CREATE OR REPLACE MACRO walker_half_m(lat_half_m, length_m, width_m) AS
    coalesce(lat_half_m, sqrt(length_m ** 2 + width_m ** 2) / 2, longest_animal_m() / 2);

-- An actor whose heading is within this angle of a lane's direction follows the lane.
CREATE OR REPLACE MACRO along_lane_rad() AS pi() / 9;

-- A vehicle that is farther away than this when a lane change begins is neither its leader nor its follower: 5 s at a speed difference of
-- 70 km/h.
CREATE OR REPLACE MACRO lane_change_near_m() AS 100.0;

-- How far behind the ego a follower is searched for: the corridor always extends this far.
CREATE OR REPLACE MACRO follower_m() AS 200.0;

-- A vehicle that is inside the running lane by more than this has cut in.
CREATE OR REPLACE MACRO cut_in_m() AS 0.3;

-- A marking as seen from the lane on its other side: of a double line, the line nearer to the lane is named first.
CREATE OR REPLACE MACRO seen_from_beyond(marking) AS
    CASE marking WHEN 'solid_broken' THEN 'broken_solid' WHEN 'broken_solid' THEN 'solid_broken' ELSE marking END;

-- The ego's way is the strip that its box sweeps. An actor within way_beside_m beside the ego's box is in the way. An actor that reaches it
-- within enters_s, at the present lateral speeds, is heading into it. A pedestrian within may_step_m beside it may step into it.
CREATE OR REPLACE MACRO way_beside_m() AS 0.5;
CREATE OR REPLACE MACRO enters_s() AS 4.0;
CREATE OR REPLACE MACRO may_step_m() AS 2.0;
-- How far ahead actors are searched for: enough for an ego at up to 44 m/s (see brakes_for_m).
CREATE OR REPLACE MACRO way_reach_m() AS 600.0;
-- The greatest distance at which an actor can be a reason to brake hard at all (2 m/s2), with a reaction time of two seconds and a margin
-- of 10 m.
CREATE OR REPLACE MACRO brakes_for_m(v_mps) AS 10.0 + 2.0 * v_mps + v_mps ** 2 / 4.0;
-- Deceleration that keeps the ego 5 m away from an actor ahead, after a reaction time of one second; 0 if the ego does not come nearer. The
-- speeds are along the road.
CREATE OR REPLACE MACRO need_mps2(gap_m, v_mps, along_mps) AS
    CASE WHEN v_mps > along_mps THEN (v_mps - along_mps) ** 2 / (2 * greatest(gap_m - (v_mps - along_mps) - 5.0, 0.1)) WHEN v_mps IS NOT NULL THEN 0.0::DOUBLE END;
-- A driver who has braked for an actor releases the brake within this time after the actor has gone.
CREATE OR REPLACE MACRO brake_release_ns() AS 2_000_000_000;
-- An actor counts as crossing only if its lateral speed brings it into the way within enters_s, at every sample during this time and at two
-- samples at least.
CREATE OR REPLACE MACRO coming_for_ns() AS 300_000_000;

-- Whether an actor in the way, which requires a deceleration of `need_mps2`, is a reason to brake harder than `abrupt_mps2`. `known`: no
-- other actor may be in the way. Result NULL: not known.
CREATE OR REPLACE MACRO asks_to_brake(need_mps2, known, abrupt_mps2) AS need_mps2 >= abrupt_mps2 OR CASE WHEN known THEN false END;

-- Whether the ego stands because of an actor in its way: a vehicle within `queue_m` that is no faster than `slow_mps`, or a pedestrian, an
-- animal or an object within `hazard_m`. `known`: no other actor may be in the way. Result NULL: not known.
CREATE OR REPLACE MACRO stands_because_of(object_id, actor_class, gap_m, along_mps, known, queue_m, hazard_m, slow_mps) AS
    CASE WHEN object_id IS NOT NULL AND NOT may_be_vehicle(actor_class) AND gap_m <= hazard_m THEN true
        WHEN object_id IS NOT NULL AND gap_m <= queue_m AND along_mps <= slow_mps THEN true
        WHEN object_id IS NOT NULL AND actor_class IS NULL AND gap_m <= hazard_m THEN NULL
        WHEN object_id IS NOT NULL AND gap_m <= queue_m AND along_mps IS NULL THEN NULL
        WHEN known THEN false END;

-- A sampled distance, if the motion between the samples cannot change the verdict; else NULL.
CREATE OR REPLACE MACRO sure_between_steps(seen_m, blur_m, required_m) AS CASE WHEN seen_m < required_m OR seen_m - coalesce(blur_m, 0.0) >= required_m THEN seen_m END;

-- No vehicle turns into premises or a side road faster than access_mps (20 mph: a bend of 12 m radius then requires 6.7 m/s2), or without
-- turning by at least turned_off_rad.
CREATE OR REPLACE MACRO access_mps() AS 8.94;
CREATE OR REPLACE MACRO turned_off_rad() AS pi() / 6;
-- Our default: if the overhang over the line was smaller by this before the step, the ego came from its lane, not from beyond the line. If
-- it is smaller by this after the step, the ego comes back to its lane and does not leave the road over the line. (Noise is 0.05 m.)
CREATE OR REPLACE MACRO back_in_lane_m() AS 0.25;
-- An ego whose position is unknown for no longer than this has not returned to its lane and left it again meanwhile.
CREATE OR REPLACE MACRO no_return_ns() AS 500_000_000;

-- Our default: if the ego's median distance from the middle of its lane is greater than this, the map may be shifted against the log; the
-- ego does not just keep to one side of the lane. (In the logs of the case study, the median is 0.04 to 0.26 m.)
CREATE OR REPLACE MACRO aside_of_lane_m() AS 0.7;

-- Our default: an ego that is against a one-way road for longer than this drives the wrong way, and does not just turn round.
CREATE OR REPLACE MACRO one_way_ns() AS 5_000_000_000;

-- Our default: an overtake on the opposing side takes no longer than this (the overtakes of the case study take 6 s at 5 m/s). An ego that
-- has been against its lane for less than this, since the log began, may be in an overtake.
CREATE OR REPLACE MACRO longest_overtake_ns() AS 15_000_000_000;
-- Our default: a lane change takes no longer than this.
CREATE OR REPLACE MACRO longest_change_ns() AS 10_000_000_000;
-- Our default: an ego that stays astride of the line behind a vehicle for this long has pulled out to pass it. An ego that only sways over
-- the line comes back at once.
CREATE OR REPLACE MACRO stays_out_ns() AS 3_000_000_000;
-- Our default: an ego that stayed over the line, to look past the vehicle ahead, pulls out if its centre then moves this much further out.
-- Less than that may also be a correction, unless it is so little (measured_m()) that the ego stayed where it was.
CREATE OR REPLACE MACRO pulls_out_m() AS 0.3;
-- Our default: the vehicle behind may have begun to brake for an overtake at most this long before the overtake begins.
CREATE OR REPLACE MACRO braked_before_ns() AS 2_000_000_000;

-- Where a driver who passes round an actor may be over the line: from 10 m plus 5 s of the closing speed before the actor (at least 30 m,
-- as the ego may wait behind it) to the same distance after it. If the actor stands or moves at a walking pace, or its speed is not known,
-- the ego's own speed counts.
CREATE OR REPLACE MACRO passing_mps(ego_mps, other_mps, heading_diff_rad) AS
    greatest(0.0, coalesce(ego_mps - other_mps * cos(heading_diff_rad), ego_mps));
CREATE OR REPLACE MACRO passing_after_m(v_mps) AS 10.0 + 5.0 * coalesce(v_mps, 0.0);
CREATE OR REPLACE MACRO passing_before_m(v_mps) AS greatest(30.0, passing_after_m(v_mps));
