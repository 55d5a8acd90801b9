-- title = "Park facing the way the traffic goes"
-- breach = "Parked facing the traffic"
-- clause = "UKHC R239: if you have to stop on the roadside, do not park facing against the traffic flow"
-- hypothesis = "Where the ego stood for long on a lane, did it face the way that the lane is driven?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- tags = ["standing"]
-- reads = ["ego_state", "standstill"]
-- requires = ["map", "registration", "handedness"]
--
-- [params.parked_s]
-- default = 60.0
-- unit = "s"
-- why = "our default: an ego that stands longer than this has parked, or waits so long that it has the same effect"

-- @reference
SELECT drive_id, ego_id, t_start_ns AS t_ns, occurrence
FROM standstill
WHERE t_end_ns - t_start_ns >= $parked_s * 1e9

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, e.with_traffic AS holds,
    CASE WHEN e.lanelet_id IS NULL THEN why('stands_on_no_lane') END AS reason
FROM reference r
JOIN ego_state e USING (drive_id, ego_id, t_ns)
