-- Actors over or under the ego's road, and actors that belong to the ego itself.

-- Two actors on one ground differ in height by at most this: a log may give the box centre of the one and the ground of the other (2.2 m for
-- a bus of 4.4 m), and settling adds some decimetres. A footbridge, the lowest of all, is 3 m above what it crosses.
CREATE OR REPLACE MACRO level_m() AS 2.5;
-- Two boxes that meet in plan meet, unless their heights say otherwise.
CREATE OR REPLACE MACRO same_level(a_m, b_m) AS coalesce(abs(a_m - b_m) <= level_m(), true);
-- No road is steeper over the way from where the ego's height is known: 15 % is the steepest that is planned anywhere.
CREATE OR REPLACE MACRO steepest() AS 0.15;
-- Heights that change less over a whole track are not measured: a flat simulation writes half the box's height.
CREATE OR REPLACE MACRO height_told_m() AS 0.05;
-- Along a lane, either way.
CREATE OR REPLACE MACRO along_lane(heading_diff_rad) AS abs(sin(heading_diff_rad)) < sin(own_way_rad());
-- Lanes that turn from one road into the other at a crossing are this long at most; a ramp between two levels is longer.
CREATE OR REPLACE MACRO turning_way_m() AS 60.0;

-- A trailer's box begins at most this far behind its tractor's: a drawbar.
CREATE OR REPLACE MACRO drawbar_m() AS 2.5;
-- Without a class, only a box that touches the ego's all the time is a trailer: boxes are a decimetre or two off.
CREATE OR REPLACE MACRO touching_m() AS 0.2;
-- How exactly a trailer turns about its hitch: its distance from there, and its heading towards it.
CREATE OR REPLACE MACRO hitch_m() AS 0.3;
CREATE OR REPLACE MACRO hitch_rad() AS 0.15;
-- So far the two have moved together before anything without a class is a trailer.
CREATE OR REPLACE MACRO towed_m() AS 20.0;
-- A track goes on under another id where the two boxes' middles and headings are so close: two vehicles cannot be.
CREATE OR REPLACE MACRO same_place_m() AS 1.0;
CREATE OR REPLACE MACRO same_heading_rad() AS 0.25;
-- Two estimates of one box differ by no more.
CREATE OR REPLACE MACRO same_size(a_m, b_m) AS coalesce(abs(a_m - b_m) <= 0.5, true);
