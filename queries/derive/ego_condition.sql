-- What holds at every step of the ego: as given for the drive (drive_condition), else as the map, the log and the ego itself say.
WITH given AS (
    SELECT
        drive_id,
        max(value) FILTER (condition = 'road_type') AS road_type, max(value) FILTER (condition = 'carriageway') AS carriageway,
        max(value) FILTER (condition = 'area') AS area, max(value) FILTER (condition = 'nation') AS nation,
        max(value) FILTER (condition = 'weather') AS weather, max(value) FILTER (condition = 'light') AS light,
        max(value) FILTER (condition = 'vehicle_class') AS vehicle_class, max(value) FILTER (condition = 'engaged') AS engaged
    FROM drive_condition GROUP BY drive_id
),
-- a cross-section: its two directions run side by side, or something lies or may lie between them, or there is only one
road AS (
    SELECT
        n.environment_id, n.road_id, n.section,
        coalesce(bool_or(n.drivable AND n.bidirectional OR b.strip IS NULL AND b.gap_m <= reservation_m()), false) AS touching,
        coalesce(bool_or(b.gap_m > reservation_m()), false) AS near,
        count(DISTINCT n.along_road) FILTER (n.drivable) = 2 AS both_ways,
        least(count(DISTINCT n.lanelet_id) FILTER (n.drivable AND n.along_road = 1), count(DISTINCT n.lanelet_id) FILTER (n.drivable AND n.along_road = -1)) AS lanes_each_way,
        bool_or(n.lane_type = 'median') AS median
    FROM lanelet n
    LEFT JOIN lane_beside b ON b.environment_id = n.environment_id AND b.lanelet_id = n.lanelet_id AND b.against AND b.drivable
    GROUP BY ALL
),
here AS (
    SELECT
        st.drive_id, st.ego_id, st.t_ns, coalesce(g.road_type, e.road_type, a.road_type) AS road_type, e.limit_mps,
        CASE WHEN n.junction_id IS NULL THEN r.touching END AS touching,
        CASE WHEN n.junction_id IS NULL THEN r.near END AS near,
        CASE WHEN n.junction_id IS NULL THEN r.both_ways END AS both_ways,
        CASE WHEN n.junction_id IS NULL AND r.both_ways THEN r.lanes_each_way END AS lanes_each_way,
        CASE WHEN n.junction_id IS NULL THEN r.median END AS median
    FROM step st
    JOIN data_log l ON l.drive_id = st.drive_id
    LEFT JOIN given g ON g.drive_id = st.drive_id
    LEFT JOIN ego_state e ON e.drive_id = st.drive_id AND e.ego_id = st.ego_id AND e.t_ns = st.t_ns
    LEFT JOIN ego_aside a ON a.drive_id = st.drive_id AND a.ego_id = st.ego_id AND a.t_ns = st.t_ns
    LEFT JOIN lanelet n ON n.environment_id = l.environment_id AND n.lanelet_id = e.lanelet_id
    LEFT JOIN road r ON r.environment_id = n.environment_id AND r.road_id = n.road_id AND r.section = n.section
),
declares AS (
    SELECT DISTINCT drive_id, ego_id FROM ego_mode WHERE mode = 'engaged'
),
towing AS (
    SELECT DISTINCT drive_id, ego_id FROM ego_part WHERE part = 'trailer'
)
SELECT
    h.drive_id, h.ego_id, h.t_ns, h.road_type,
    coalesce(g.carriageway, CASE
        -- the directions of a motorway are apart, however near to each other a map draws their two roads
        WHEN NOT h.both_ways AND h.road_type = 'motorway' THEN 'dual'
        WHEN h.touching THEN 'single'
        WHEN h.both_ways THEN CASE WHEN h.median OR h.road_type = 'motorway' THEN 'dual' END
        -- out of town a road of one direction is half of one; in town it may as well be a one-way street
        WHEN NOT h.both_ways AND NOT h.near AND h.road_type = 'rural' THEN 'dual'
    END) AS carriageway,
    h.lanes_each_way,
    coalesce(g.area, CASE
        WHEN h.road_type = 'townExpressway' THEN NULL
        WHEN starts_with(h.road_type, 'town') OR h.road_type = 'lowSpeed' THEN 'built_up'
        WHEN h.road_type IN ('motorway', 'rural') THEN 'open'
    END) AS area,
    g.nation, g.weather, g.light,
    -- a van may be a car-derived one or a goods vehicle, a lorry may be of any weight; who draws a trailer is no longer of its own class
    coalesce(g.vehicle_class, CASE
        WHEN t.ego_id IS NULL THEN CASE WHEN a.actor_class IN ('car', 'bus', 'motorcycle') THEN a.actor_class END
        WHEN a.actor_class = 'car' THEN 'car_towing'
    END) AS vehicle_class,
    h.limit_mps,
    CASE
        WHEN g.engaged IS NOT NULL THEN g.engaged = 'yes'
        WHEN d.ego_id IS NOT NULL THEN m.is_on
        ELSE true
    END AS engaged
FROM here h
JOIN actor a ON a.drive_id = h.drive_id AND a.actor_id = h.ego_id
LEFT JOIN given g ON g.drive_id = h.drive_id
LEFT JOIN towing t ON t.drive_id = h.drive_id AND t.ego_id = h.ego_id
LEFT JOIN declares d ON d.drive_id = h.drive_id AND d.ego_id = h.ego_id
LEFT JOIN ego_mode m ON m.drive_id = h.drive_id AND m.ego_id = h.ego_id AND m.t_ns = h.t_ns AND m.mode = 'engaged'
