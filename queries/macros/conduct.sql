-- How the ego's conduct is measured.

-- Least-squares slope per second from whole-number sums over n samples: t in ns, y in billionths of its unit.
CREATE OR REPLACE MACRO exact_slope(n, sum_t, sum_y, sum_ty, sum_tt) AS
    (n * sum_ty - sum_t * sum_y)::DOUBLE / nullif(n * sum_tt - sum_t * sum_t, 0)::DOUBLE;

-- Half width of the window over which the ego's motion is filtered: 0.25 s, or 2.2 periods where that is more. A period of 200 ms may be one
-- of 201; NULL in logs with less than 5 samples a second.
CREATE OR REPLACE MACRO filter_half_ns(period_ns) AS
    CASE WHEN period_ns <= 210_000_000 THEN greatest(250_000_000, (2.2 * period_ns)::BIGINT) END;

-- By how much a value stands out over the values half a window before and after it, on the side away from zero; 0 where it does not, or one
-- of them is not known. A mean over a window (a slope's weights fall off as a parabola) lowers a pointed peak by at most 0.7 of this (at
-- 20 samples a second or more), a round one by 0.2.
CREATE OR REPLACE MACRO peak_rise(value, past, next) AS
    CASE WHEN value + past + next IS NOT NULL THEN greatest(0.0, abs(value) - greatest(sign(value) * past, sign(value) * next)) ELSE 0.0 END;

-- Whether the samples of a window reach 0.7 of its half width to both sides.
CREATE OR REPLACE MACRO whole_window(t_ns, first_ns, last_ns, half_ns) AS
    t_ns - first_ns >= 0.7 * half_ns AND last_ns - t_ns >= 0.7 * half_ns;

-- Nobody comes nearer to the ego than at this speed while unseen, and no two boxes reach further than this from their centres.
CREATE OR REPLACE MACRO unseen_closing_mps() AS 60.0;
CREATE OR REPLACE MACRO two_half_boxes_m() AS 12.0;

-- A recorder that loses an actor in plain view has it again within this time, and has a new one so long after it came into view.
CREATE OR REPLACE MACRO tracker_loses_ns() AS 2_500_000_000;
CREATE OR REPLACE MACRO tracker_begins_ns() AS 500_000_000;
-- A recorded position may be off by this.
CREATE OR REPLACE MACRO sight_error_m() AS 1.0;
-- A lane whose middle leaves its tangent by less than this is straight: nothing beside it stands between two places on it.
CREATE OR REPLACE MACRO straight_m() AS 0.5;
-- Places on a lane at which it is looked whether they are in sight are so far apart: the shadow of a box between two hides no vehicle.
CREATE OR REPLACE MACRO sight_step_m() AS 2.0;
-- Our default: a box that reaches less into a lane hides no vehicle that stands in it.
CREATE OR REPLACE MACRO hides_vehicle_m() AS 0.5;
-- Whether a box at (x, y) from the eye stands in the line to the place at (dx, dy) from it.
CREATE OR REPLACE MACRO in_line(x_m, y_m, dx_m, dy_m, yaw_rad, length_m, width_m) AS
    x_m * dx_m + y_m * dy_m BETWEEN 0 AND dx_m ** 2 + dy_m ** 2
    AND abs(x_m * dy_m - y_m * dx_m)
        < length_m / 2 * abs(sin(yaw_rad) * dx_m - cos(yaw_rad) * dy_m) + width_m / 2 * abs(cos(yaw_rad) * dx_m + sin(yaw_rad) * dy_m);
-- Half the diagonal of a box; of one whose size is not known, as large as any.
CREATE OR REPLACE MACRO half_box_m(length_m, width_m) AS coalesce(sqrt(length_m ** 2 + width_m ** 2) / 2, two_half_boxes_m() / 2);

-- How far an actor can be from where its last (or next) velocity leads, t seconds away: nothing on wheels or hooves changes its velocity
-- faster than 10 m/s2; people on foot go nowhere faster than 10 m/s; an unknown class is either.
CREATE OR REPLACE MACRO strays_m(actor_class, t_s) AS
    CASE
        WHEN actor_class = 'pedestrian' THEN 10.0 * t_s
        WHEN actor_class IS NULL OR actor_class = 'object' THEN greatest(10.0 * t_s, 5.0 * t_s * t_s)
        ELSE 5.0 * t_s * t_s
    END;

