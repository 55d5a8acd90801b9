-- title = "Not stopping on a motorway"
-- clause = "StVO 18(8) (R_I1 of Maierhofer et al. 2020): stopping on motorways is forbidden, but in a queue"
-- hypothesis = "When the ego came to stand on a motorway, was there a slow or standing vehicle close ahead?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- reads = ["standstill"]
-- requires = ["map", "registration", "ego_size"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.queue_mps]
-- default = 2.78
-- unit = "m/s"
-- why = "10 km/h: a vehicle as slow as this is in congestion"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.queue_m]
-- default = 30.0
-- unit = "m"
-- why = "our default: who stops further behind than this does not stop for the queue"

-- @reference
SELECT drive_id, ego_id, t_start_ns AS t_ns, ahead_id AS object_id, ahead_gap_m, ahead_speed_mps, ahead_known
FROM standstill

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, object_id, queued(object_id, ahead_gap_m, ahead_speed_mps, ahead_known, $queue_m, $queue_mps) AS holds
FROM reference
