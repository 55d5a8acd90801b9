-- title = "Two seconds behind the vehicle ahead on fast roads"
-- breach = "Less than two seconds behind the vehicle ahead on a fast road"
-- clause = "UKHC R126, R227 and R230: on faster roads and in tunnels allow at least two seconds to the vehicle in front, twice that in the wet, up to ten times on ice"
-- hypothesis = "At every step behind a vehicle on a fast road, was it at least two seconds ahead?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "draft"
-- sense = ">="
-- unit = "s"
-- observes = "time gap to the vehicle ahead"
-- near_margin = 0.2
-- merge_gap_s = 5.0
-- reads = ["ego_condition", "following"]
-- requires = ["way", "ego_size"]
--
-- [applies]
-- limit_min_mps = 22.35
--
-- [params.time_gap_s]
-- default = 2.0
-- unit = "s"
-- why = "the Code's two seconds, for roads of 50 mph (22.35 m/s) and more as our default; the weather counts as dry where it is not known"
-- source = "UKHC R126"
--
-- [params.settle_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: time to open the gap again after the ego or the other vehicle changed into the lane; a vehicle that was ahead already, or whose lane change was not seen (at the log's begin, say), counts as settled"
--
-- # Draft: where traffic is slow on a fast road, two seconds and the stopping distance of R126 disagree, and which of them a driver follows is a
-- # judgement. No map says where a tunnel is.

-- @applies
SELECT drive_id, ego_id, t_ns, object_id,
    follows AND ego_speed_mps > standing_mps() AND (joined_ns IS NULL OR t_ns - joined_ns >= ($settle_s * 1e9)::BIGINT) AS applies
FROM following

-- @condition
SELECT f.drive_id, f.ego_id, f.t_ns, f.object_id, f.gap_m / f.ego_speed_mps AS observed, stopping_factor(c.weather) * $time_gap_s AS required
FROM following f
LEFT JOIN ego_condition c USING (drive_id, ego_id, t_ns)
