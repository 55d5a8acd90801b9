-- title = "No stopping on a motorway"
-- clause = "UKHC R240: you must not stop on the carriageway of a motorway, nor on a clearway"
-- hypothesis = "At every step on a motorway, had the ego not stood for long of its own accord?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- reads = ["ego_state", "lead", "standstill"]
-- requires = ["map", "registration", "ego_size", "road_types"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.stop_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: shorter is a pause in traffic"
--
-- [params.near_m]
-- default = 10.0
-- unit = "m"
-- why = "our default: who stands closer than this behind somebody stands because of them"

-- @condition
-- clearways and zig-zags are not in map tables; crossings have r191.no-stopping
SELECT e.drive_id, e.ego_id, e.t_ns,
    CASE WHEN s.t_start_ns IS NOT NULL THEN l.gap_m IS NOT NULL AND l.gap_m <= $near_m OR CASE WHEN l.t_ns IS NOT NULL THEN false END
        WHEN e.speed_mps IS NOT NULL THEN true END AS holds,
    CASE WHEN s.t_start_ns IS NOT NULL AND l.t_ns IS NULL THEN 'the ego stands, and not everybody ahead can be placed'
        WHEN s.t_start_ns IS NOT NULL THEN format('the ego has stood for {:.1f} s', (e.t_ns - s.t_start_ns) / 1e9) END AS reason
FROM ego_state e
LEFT JOIN lead l ON l.drive_id = e.drive_id AND l.ego_id = e.ego_id AND l.t_ns = e.t_ns
LEFT JOIN standstill s ON s.drive_id = e.drive_id AND s.ego_id = e.ego_id
    AND s.t_start_ns + ($stop_s * 1e9)::BIGINT < e.t_ns AND s.t_end_ns >= e.t_ns
