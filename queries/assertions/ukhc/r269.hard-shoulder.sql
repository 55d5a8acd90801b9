-- title = "Not on the hard shoulder"
-- clause = "UKHC R269: you must not drive on the hard shoulder of a motorway except in an emergency, where signs open it, or when told to"
-- hypothesis = "At every step on a motorway without an emergency, was the ego's centre off the hard shoulder?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- merge_gap_s = 5.0
-- reads = ["data_log", "ego_condition", "ego_mode", "ego_state", "lane_occupancy", "lanelet"]
-- requires = ["map", "registration"]

-- @condition
-- an emergency: hazard lights, or a mode that says so
WITH lane AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, bool_and(n.lane_type IN ('shoulder', 'stop')) AS shoulder, min(n.road_type) AS road_type
    FROM ego_state e
    JOIN lane_occupancy o ON o.drive_id = e.drive_id AND o.actor_id = e.ego_id AND o.t_ns = e.t_ns
    JOIN data_log g ON g.drive_id = e.drive_id
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
    GROUP BY ALL
),
emergency AS (
    SELECT DISTINCT drive_id, ego_id, t_ns FROM ego_mode WHERE mode IN ('minimal_risk_manoeuvre', 'emergency_manoeuvre') AND is_on
)
-- off all that the map knows, there may be a shoulder; what kind of road it is matters only on one
SELECT e.drive_id, e.ego_id, e.t_ns, NOT l.shoulder AS holds,
    CASE WHEN x.t_ns IS NOT NULL OR e.indicator = 'hazard' THEN false
        WHEN NOT l.shoulder OR e.x_m IS NOT NULL AND l.shoulder IS NULL THEN coalesce(c.road_type, l.road_type, '') = 'motorway'
        ELSE coalesce(c.road_type, l.road_type) = 'motorway' END AS applies
FROM ego_state e
LEFT JOIN lane l USING (drive_id, ego_id, t_ns)
LEFT JOIN emergency x USING (drive_id, ego_id, t_ns)
LEFT JOIN ego_condition c USING (drive_id, ego_id, t_ns)
