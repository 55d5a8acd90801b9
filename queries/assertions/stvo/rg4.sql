-- title = "Keeping the traffic flowing"
-- clause = "StVO 3(2) (R_G4 of Maierhofer et al. 2020): without good reason do not drive so slowly that you hinder the traffic"
-- hypothesis = "At every step without a slow vehicle ahead, or somebody else in the way, was the ego less than the allowed difference below the speed limit?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "minor"
-- legal = "must"
-- status = "stable"
-- law = ["de"]
-- sense = ">"
-- unit = "m/s"
-- observes = "speed"
-- exempt_after_s = "settle_s"
-- merge_gap_s = 5.0
-- reads = ["ego_condition", "ego_mode", "ego_state", "in_way", "lead"]
-- requires = ["map", "registration", "ego_size", "speed_limits"]
--
-- [applies]
-- road_type = ["motorway"]
--
-- [params.slower_mps]
-- default = 15.0
-- unit = "m/s"
-- why = "so far below the limit the traffic is hindered"
-- source = "Maierhofer et al. 2020, Table II"
--
-- [params.settle_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: time to speed up after the motorway is entered, or the slow vehicle ahead has gone or sped up"
--
-- [params.start_s]
-- default = 15.0
-- unit = "s"
-- why = "our default: time to speed up from standing: 1.2 m/s2 to 18 m/s"
--
-- [params.desired_mps]
-- default = 36.11
-- unit = "m/s"
-- why = "130 km/h, the recommended speed: no more is asked for"
-- source = "Autobahn-Richtgeschwindigkeits-Verordnung 1"

-- @condition
SELECT drive_id, ego_id, t_ns, e.speed_mps AS observed, c.top_mps - $slower_mps AS required,
    -- a vehicle ahead that is as slow itself is the reason; no row of lead: there may be one
    -- somebody on foot, an animal or a thing in the way is one too
    -- nor does one hinder by choice that speeds up from standing, or declares a minimal risk manoeuvre
    CASE WHEN e.stood AND e.speed_mps > standing_mps() OR r.is_on OR NOT may_be_vehicle(w.actor_class) THEN false WHEN l.t_ns IS NOT NULL THEN l.object_id IS NULL OR l.speed_mps > c.top_mps - $slower_mps
        WHEN e.speed_mps > c.top_mps - $slower_mps THEN true END AS applies
FROM (
    SELECT *, bool_or(speed_mps <= standing_mps()) OVER (
        PARTITION BY drive_id, ego_id ORDER BY t_ns RANGE BETWEEN ($start_s * 1e9)::BIGINT PRECEDING AND CURRENT ROW
    ) AS stood
    FROM ego_state
) e
JOIN (SELECT *, CASE WHEN limit_mps > $desired_mps THEN $desired_mps ELSE limit_mps END AS top_mps FROM ego_condition) c USING (drive_id, ego_id, t_ns)
LEFT JOIN lead l USING (drive_id, ego_id, t_ns)
LEFT JOIN in_way w USING (drive_id, ego_id, t_ns)
LEFT JOIN (SELECT * FROM ego_mode WHERE mode = 'minimal_risk_manoeuvre') r USING (drive_id, ego_id, t_ns)
