-- How the ego's conduct is measured.

-- Least-squares slope per second from whole-number sums over n samples: t in ns, y in billionths of its unit.
CREATE OR REPLACE MACRO exact_slope(n, sum_t, sum_y, sum_ty, sum_tt) AS
    (n * sum_ty - sum_t * sum_y)::DOUBLE / nullif(n * sum_tt - sum_t * sum_t, 0)::DOUBLE;

-- Whether the samples of a window reach 0.7 of its half width to both sides.
CREATE OR REPLACE MACRO whole_window(t_ns, first_ns, last_ns, half_ns) AS
    t_ns - first_ns >= 0.7 * half_ns AND last_ns - t_ns >= 0.7 * half_ns;

-- Nobody comes nearer to the ego than at this speed while unseen, and no two boxes reach further than this from their centres.
CREATE OR REPLACE MACRO unseen_closing_mps() AS 60.0;
CREATE OR REPLACE MACRO two_half_boxes_m() AS 12.0;

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
