-- Actors over or under the ego's road, and actors that belong to the ego itself.

-- The heights of two actors on the same ground differ by at most this: a log may give the box centre of one and the ground of the other
-- (2.2 m for a bus of 4.4 m), and while a vehicle settles its height may change by some decimetres. A footbridge, the lowest bridge of all, is
-- 3 m above what it crosses.
CREATE OR REPLACE MACRO level_m() AS 2.5;
-- The centres of two boxes, one over the other, are further apart than this: no less than half the sum of their heights (NULL: unknown).
CREATE OR REPLACE MACRO level_gap_m(a_height_m, b_height_m) AS greatest(level_m(), (a_height_m + b_height_m) / 2);
-- No road crosses another one at a greater height: two heights that differ by more are not measured from the same zero.
CREATE OR REPLACE MACRO highest_m() AS 100.0;
-- Two boxes that meet in plan do meet, unless their heights say otherwise.
CREATE OR REPLACE MACRO same_level(a_m, b_m) AS coalesce(abs(a_m - b_m) <= level_m(), true);
-- No road is steeper than this on the way from the place where the ego's height is known: 15 % is the steepest gradient that is planned
-- anywhere.
CREATE OR REPLACE MACRO steepest() AS 0.15;
-- The height that a recorder measures drifts by no more than this while it drives.
CREATE OR REPLACE MACRO height_drift_mps() AS 0.05;
-- A height that changes by less than this over a whole track is not measured: a flat simulation writes half the height of the box.
CREATE OR REPLACE MACRO measured_height_change_m() AS 0.05;
-- A height of 0, or of half the box, is not measured: the log has none for this actor.
CREATE OR REPLACE MACRO is_measured_height(z_m, height_m) AS abs(z_m) > 0.01 AND coalesce(abs(z_m - height_m / 2) > 0.01, true);
-- Whether a heading is along the lane, in either direction.
CREATE OR REPLACE MACRO along_lane(heading_diff_rad) AS abs(sin(heading_diff_rad)) < sin(along_lane_rad());
-- Whether two ends of lanes are the same point of the ground.
CREATE OR REPLACE MACRO is_one_point(a, b) AS (a.x - b.x) ** 2 + (a.y - b.y) ** 2 <= 1 AND same_level(a.z, b.z);
-- Lanes that turn from one road into the other at a crossing are at most this long. A ramp between two levels is longer.
CREATE OR REPLACE MACRO turning_way_m() AS 60.0;

-- A trailer's box begins at most this far behind the box of its tractor: the length of a drawbar.
CREATE OR REPLACE MACRO drawbar_m() AS 2.5;
-- An actor whose class does not say trailer is one only if its box touches the ego's all the time. Boxes are off by a decimetre or two.
CREATE OR REPLACE MACRO touching_m() AS 0.2;
-- How exactly a trailer turns about its hitch: the tolerances of its distance from the hitch and of its heading towards it.
CREATE OR REPLACE MACRO hitch_m() AS 0.3;
CREATE OR REPLACE MACRO hitch_rad() AS 0.15;
-- An actor whose class does not say trailer is one only after the two have moved this far together.
CREATE OR REPLACE MACRO towed_m() AS 20.0;
-- A track continues under another id if the centres and the headings of the two boxes are this close: two vehicles cannot be.
CREATE OR REPLACE MACRO same_place_m() AS 1.0;
CREATE OR REPLACE MACRO same_heading_rad() AS 0.25;
-- Two estimates of the size of one box differ by no more than this.
CREATE OR REPLACE MACRO same_size(a_m, b_m) AS coalesce(abs(a_m - b_m) <= 0.5, true);
