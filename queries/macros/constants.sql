-- Constants that several derivations and rules share.

-- A corner that is over a boundary by more than this has left the lane (the registration noise of Harper et al. 2021 is smaller).
CREATE OR REPLACE MACRO over_boundary_m() AS 0.05;
-- A corner that is over a boundary by less than this may not have left the lane: boundaries without a marking are not surveyed, and boxes
-- are estimates.
CREATE OR REPLACE MACRO surely_out_m() AS 0.3;
-- Half a metre on either side: an ego that has this much room in total passes a standing vehicle without leaving the lane.
CREATE OR REPLACE MACRO room_beside_standing_m() AS 1.0;
-- Half width of the strip in which the corridor gives positions, and the corridor's length beyond both ends of the ego's path.
CREATE OR REPLACE MACRO strip_m() AS 15.0;
CREATE OR REPLACE MACRO corridor_ahead_m() AS 1000.0;
CREATE OR REPLACE MACRO corridor_behind_m() AS 200.0;
-- The clearance of boxes nearer than this is exact. For boxes farther apart a lower bound is enough for every rule that needs a clearance.
CREATE OR REPLACE MACRO exact_clearance_m() AS 30.0;
-- An object whose track ends this close to the ego was lost: it cannot just have driven away.
CREATE OR REPLACE MACRO lost_near_m() AS 50.0;
-- The range of a recorder; this default applies if it is not set.
CREATE OR REPLACE MACRO sight_m(sensor_range_m) AS coalesce(sensor_range_m, lost_near_m());
-- An actor that is no faster than this stands: the positions of parked vehicles jitter.
CREATE OR REPLACE MACRO standing_mps() AS 0.5;
-- Error bound of a velocity that ingest derives with a filter (drive/velocity.py).
CREATE OR REPLACE MACRO filtered_error_mps() AS 0.25;
-- An actor whose positions spread by no more than this in the whole log stands: the positions of standing objects jitter.
CREATE OR REPLACE MACRO standing_spread_m() AS 1.0;
-- If the end of the map is farther away than this, vehicles beyond it need not be considered yet: two vehicles at 60 mph that brake for
-- each other need some 150 m to stop, and 350 m by the most cautious of the models.
CREATE OR REPLACE MACRO beyond_map_m() AS 400.0;
-- Samples that are at most this many periods apart are continuous.
CREATE OR REPLACE MACRO max_gap_periods() AS 2.5;
-- A vehicle that leaves or enters the log matters if it is nearer to the ego than this: the distance that the faster of the two drives in
-- 10 s. No rule looks farther ahead or behind for a vehicle that goes the same way (RSS needs 4 s, stopping in the wet 7 s at 70 mph). An
-- unknown speed counts as 70 mph.
CREATE OR REPLACE MACRO reach_m(v_object_mps, v_ego_mps) AS
    greatest(lost_near_m(), 10 * greatest(coalesce(v_object_mps, 31.3), coalesce(v_ego_mps, 31.3)));
-- "No vehicle ahead" means: none nearer than this, which is 50 m plus the distance that the ego drives in 10 s, at 50 km/h or more. An
-- unseen vehicle further away breaks no rule.
CREATE OR REPLACE MACRO lead_reach_m(v_ego_mps) AS lost_near_m() + 10 * greatest(coalesce(v_ego_mps, 31.3), 14.0);
-- How long a vehicle that left the log, or has not yet entered it, may still be on the road ahead: twice the time until the two meet at
-- their speeds, between `least_s` and 60 s.
CREATE OR REPLACE MACRO unseen_ns(distance_m, v_object_mps, v_ego_mps, least_s) AS
    (1e9 * least(60.0, greatest(least_s, 2 * coalesce(distance_m / nullif(v_object_mps + v_ego_mps, 0), 30.0))))::BIGINT;
-- An unseen vehicle comes no faster than this: 70 mph.
CREATE OR REPLACE MACRO fastest_mps() AS 31.3;
-- The reason why there is no speed limit to judge by.
CREATE OR REPLACE MACRO limit_doubt(limit_source, lanelet_id) AS CASE limit_source
    WHEN 'unread' THEN why('limit_unread', {'lanelet_id': lanelet_id})
    WHEN 'none' THEN why('no_own_limit', {'lanelet_id': lanelet_id})
    ELSE CASE WHEN lanelet_id IS NOT NULL THEN why('no_limit', {'lanelet_id': lanelet_id}) END
END;
-- If the two directions of a road are further apart than this, and the map has nothing between them, there may be a central reservation.
CREATE OR REPLACE MACRO reservation_m() AS 1.0;

-- Error bound of a value that a recorder's sensors measured, as a share of the required value. Positions and boxes of other vehicles are
-- accurate to some 0.1 to 0.3 m, and their speeds to some 3 %.
CREATE OR REPLACE MACRO measured_share() AS 0.05;
CREATE OR REPLACE MACRO measured_m() AS 0.1;
-- Two boxes that overlap laterally by less than this may in fact pass each other, if sensors measured them.
CREATE OR REPLACE MACRO measured_meeting_m() AS 0.3;
-- The acceleration of an actor whose positions are wrong by measured_m() to one side, to the other, and back, half a second apart.
CREATE OR REPLACE MACRO measured_mps2() AS 4 * measured_m() / 0.5 ** 2;
-- A car whose tyres grip moves within a few degrees of its heading; a track at a greater angle may change from one car to another.
CREATE OR REPLACE MACRO slides_rad() AS radians(4);
-- Upper bound of the acceleration of road cars (0 to 100 km/h in 4.6 s). A few sports cars are faster and count as badly measured.
CREATE OR REPLACE MACRO engine_mps2() AS 6.0;
