-- title = "Large and towing vehicles out of the right-hand lane"
-- clause = "UKHC R265: vehicles that tow, goods vehicles over 7.5 t, limited lighter ones and limited buses must not use the right-hand lane of a motorway of three or more lanes"
-- hypothesis = "At every step, was such a vehicle off the lane furthest from the edge where there are three or more?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- sense = "holds"
-- merge_gap_s = 5.0
-- reads = ["data_log", "ego_condition", "ego_state", "environment", "lane_next", "lanelet"]
-- requires = ["map", "registration", "handedness"]
--
-- [applies]
-- road_type = ["motorway"]
-- vehicle_class = ["car_towing", "bus", "goods_7t5", "goods_over_7t5"]

-- @condition
-- lighter goods vehicles are banned if they have a speed limiter, which no log says; a lane that leads no further is for joining
WITH wide AS (
    SELECT environment_id, road_id, section, along_road FROM lanelet JOIN lane_next USING (environment_id, lanelet_id)
    WHERE lane_type = 'driving' AND ahead_id IS NOT NULL
    GROUP BY ALL HAVING count(*) >= 3
)
SELECT e.drive_id, e.ego_id, e.t_ns,
    CASE
        WHEN e.lanelet_id IS NULL THEN CASE WHEN e.x_m IS NOT NULL THEN true END
        WHEN w.road_id IS NULL OR n.lane_type <> 'driving' OR coalesce(b.lane_type = 'driving' AND b.along_road = n.along_road, false) THEN true
        WHEN c.vehicle_class <> 'goods_7t5' THEN false
    END AS holds
FROM ego_state e
JOIN data_log g USING (drive_id)
JOIN environment m USING (environment_id)
LEFT JOIN ego_condition c USING (drive_id, ego_id, t_ns)
LEFT JOIN lanelet n ON n.environment_id = m.environment_id AND n.lanelet_id = e.lanelet_id
LEFT JOIN lanelet b ON b.environment_id = m.environment_id AND b.lanelet_id = CASE m.handedness WHEN 'lht' THEN n.right_id ELSE n.left_id END
LEFT JOIN wide w ON w.environment_id = m.environment_id AND w.road_id = n.road_id AND w.section = n.section AND w.along_road = n.along_road
