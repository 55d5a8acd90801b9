-- title = "No hazard lights while driving"
-- breach = "Hazard lights while driving"
-- clause = "UKHC R116: you must not use hazard warning lights while driving, except to warn of a hazard ahead on a motorway or unrestricted dual carriageway"
-- hypothesis = "At every step, were the hazard lights off, or was the ego standing?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "minor"
-- legal = "must"
-- status = "stable"
-- law = ["gb"]
-- sense = "holds"
-- tags = ["standing"]
-- reads = ["ego_condition", "ego_state"]
-- requires = ["indicator"]
--
-- [params.rolling_mps]
-- default = 1.0
-- unit = "m/s"
-- why = "our default: the last of rolling to a stop is not driving"
--
-- [params.unrestricted_mps]
-- default = 22.36
-- unit = "m/s"
-- why = "50 mph is 22.352 m/s: a dual carriageway with a higher limit is unrestricted"
-- source = "UKHC R46: unrestricted dual carriageways where the speed limit exceeds 50 mph; Road Vehicles Lighting Regulations 1989, regulation 3 (not seen)"
--
-- [params.street_mps]
-- default = 13.42
-- unit = "m/s"
-- why = "our default, 30 mph: a road whose kind is not known is no motorway if its limit is as low as this"
--
-- [reasons.motorway_unknown]
-- says = "it is not known whether this road is a motorway"
-- advice = "set it, such as --env road_type=rural"
--
-- [reasons.may_warn_here]
-- says = "hazard lights are allowed as a warning on this road: a person must judge whether there was a hazard ahead"
--
-- [reasons.dual_carriageway_unknown]
-- says = "it is not known whether this road is a dual carriageway"
--
-- [reasons.carriageway_limit_unknown]
-- says = "the speed limit of this dual carriageway is not known"

-- @condition
SELECT e.drive_id, e.ego_id, e.t_ns,
    -- On a road where hazard lights may warn others, a person must judge whether there was a hazard.
    CASE WHEN e.indicator <> 'hazard' OR e.speed_mps <= $rolling_mps THEN true
        WHEN e.indicator = 'hazard' AND e.speed_mps > $rolling_mps AND NOT coalesce(c.road_type = 'motorway', false)
            -- A motorway is a dual carriageway, and may have a lower limit.
            AND (c.carriageway <> 'dual' OR c.limit_mps < $unrestricted_mps AND (c.road_type IS NOT NULL OR c.limit_mps <= $street_mps)) THEN false END AS holds,
    CASE WHEN e.indicator = 'hazard' AND (c.road_type = 'motorway' OR c.carriageway = 'dual' AND c.limit_mps >= $unrestricted_mps)
            THEN why('may_warn_here')
        WHEN e.indicator = 'hazard' AND c.road_type IS NULL AND c.limit_mps < $unrestricted_mps AND c.limit_mps > $street_mps AND coalesce(c.carriageway = 'dual', true) THEN why('motorway_unknown')
        WHEN e.indicator = 'hazard' AND c.carriageway IS NULL THEN why('dual_carriageway_unknown')
        WHEN e.indicator = 'hazard' AND c.carriageway = 'dual' AND c.limit_mps IS NULL THEN why('carriageway_limit_unknown') END AS reason
FROM ego_state e
LEFT JOIN ego_condition c USING (drive_id, ego_id, t_ns)
