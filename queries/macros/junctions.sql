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
-- Two boxes overlap or touch: (dx, dy) from the first one's centre to the second one's in map axes, (ca, sa) and (cb, sb) the cosine and
-- sine of their headings.
CREATE OR REPLACE MACRO boxes_meet(dx, dy, ca, sa, cb, sb, hla, hwa, hlb, hwb) AS
    dx * dx + dy * dy <= (hla + hwa + hlb + hwb) * (hla + hwa + hlb + hwb)
    AND box_separation(dx * ca + dy * sa, dy * ca - dx * sa, ca * cb + sa * sb, ca * sb - sa * cb, hla, hwa, hlb, hwb) <= 0;
-- Where somebody goes: people on foot go where they go, whichever way they are turned.
CREATE OR REPLACE MACRO going_rad(actor_class, speed_mps, vx_mps, vy_mps, yaw_rad) AS
    CASE WHEN actor_class = 'pedestrian' AND speed_mps > standing_mps() THEN atan2(vy_mps, vx_mps) ELSE yaw_rad END;
-- Half length of the ground that a box covers from one sample to the next: a log of few samples a second leaves no ground between two.
CREATE OR REPLACE MACRO swept_half_m(length_m, speed_mps, period_s) AS greatest(length_m, least(coalesce(speed_mps, 0.0), 70.0) * period_s) / 2;
-- Grid of a drive, its cells as wide as two boxes reach: what touches has its centres in one cell or in neighbours.
CREATE OR REPLACE MACRO meeting_cell(x_m, y_m, cell_m) AS cell_key(floor(x_m / cell_m), floor(y_m / cell_m));
CREATE OR REPLACE MACRO meeting_slot(t_ns) AS (t_ns // conflict_ns())::INTEGER;
-- A signal and a stop line this far apart along the way belong together.
CREATE OR REPLACE MACRO line_reach_m() AS 30.0;
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
