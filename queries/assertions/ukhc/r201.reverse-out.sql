-- # Draft: only a stop or give-way sign shows which road is the lesser one; driveways are not in map tables.
-- title = "Do not reverse out of a side road"
-- breach = "Reversed out of a side road"
-- clause = "UKHC R201: do not reverse from a side road into a main road"
-- hypothesis = "When the ego reversed into a junction, did it come from a road without a stop or give-way sign there?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "major"
-- legal = "should"
-- status = "draft"
-- sense = "holds"
-- reads = ["data_log", "ego_motion", "ego_state", "lanelet", "traffic_signal"]
-- requires = ["map", "registration"]
--
-- [params.back_mps]
-- default = 0.5
-- unit = "m/s"
-- why = "our default: slower than this is standing: recorded speeds of standing vehicles jitter"

-- @reference
SELECT e.drive_id, e.ego_id, e.t_ns, lag(e.lanelet_id) OVER step_order AS from_lanelet_id
FROM ego_state e
JOIN ego_motion m USING (drive_id, ego_id, t_ns)
WINDOW step_order AS (PARTITION BY e.drive_id, e.ego_id ORDER BY e.t_ns)
QUALIFY m.v_long_mps < -$back_mps AND e.in_junction AND NOT lag(e.in_junction) OVER step_order

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, NOT coalesce(bool_or(t.kind IN ('stop', 'give_way')), false) AS holds
FROM reference r
JOIN data_log g ON g.drive_id = r.drive_id
JOIN lanelet n ON n.environment_id = g.environment_id AND n.lanelet_id = r.from_lanelet_id
LEFT JOIN traffic_signal t ON t.environment_id = n.environment_id AND t.road_id = n.road_id
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id
