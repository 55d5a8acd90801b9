-- title = "No large or towing vehicle in the right-hand lane"
-- breach = "Large or towing vehicle in the right-hand lane"
-- clause = "UKHC R265: vehicles that tow, goods vehicles over 7.5 t, and lighter ones and buses with a speed limiter must not use the right-hand lane of a motorway of three or more lanes"
-- hypothesis = "At every step with three or more lanes open in its direction, was such a vehicle outside the lane furthest from the edge?"
-- kind = "invariant"
-- derivation = "direct"
-- severity = "major"
-- legal = "must"
-- status = "stable"
-- law = ["gb"]
-- sense = "holds"
-- merge_gap_s = 5.0
-- reads = ["data_log", "ego_condition", "ego_state", "environment", "lane_next", "lanelet"]
-- requires = ["map", "registration", "handedness"]
--
-- [applies]
-- road_type = ["motorway"]
-- vehicle_class = ["car_towing", "bus", "goods_7t5", "goods_over_7t5"]
--
-- [params.through_m]
-- default = 500.0
-- unit = "m"
-- why = "our default: a lane that goes on for at least this long up to the end of the map is a through lane; lanes for joining are shorter"

-- @condition
-- Lighter goods vehicles are banned if they have a speed limiter, which no log says. A lane that ends beside a lane that goes on is for
-- joining. Where no lane goes on, the map ends.
WITH open_lane_count AS (
    SELECT environment_id, road_id, section, along_road,
        -- Two lanes that lead into the same lane count as one.
        count(DISTINCT ahead_id) + count(*) FILTER (ahead_id IS NULL AND map_ends AND length_m >= $through_m) AS n_least,
        count(DISTINCT ahead_id) + count(*) FILTER (ahead_id IS NULL AND map_ends) AS n_most
    FROM lanelet
    JOIN lane_next USING (environment_id, lanelet_id)
    WHERE lane_type = 'driving'
    GROUP BY ALL
)
SELECT e.drive_id, e.ego_id, e.t_ns,
    -- An ego that is off the lanes is not in that lane.
    CASE
        WHEN e.lanelet_id IS NULL THEN CASE WHEN e.x_m IS NOT NULL THEN false END
        WHEN o.n_least >= 3 THEN true
        WHEN coalesce(o.n_most, 0) < 3 THEN false
    END AS applies,
    CASE
        WHEN n.lane_type <> 'driving' OR coalesce(b.lane_type = 'driving' AND b.along_road = n.along_road, false) THEN true
        WHEN c.vehicle_class <> 'goods_7t5' AND n.lanelet_id IS NOT NULL THEN false
    END AS holds
FROM ego_state e
JOIN data_log g USING (drive_id)
JOIN environment m USING (environment_id)
LEFT JOIN ego_condition c USING (drive_id, ego_id, t_ns)
LEFT JOIN lanelet n ON n.environment_id = m.environment_id AND n.lanelet_id = e.lanelet_id
LEFT JOIN lanelet b ON b.environment_id = m.environment_id AND b.lanelet_id = CASE m.handedness WHEN 'lht' THEN n.right_id ELSE n.left_id END
LEFT JOIN open_lane_count o ON o.environment_id = m.environment_id AND o.road_id = n.road_id AND o.section = n.section AND o.along_road = n.along_road
