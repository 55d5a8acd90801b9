-- Numbers of the library, named once.

-- A corner this far over a boundary has left the lane (paper's registration noise is below it).
CREATE OR REPLACE MACRO over_boundary_m() AS 0.05;
-- Half width of the strip in which the corridor gives positions, and how far it reaches ahead of and behind the ego's way.
CREATE OR REPLACE MACRO strip_m() AS 15.0;
CREATE OR REPLACE MACRO corridor_ahead_m() AS 1000.0;
CREATE OR REPLACE MACRO corridor_behind_m() AS 200.0;
-- Boxes nearer than this get their exact clearance; beyond it a lower bound decides every rule that asks for one.
CREATE OR REPLACE MACRO exact_clearance_m() AS 30.0;
-- An object whose track ends this close to the ego did not just drive away.
CREATE OR REPLACE MACRO lost_near_m() AS 50.0;
-- A recorder whose range nobody says sees this far.
CREATE OR REPLACE MACRO sight_m(sensor_range_m) AS coalesce(sensor_range_m, lost_near_m());
-- Slower than this is standing: positions of parked vehicles jitter.
CREATE OR REPLACE MACRO standing_mps() AS 0.5;
-- What a velocity that ingest derives by a filter may be off by (ingest/velocity.py).
CREATE OR REPLACE MACRO filtered_error_mps() AS 0.25;
-- Positions that spread by no more than this are those of something that stays where it is.
CREATE OR REPLACE MACRO moved_m() AS 1.0;
-- From so far away of the end of the map, who is beyond it is nothing to reckon with yet: two vehicles at 60 mph that brake for each other
-- need some 150 m to stop, and 350 m by the most careful of the models.
CREATE OR REPLACE MACRO beyond_map_m() AS 400.0;
-- Samples closer than this many periods are continuous.
CREATE OR REPLACE MACRO max_gap_periods() AS 2.5;
-- How near to the ego a vehicle that leaves or enters the log matters: as far as the faster of the two goes in 10 s. No rule looks further
-- ahead or behind for a vehicle that goes the same way (RSS asks for 4 s, stopping in the wet for 7 s at 70 mph). Unknown speeds: 70 mph.
CREATE OR REPLACE MACRO reach_m(v_object_mps, v_ego_mps) AS
    greatest(lost_near_m(), 10 * greatest(coalesce(v_object_mps, 31.3), coalesce(v_ego_mps, 31.3)));
-- Nobody ahead: nobody as near as the ego goes in 10 s, at 50 km/h and more, and 50 m. An unseen vehicle beyond that breaks no rule.
CREATE OR REPLACE MACRO lead_reach_m(v_ego_mps) AS lost_near_m() + 10 * greatest(coalesce(v_ego_mps, 31.3), 14.0);
-- How long a vehicle that left or has not yet entered the log may be on the road ahead all the same: twice the time to meet it at both
-- speeds, between `least_s` and 60 s.
CREATE OR REPLACE MACRO unseen_ns(distance_m, v_object_mps, v_ego_mps, least_s) AS
    (1e9 * least(60.0, greatest(least_s, 2 * coalesce(distance_m / nullif(v_object_mps + v_ego_mps, 0), 30.0))))::BIGINT;
-- Nobody who is not seen comes faster than this: 70 mph.
CREATE OR REPLACE MACRO fastest_mps() AS 31.3;
-- Why there is no limit to judge by.
CREATE OR REPLACE MACRO limit_doubt(limit_source, lanelet_id) AS CASE limit_source
    WHEN 'unread' THEN 'the map gives a limit for lanelet ' || lanelet_id || ' that cannot be read: give one with limits in a known unit'
    WHEN 'none' THEN 'the map says that lanelet ' || lanelet_id || ' has no limit of its own: give one that says which limit holds'
    ELSE 'the map gives no limit for lanelet ' || lanelet_id || ': give one with speed limits'
END;
-- Two directions further apart than this, with nothing between them in the map, may have a central reservation between them.
CREATE OR REPLACE MACRO reservation_m() AS 1.0;
