-- title = "Able to stop within the road seen to be clear"
-- breach = "Too fast to stop within the road seen to be clear"
-- clause = "UKHC R126, R227 and R230: drive at a speed that lets you stop well within the distance you can see to be clear; further in the wet and on ice"
-- hypothesis = "At every step, did the road that the ego could see reach at least as far as its stopping distance?"
-- kind = "invariant"
-- derivation = "model"
-- severity = "critical"
-- legal = "should"
-- status = "draft"
-- sense = ">="
-- unit = "m"
-- observes = "road ahead within sensor range"
-- near_margin = 5.0
-- reads = ["ego_condition", "ego_state", "oncoming"]
-- requires = ["map", "registration", "ego_size"]
--
-- # Draft: bends, crests and buildings that hide the road are not in the tables; what is known is how far the corridor and the sensors reach. The
-- # end of the map or of the corridor is no end of sight, so it is a lower bound; vehicles on the road are the business of r126.stopping-gap.
--
-- [reasons.driving_side_unknown]
-- says = "the length of the road ahead is not known, because the side that is driven on is not known"
-- advice = "set it with --handedness"
--
-- [reasons.map_too_short]
-- says = "the map has only {free_m:.0f} m of the road ahead"
-- advice = "use a map that extends further"

-- @condition
SELECT e.drive_id, e.ego_id, e.t_ns, o.free_m AS observed, stopping_factor(c.weather) * stopping_distance_m(e.speed_mps) AS required,
    o.free_reason <> 'sensor_range' AS at_least,
    CASE WHEN e.front_s_m IS NOT NULL AND o.t_ns IS NULL THEN why('driving_side_unknown')
        WHEN o.free_m < stopping_factor(c.weather) * stopping_distance_m(e.speed_mps) AND o.free_reason <> 'sensor_range'
            THEN why('map_too_short', {'free_m': o.free_m}) END AS reason
FROM ego_state e
LEFT JOIN oncoming o USING (drive_id, ego_id, t_ns)
LEFT JOIN ego_condition c USING (drive_id, ego_id, t_ns)
