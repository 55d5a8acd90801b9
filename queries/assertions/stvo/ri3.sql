-- title = "No turning round and no reversing"
-- breach = "Turned round or reversed"
-- clause = "StVO 18(7) (R_I3 of Maierhofer et al. 2020): on motorways turning round and reversing are forbidden"
-- hypothesis = "At every step, did the ego head and move in the direction of its lane?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- law = ["de"]
-- sense = "holds"
-- merge_gap_s = 5.0
-- reads = ["ego_motion", "ego_state"]
-- requires = ["map", "registration"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.reverse_mps]
-- default = 0.5
-- unit = "m/s"
-- why = "our default, as in ukhc.r263.no-reverse: slower than this is standing: recorded speeds of standing vehicles jitter"

-- @condition
SELECT drive_id, ego_id, t_ns, e.with_traffic AND m.v_long_mps >= -$reverse_mps AS holds
FROM ego_state e
JOIN ego_motion m USING (drive_id, ego_id, t_ns)