-- Stations along a road that were measured in two of its lanes differ by no more than this: a lane's width in a quarter turn.
CREATE OR REPLACE MACRO lanes_apart_m() AS 6.0;

-- Why an actor cannot be placed, in words.
CREATE OR REPLACE MACRO unplaced_words(code) AS CASE code
    WHEN 'no_position' THEN 'has no position (or no fresh one)' WHEN 'off_level' THEN 'may be over or under the road' WHEN 'off_lanes' THEN 'moves off the lanes'
    WHEN 'no_heading' THEN 'has no heading' WHEN 'no_size' THEN 'has no size' WHEN 'lost' THEN 'is no longer recorded'
    WHEN 'lost_behind' THEN 'drove away behind and is no longer recorded' WHEN 'appeared' THEN 'is not yet recorded'
    WHEN 'beyond_map' THEN 'came in over the end of the map' END;

-- What the place of the ego lacks, and what to provide; NULL: nothing.
CREATE OR REPLACE MACRO ego_lacks(x_m, yaw_rad, lanelet_id, front_s_m) AS CASE
    WHEN x_m IS NULL THEN 'the ego ' || unplaced_words('no_position') || ': record it'
    WHEN yaw_rad IS NULL THEN 'the ego ' || unplaced_words('no_heading') || ': record it'
    WHEN lanelet_id IS NULL THEN 'the ego is not on a lane of the map: give a map that has its lane'
    WHEN front_s_m IS NULL THEN 'the ego''s box reaches beyond the lanes of the map: give a map whose lanes go on' END;

-- The reason where nobody can tell whether two boxes touch.
CREATE OR REPLACE MACRO graze_words(object_id) AS
    format('whether the ego passes {} by, or touches it, is a matter of centimetres: record positions, headings and sizes more exactly', object_id);

-- The reason where nobody can tell whether the ego overtook this vehicle.
CREATE OR REPLACE MACRO overtake_doubt(vbp_id) AS
    format('whether the ego overtook {} is not sure: record both from before the ego leaves its lane until it is back in it', vbp_id);

-- Somebody who cannot be placed may be beside the ego if he may be this near.
CREATE OR REPLACE MACRO may_be_beside_m() AS 10.0;

-- Two fronts are in another order when they are this far apart in it: side by side they jitter.
CREATE OR REPLACE MACRO order_m() AS 0.25;

-- Some of a box is in the running lane: its middle is d from the lane's centre line, its half extent across lat_half.
CREATE OR REPLACE MACRO in_lane(d_m, lat_half_m, half_width_m) AS abs(d_m) - lat_half_m < half_width_m - over_boundary_m();

-- Who heads within this of a lane's direction follows it.
CREATE OR REPLACE MACRO own_way_rad() AS pi() / 9;

-- Whoever is further away than this when a lane change begins is neither its leader nor its follower: 5 s at 70 km/h of difference.
CREATE OR REPLACE MACRO lane_change_near_m() AS 100.0;

-- How far behind the ego somebody is looked for: as far as the corridor surely reaches.
CREATE OR REPLACE MACRO follower_m() AS 200.0;

-- How far in the running lane a vehicle has come when it has cut in.
CREATE OR REPLACE MACRO cut_in_m() AS 0.3;

-- A marking as the lane on its other side sees it: of a double line the nearer one is named first.
CREATE OR REPLACE MACRO seen_from_beyond(marking) AS
    CASE marking WHEN 'solid_broken' THEN 'broken_solid' WHEN 'broken_solid' THEN 'solid_broken' ELSE marking END;

-- The ego's way: what is so near beside its box is in it; who is in it within so many seconds, at the present speeds across, is heading
-- into it; somebody on foot so near beside it may step into it.
CREATE OR REPLACE MACRO way_beside_m() AS 0.5;
CREATE OR REPLACE MACRO enters_s() AS 4.0;
CREATE OR REPLACE MACRO may_step_m() AS 2.0;
-- How far ahead anybody is looked for: from 70 m/s it takes 2 m/s2 some 600 m to stop.
CREATE OR REPLACE MACRO way_reach_m() AS 600.0;
-- How far away somebody can be a reason to brake at all hard (2 m/s2), with two seconds to see it and 10 m to spare.
CREATE OR REPLACE MACRO way_look_m(v_mps) AS 10.0 + 2.0 * v_mps + v_mps ** 2 / 4.0;
-- Deceleration that keeps the ego 5 m off somebody ahead, after a second to see it; speeds along the road, none where nothing closes in.
CREATE OR REPLACE MACRO need_mps2(gap_m, v_mps, along_mps) AS
    CASE WHEN v_mps > along_mps THEN (v_mps - along_mps) ** 2 / (2 * greatest(gap_m - (v_mps - along_mps) - 5.0, 0.1)) WHEN v_mps IS NOT NULL THEN 0.0::DOUBLE END;
