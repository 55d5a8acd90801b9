-- Actors over or under the ego's road, and actors that belong to the ego itself.

-- The heights of two actors on the same ground differ by at most this. A log may give the height of the box centre for one actor and of the
-- ground for the other (2.2 m for a bus of 4.4 m). The height of a vehicle may also change by some decimetres while it settles. A
-- footbridge, the lowest kind of bridge, is 3 m above the road.
CREATE OR REPLACE MACRO level_m() AS 2.5;
-- If one actor is over another, the centres of their boxes are further apart than this: at least half the sum of their heights (NULL:
-- unknown).
CREATE OR REPLACE MACRO level_gap_m(a_height_m, b_height_m) AS greatest(level_m(), (a_height_m + b_height_m) / 2);
-- No road crosses another one at a greater height: two heights that differ by more have different reference levels.
CREATE OR REPLACE MACRO highest_m() AS 100.0;
-- Two boxes that meet in plan meet in fact, unless their heights contradict it.
CREATE OR REPLACE MACRO same_level(a_m, b_m) AS coalesce(abs(a_m - b_m) <= level_m(), true);
-- Upper bound of the gradient of a road from the place where the ego's height is known: 15 % is the steepest planned gradient.
CREATE OR REPLACE MACRO steepest() AS 0.15;
-- Upper bound of the drift of a recorder's height measurement while it drives.
CREATE OR REPLACE MACRO height_drift_mps() AS 0.05;
-- A height that changes by less than this over a whole track is not measured: a flat simulation writes half the height of the box.
CREATE OR REPLACE MACRO measured_height_change_m() AS 0.05;
-- A height of 0, or of half the box, is not a measurement: the log has no height for this actor.
CREATE OR REPLACE MACRO is_measured_height(z_m, height_m) AS abs(z_m) > 0.01 AND coalesce(abs(z_m - height_m / 2) > 0.01, true);
-- Whether a heading is along the lane, in either direction.
CREATE OR REPLACE MACRO along_lane(heading_diff_rad) AS abs(sin(heading_diff_rad)) < sin(along_lane_rad());
-- Whether two ends of lanes are the same point.
CREATE OR REPLACE MACRO is_one_point(a, b) AS (a.x - b.x) ** 2 + (a.y - b.y) ** 2 <= 1 AND same_level(a.z, b.z);
-- Lanes that turn from one road into the other at a crossing are at most this long. A ramp between two levels is longer.
CREATE OR REPLACE MACRO turning_way_m() AS 60.0;

-- A trailer's box begins at most this far behind the box of its tractor: the length of a drawbar.
CREATE OR REPLACE MACRO drawbar_m() AS 2.5;
-- An actor whose class is not trailer is a trailer only if its box always touches the ego's. Boxes are wrong by a decimetre or two.
CREATE OR REPLACE MACRO touching_m() AS 0.2;
-- How accurately a trailer turns about its hitch: the tolerances of its distance from the hitch and of its heading towards it.
CREATE OR REPLACE MACRO hitch_m() AS 0.3;
CREATE OR REPLACE MACRO hitch_rad() AS 0.15;
-- An actor whose class is not trailer is a trailer only after the two have moved this far together.
CREATE OR REPLACE MACRO towed_m() AS 20.0;
-- A track continues under another id if the centres and the headings of the two boxes are this close: two vehicles cannot be so close.
CREATE OR REPLACE MACRO same_place_m() AS 1.0;
CREATE OR REPLACE MACRO same_heading_rad() AS 0.25;
-- Two estimates of the size of one box differ by no more than this.
CREATE OR REPLACE MACRO same_size(a_m, b_m) AS coalesce(abs(a_m - b_m) <= 0.5, true);
