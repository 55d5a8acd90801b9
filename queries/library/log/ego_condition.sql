-- The conditions at every step of the ego: as given for the drive (drive_condition), else from the map, the log and the ego's data.
-- lifetime: part
CREATE TABLE ego_condition (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step
    road_type VARCHAR,                -- [road_type] of the lanelet, or as given; NULL: not known
    carriageway VARCHAR,              -- [carriageway] as the map's lanes show, or as given; NULL: not known
    lanes_each_way BIGINT,            -- number of drivable lanes of the ego's road, in the direction that has fewer; NULL: not known, or only one direction
    area VARCHAR,                     -- [area] by road type, or as given; NULL: not known
    nation VARCHAR,                   -- [nation] NULL: not given
    weather VARCHAR,                  -- [weather] NULL: not given
    light VARCHAR,                    -- [light] NULL: not given
    vehicle_class VARCHAR,            -- [vehicle_class] of the ego: as given, or by its actor class; car_towing for a car that tows a trailer (see _ego_part); NULL: not known, or another vehicle that tows a trailer
    limit_mps DOUBLE,                 -- the map's speed limit at the ego's position; NULL: the map does not state it
    engaged BOOLEAN                   -- the automated driver drives: by its mode flag, or as given; true without either; NULL: the log has flags, but none is known at this step
);

INSERT INTO ego_condition BY NAME
WITH given_condition AS (
    SELECT
        drive_id,
        max(value) FILTER (condition = 'road_type') AS road_type, max(value) FILTER (condition = 'carriageway') AS carriageway,
        max(value) FILTER (condition = 'area') AS area, max(value) FILTER (condition = 'nation') AS nation,
        max(value) FILTER (condition = 'weather') AS weather, max(value) FILTER (condition = 'light') AS light,
        max(value) FILTER (condition = 'vehicle_class') AS vehicle_class, max(value) FILTER (condition = 'engaged') AS engaged
    FROM drive_condition GROUP BY drive_id
),
-- A cross-section of a road. Its two directions are side by side (directions_touch), or there is or may be something between them, or it
-- has only one direction.
cross_section AS (
    SELECT
        n.environment_id, n.road_id, n.section,
        coalesce(bool_or(n.drivable AND n.bidirectional OR b.strip IS NULL AND b.gap_m <= reservation_m()), false) AS directions_touch,
        coalesce(bool_or(b.gap_m > reservation_m()), false) AS has_gap,
        count(DISTINCT n.along_road) FILTER (n.drivable) = 2 AS has_both_ways,
        least(count(DISTINCT n.lanelet_id) FILTER (n.drivable AND n.along_road = 1), count(DISTINCT n.lanelet_id) FILTER (n.drivable AND n.along_road = -1)) AS lanes_each_way,
        bool_or(n.lane_type = 'median') AS has_median
    FROM lanelet n
    LEFT JOIN lane_beside b ON b.environment_id = n.environment_id AND b.lanelet_id = n.lanelet_id AND b.against AND b.drivable
    GROUP BY ALL
),
step_road AS (
    SELECT
        st.drive_id, st.ego_id, st.t_ns, coalesce(g.road_type, e.road_type, a.aside_road_type) AS road_type, e.limit_mps,
        CASE WHEN n.junction_id IS NULL THEN r.directions_touch END AS directions_touch,
        CASE WHEN n.junction_id IS NULL THEN r.has_gap END AS has_gap,
        CASE WHEN n.junction_id IS NULL THEN r.has_both_ways END AS has_both_ways,
        CASE WHEN n.junction_id IS NULL AND r.has_both_ways THEN r.lanes_each_way END AS lanes_each_way,
        CASE WHEN n.junction_id IS NULL THEN r.has_median END AS has_median
    FROM step st
    JOIN data_log l ON l.drive_id = st.drive_id
    LEFT JOIN given_condition g ON g.drive_id = st.drive_id
    LEFT JOIN ego_state e ON e.drive_id = st.drive_id AND e.ego_id = st.ego_id AND e.t_ns = st.t_ns
    LEFT JOIN ego_lane a ON a.drive_id = st.drive_id AND a.ego_id = st.ego_id AND a.t_ns = st.t_ns
    LEFT JOIN lanelet n ON n.environment_id = l.environment_id AND n.lanelet_id = e.lanelet_id
    LEFT JOIN cross_section r ON r.environment_id = n.environment_id AND r.road_id = n.road_id AND r.section = n.section
),
ego_with_engaged_mode AS (
    SELECT DISTINCT drive_id, ego_id FROM ego_mode WHERE mode = 'engaged'
),
towing_ego AS (
    SELECT DISTINCT drive_id, ego_id FROM _ego_part WHERE part = 'trailer'
)
SELECT
    h.drive_id, h.ego_id, h.t_ns, h.road_type,
    coalesce(g.carriageway, CASE
        -- The two directions of a motorway are separated, even if the map draws their roads close to each other.
        WHEN NOT h.has_both_ways AND h.road_type = 'motorway' THEN 'dual'
        WHEN h.directions_touch THEN 'single'
        WHEN h.has_both_ways THEN CASE WHEN h.has_median OR h.road_type = 'motorway' THEN 'dual' END
        -- Out of town, a road of one direction is one half of a dual carriageway. In town it may as well be a one-way street.
        WHEN NOT h.has_both_ways AND NOT h.has_gap AND h.road_type = 'rural' THEN 'dual'
    END) AS carriageway,
    h.lanes_each_way,
    coalesce(g.area, CASE
        WHEN h.road_type = 'townExpressway' THEN NULL
        WHEN starts_with(h.road_type, 'town') OR h.road_type = 'lowSpeed' THEN 'built_up'
        WHEN h.road_type IN ('motorway', 'rural') THEN 'open'
    END) AS area,
    g.nation, g.weather, g.light,
    -- A van may be a car-derived van or a goods vehicle, a lorry may be of any weight. A trailer changes the class of its tractor.
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
FROM step_road h
JOIN actor a ON a.drive_id = h.drive_id AND a.actor_id = h.ego_id
LEFT JOIN given_condition g ON g.drive_id = h.drive_id
LEFT JOIN towing_ego t ON t.drive_id = h.drive_id AND t.ego_id = h.ego_id
LEFT JOIN ego_with_engaged_mode d ON d.drive_id = h.drive_id AND d.ego_id = h.ego_id
LEFT JOIN ego_mode m ON m.drive_id = h.drive_id AND m.ego_id = h.ego_id AND m.t_ns = h.t_ns AND m.mode = 'engaged'
