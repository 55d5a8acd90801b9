-- title = "Not on the hard shoulder"
-- breach = "On the hard shoulder"
-- clause = "UKHC R269: you must not drive on the hard shoulder of a motorway except in an emergency, where signs open it, or when told to"
-- hypothesis = "At every step on a motorway without an emergency, was the ego's centre off the hard shoulder?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- merge_gap_s = 5.0
-- tags = ["excuses", "standing"]
-- reads = ["data_log", "ego_condition", "ego_mode", "ego_state", "lane_occupancy", "lanelet", "map_quality"]
-- requires = ["map", "registration"]
--
-- [params.warns_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: an ego that has to stop there puts the hazard lights on within this time after getting there, or after stopping"
--
-- [params.stops_mps2]
-- default = 2.0
-- unit = "m/s2"
-- why = "our default: braking in comfort; an ego that takes longer to stop is driving along the shoulder, and if its hazard lights are on, a person must judge why"
--
-- [params.rejoins_s]
-- default = 20.0
-- unit = "s"
-- why = "our default: time to build up speed on it after a breakdown, as R276 demands"
--
-- [reasons.drove_with_hazard_lights]
-- says = "the ego drove along the hard shoulder with its hazard lights on"
-- advice = "see in a video whether that was an emergency"
--
-- [reasons.stop_unseen]
-- says = "the log does not show whether the ego stops with its hazard lights on"
--
-- [reasons.may_be_open]
-- says = "the map states that the shoulder may be opened to traffic: it is not known whether it was"
-- advice = "provide a map that has the shoulder as a driving lane, if it was open"

-- @condition
-- An emergency is a declared mode, or hazard lights on an ego that stops.
WITH occupied_lane AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, bool_and(n.lane_type IN ('shoulder', 'stop')) AS is_shoulder, bool_or(q.check_id IS NOT NULL) AS may_be_open, min(n.road_type) AS road_type
    FROM ego_state e
    JOIN lane_occupancy o ON o.drive_id = e.drive_id AND o.actor_id = e.ego_id AND o.t_ns = e.t_ns
    JOIN data_log g ON g.drive_id = e.drive_id
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
    LEFT JOIN map_quality q ON q.environment_id = n.environment_id AND q.lanelet_id = n.lanelet_id AND q.check_id = 'lane_type_varies'
    GROUP BY ALL
),
emergency_step AS (
    SELECT drive_id, ego_id, t_ns, bool_or(is_declared) AS is_declared
    FROM (
        SELECT drive_id, ego_id, t_ns, true AS is_declared FROM ego_mode WHERE mode IN ('minimal_risk_manoeuvre', 'emergency_manoeuvre') AND is_on
        UNION ALL
        SELECT drive_id, ego_id, t_ns, false FROM ego_state WHERE indicator = 'hazard'
    )
    GROUP BY ALL
),
ego_step AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns, e.speed_mps, l.is_shoulder, x.t_ns IS NOT NULL AS warns, coalesce(x.is_declared, false) AS is_declared, x.t_ns IS NOT NULL AND e.speed_mps <= standing_mps() AS stands,
        max(e.t_ns) OVER (PARTITION BY e.drive_id, e.ego_id) AS t_end_ns,
        row_number() OVER (PARTITION BY e.drive_id, e.ego_id ORDER BY e.t_ns) - row_number() OVER (PARTITION BY e.drive_id, e.ego_id, l.is_shoulder ORDER BY e.t_ns) AS n
    FROM ego_state e
    LEFT JOIN occupied_lane l USING (drive_id, ego_id, t_ns)
    LEFT JOIN emergency_step x USING (drive_id, ego_id, t_ns)
),
-- The ego is excused if it comes onto the shoulder, or stops there, and warns soon, and if it builds up speed after it stood there.
excuse AS (
    SELECT
        drive_id, ego_id, t_ns,
        CASE
            WHEN bool_or(is_declared) OVER soon THEN true
            WHEN bool_or(stands) OVER (stretch RANGE BETWEEN CURRENT ROW AND (($warns_s + coalesce(speed_mps, 0.0) / $stops_mps2) * 1e9)::BIGINT FOLLOWING) THEN true
            WHEN bool_or(stands) OVER (stretch RANGE BETWEEN ($rejoins_s * 1e9)::BIGINT PRECEDING AND CURRENT ROW) THEN true
            WHEN bool_or(warns) OVER soon THEN NULL
            WHEN last_value(t_ns) OVER (stretch ROWS BETWEEN CURRENT ROW AND UNBOUNDED FOLLOWING) < t_end_ns OR t_ns + ($warns_s * 1e9)::BIGINT <= t_end_ns THEN false
        END AS excuse
    FROM ego_step
    WHERE is_shoulder
    WINDOW stretch AS (PARTITION BY drive_id, ego_id, n ORDER BY t_ns),
        soon AS (PARTITION BY drive_id, ego_id, n ORDER BY t_ns RANGE BETWEEN CURRENT ROW AND ($warns_s * 1e9)::BIGINT FOLLOWING)
)
-- Where the map has no lane under the ego, there may be a shoulder. The kind of road matters only on a shoulder.
SELECT e.drive_id, e.ego_id, e.t_ns, CASE WHEN NOT (l.is_shoulder AND l.may_be_open) THEN NOT l.is_shoulder END AS holds,
    CASE WHEN m.is_declared OR x.excuse OR m.t_ns IS NOT NULL AND l.is_shoulder IS DISTINCT FROM true THEN false
        WHEN NOT l.is_shoulder OR e.x_m IS NOT NULL AND l.is_shoulder IS NULL THEN coalesce(c.road_type, l.road_type, '') = 'motorway'
        ELSE coalesce(c.road_type, l.road_type) = 'motorway' AND NOT x.excuse END AS applies,
    CASE WHEN l.is_shoulder AND x.excuse IS NULL THEN CASE WHEN m.t_ns IS NOT NULL THEN why('drove_with_hazard_lights') ELSE why('stop_unseen') END
        WHEN l.is_shoulder AND l.may_be_open THEN why('may_be_open') END AS reason
FROM ego_state e
LEFT JOIN occupied_lane l USING (drive_id, ego_id, t_ns)
LEFT JOIN emergency_step m USING (drive_id, ego_id, t_ns)
LEFT JOIN excuse x USING (drive_id, ego_id, t_ns)
LEFT JOIN ego_condition c USING (drive_id, ego_id, t_ns)