-- A driver who has braked for somebody lets the brake go within so long after he has gone.
CREATE OR REPLACE MACRO let_go_ns() AS 2_000_000_000;
-- For so long somebody must have been coming across, and at the sample before.
CREATE OR REPLACE MACRO comes_ns() AS 300_000_000;

-- Whether somebody in the way, who asks for a deceleration of `need_mps2`, is a reason to brake harder than `abrupt_mps2`. `known`: nobody
-- else may be in the way; NULL: not known.
CREATE OR REPLACE MACRO asks_to_brake(need_mps2, known, abrupt_mps2) AS need_mps2 >= abrupt_mps2 OR CASE WHEN known THEN false END;

-- Whether the ego stands because of somebody in its way: a vehicle within `queue_m` that is no faster than `slow_mps`, or somebody on foot,
-- an animal or a thing within `hazard_m`. `known`: nobody else may be; NULL: not known.
CREATE OR REPLACE MACRO stands_for(object_id, actor_class, gap_m, along_mps, known, queue_m, hazard_m, slow_mps) AS
    CASE WHEN object_id IS NOT NULL AND NOT may_be_vehicle(actor_class) AND gap_m <= hazard_m THEN true
        WHEN object_id IS NOT NULL AND gap_m <= queue_m AND along_mps <= slow_mps THEN true
        WHEN object_id IS NOT NULL AND actor_class IS NULL AND gap_m <= hazard_m THEN NULL
        WHEN object_id IS NOT NULL AND gap_m <= queue_m AND along_mps IS NULL THEN NULL
        WHEN known THEN false END;

-- A distance that was sampled is kept only if what lies between the samples does not matter.
CREATE OR REPLACE MACRO kept_between(seen_m, blur_m, required_m) AS CASE WHEN seen_m < required_m OR seen_m - coalesce(blur_m, 0.0) >= required_m THEN seen_m END;

-- Faster than this nobody turns into premises or a side road (20 mph: a bend of 12 m radius then asks for 6.7 m/s2), nor without turning
-- by as much as this.
CREATE OR REPLACE MACRO access_mps() AS 8.94;
CREATE OR REPLACE MACRO turned_off_rad() AS pi() / 6;
-- Our default: back by so much (noise is 0.05 m) the ego does not go on over a line, nor come from beyond it.
CREATE OR REPLACE MACRO back_m() AS 0.25;
-- Without a place for so long the ego has not been back in its lane and out of it again.
CREATE OR REPLACE MACRO no_return_ns() AS 500_000_000;

-- Our default: an overtake on the opposing side takes no longer (the case study's take 6 s at 5 m/s). An ego against its lane
-- for less, since the log began, may be in one.
CREATE OR REPLACE MACRO longest_overtake_ns() AS 15_000_000_000;
-- Our default: nor a lane change.
CREATE OR REPLACE MACRO longest_change_ns() AS 10_000_000_000;
-- Who stays astride of the line behind a vehicle for so long (our default) has pulled out to pass it; who sways over it comes back at once.
CREATE OR REPLACE MACRO stays_out_ns() AS 3_000_000_000;
-- Our default: so long before an overtake the one behind may have begun to brake for it.
CREATE OR REPLACE MACRO braked_for_ns() AS 2_000_000_000;

-- How far before somebody, and how far past it, a driver who goes round it may be over the line: 10 m and 5 s at the speed at which it comes
-- nearer (at its own speed, where the other stands or goes at a walking pace, or how fast is not known), and as it waits behind it, 30 m.
CREATE OR REPLACE MACRO passing_mps(ego_mps, other_mps, heading_diff_rad) AS
    greatest(0.0, coalesce(ego_mps - other_mps * cos(heading_diff_rad), ego_mps));
CREATE OR REPLACE MACRO passing_after_m(v_mps) AS 10.0 + 5.0 * coalesce(v_mps, 0.0);
CREATE OR REPLACE MACRO passing_before_m(v_mps) AS greatest(30.0, passing_after_m(v_mps));
