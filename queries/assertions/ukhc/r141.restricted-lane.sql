-- title = "Not in lanes kept for others"
-- breach = "In a lane kept for others"
-- clause = "UKHC R140, R141 and R142: during its hours you must not drive in a cycle lane with a solid line or a lane kept for other kinds of vehicle, and should not in a bus lane, unless signs allow your kind"
-- hypothesis = "At every step, was the ego's centre outside lanes kept for buses, taxis, cycles or shared cars?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "draft"
-- sense = "holds"
-- merge_gap_s = 2.0
-- reads = ["data_log", "ego_condition", "ego_state", "lane_occupancy", "lanelet", "map_quality"]
-- requires = ["map", "registration"]
--
-- [params.always_in_force]
-- default = false
-- unit = ""
-- why = "our default: maps do not state the hours in which such a lane is reserved for others, so it is unknown whether the ego may be there; set true for a map whose lanes are always reserved"
--
-- # Draft: hours, and how many sit in the vehicle, are in no table; what can be proved is that the ego was never there.
--
-- [reasons.on_restricted_lane]
-- says = "on lane {lanelet_id}, which is reserved for others at certain hours"
--
-- [reasons.kept_for_some]
-- says = "on lane {lanelet_id}: the map keeps cars out of it in a way that is not read"
-- advice = "provide a map that has the lane as one for buses or taxis"

-- @condition
WITH occupied_lane AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, min(o.lanelet_id) AS lanelet_id,
        bool_and(n.lane_type IN ('bus', 'taxi', 'HOV', 'biking')) AS is_restricted,
        bool_and(n.lane_type IN ('bus', 'taxi', 'HOV', 'biking') OR q.check_id IS NOT NULL) AS may_be_restricted, bool_and(n.lane_type = 'bus') AS is_bus_lane, bool_or(n.lane_type = 'HOV') AS is_hov_lane
    FROM ego_state e
    JOIN lane_occupancy o ON o.drive_id = e.drive_id AND o.actor_id = e.ego_id AND o.t_ns = e.t_ns
    JOIN data_log g ON g.drive_id = e.drive_id
    JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = o.lanelet_id
    LEFT JOIN map_quality q ON q.environment_id = n.environment_id AND q.lanelet_id = n.lanelet_id AND q.check_id = 'access_unread'
    GROUP BY ALL
)
SELECT e.drive_id, e.ego_id, e.t_ns,
    CASE
        WHEN e.x_m IS NULL THEN NULL
        WHEN NOT coalesce(l.may_be_restricted, false) OR l.is_bus_lane AND c.vehicle_class = 'bus' THEN true
        WHEN $always_in_force AND l.is_restricted AND NOT l.is_hov_lane AND c.vehicle_class <> 'motorcycle' THEN false
    END AS holds,
    CASE WHEN l.is_restricted THEN why('on_restricted_lane', {'lanelet_id': l.lanelet_id})
        WHEN l.may_be_restricted THEN why('kept_for_some', {'lanelet_id': l.lanelet_id}) END AS reason
FROM ego_state e
LEFT JOIN occupied_lane l USING (drive_id, ego_id, t_ns)
LEFT JOIN ego_condition c USING (drive_id, ego_id, t_ns)
