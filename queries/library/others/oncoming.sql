-- The nearest vehicle that comes towards the ego in the lane in which the ego would overtake, and the distance ahead up to which this is
-- known. OV (oncoming vehicle) and DA (distance ahead) are terms of Harper et al. 2021.
-- lifetime: part
CREATE TABLE oncoming (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; no row: the ego's own position or the side of overtaking is not known
    object_id VARCHAR,                -- OV: the nearest oncoming vehicle, on the overtaking chain or on its way to it; NULL: none seen
    da_m DOUBLE,                      -- distance ahead: from the ego's front to the OV's front along the corridor; NULL: no OV {position}
    speed_mps DOUBLE,                 -- speed of the OV {velocity}
    on_its_way BOOLEAN,               -- the OV was still on another lane: da_m includes the distance that it drove to the corridor {position, heading, velocity}
    free_m DOUBLE NOT NULL,           -- how far ahead of the ego's front both the corridor and the sensor range reach {position, heading, size}
    free_reason VARCHAR NOT NULL,     -- [free_end] what limits free_m
    n_unplaced BIGINT NOT NULL,       -- number of other vehicles without a position on the road: one of them may be nearer than the OV {position}
    unplaced_reason VARCHAR           -- why one of these vehicles has no position, as JSON from the macro why
);

INSERT INTO oncoming BY NAME
WITH corridor_end AS (
    SELECT c.drive_id, c.ego_id, c.chain_id, max(c.s_start_m + c.length_m) AS end_m, max({'seq': c.seq, 'id': c.lanelet_id}).id AS last_id
    FROM _corridor c
    GROUP BY ALL
),
ego_step AS (
    SELECT
        e.drive_id, e.ego_id, e.t_ns,
        -- At least up to this distance ahead, all vehicles have positions on the corridor, even if the ego's own path is longer.
        least(r.end_m - e.front_s_m, corridor_ahead_m()) AS corridor_m,
        n.ahead_id IS NULL AND r.end_m - e.front_s_m <= corridor_ahead_m() AS map_ends, g.sensor_range_m - e.length_m / 2 AS range_m
    FROM ego_state e
    JOIN ego_corridor x ON x.drive_id = e.drive_id AND x.ego_id = e.ego_id AND x.chain_id = e.chain_id AND x.t_ns = e.t_ns
    JOIN corridor_end r ON r.drive_id = e.drive_id AND r.ego_id = e.ego_id AND r.chain_id = e.chain_id
    JOIN data_log g ON g.drive_id = e.drive_id
    LEFT JOIN lane_next n ON n.environment_id = g.environment_id AND n.lanelet_id = r.last_id
    WHERE e.front_s_m IS NOT NULL AND x.side IS NOT NULL
),
nearest_vehicle AS (
    SELECT drive_id, ego_id, t_ns, min({'da_m': da_m, 'object_id': object_id, 'speed_mps': speed_mps, 'is_coming': on_its_way}) AS ov
    FROM _oncoming_vehicle
    WHERE vehicle
    GROUP BY ALL
),
-- An object that is behind the ego, or that always moves in the ego's direction when seen, is not oncoming.
object_not_oncoming AS (
    SELECT drive_id, ego_id, t_ns, object_id FROM hidden WHERE NOT ahead OR along
),
doubtful_object AS (
    SELECT u.drive_id, u.ego_id, u.t_ns, count(DISTINCT u.object_id) AS n, min({'object_id': u.object_id, 'lack': u.code}) AS u
    FROM (
        SELECT drive_id, ego_id, t_ns, object_id, code FROM unplaced
        UNION ALL
        SELECT drive_id, ego_id, t_ns, object_id, 'no_class' FROM _oncoming_vehicle WHERE vehicle IS NULL
    ) u
    ANTI JOIN object_not_oncoming b ON b.drive_id = u.drive_id AND b.ego_id = u.ego_id AND b.t_ns = u.t_ns AND b.object_id = u.object_id
    LEFT JOIN nearest_vehicle n ON n.drive_id = u.drive_id AND n.ego_id = u.ego_id AND n.t_ns = u.t_ns
    -- A vehicle beyond the end of the map causes no doubt, because free_m ends there. A vehicle that the ego has already met is behind. The
    -- nearest OV itself causes a doubt only if it came from off the lanes, because its remaining distance to the lane is then not known.
    WHERE u.code NOT IN ('beyond_map', 'lost_behind') AND (n.ov.object_id IS NULL OR n.ov.object_id <> u.object_id OR n.ov.is_coming)
    GROUP BY ALL
)
SELECT
    e.drive_id, e.ego_id, e.t_ns, n.ov.object_id AS object_id, n.ov.da_m AS da_m, n.ov.speed_mps AS speed_mps, n.ov.is_coming AS on_its_way,
    -- Ground truth has no range: least() ignores this NULL, as intended here.
    greatest(0.0, least(e.corridor_m, e.range_m)) AS free_m,
    CASE WHEN e.range_m < e.corridor_m THEN 'sensor_range' WHEN e.map_ends THEN 'map_end' ELSE 'corridor_end' END AS free_reason,
    coalesce(h.n, 0) AS n_unplaced,
    CASE WHEN h.n > 0 THEN why('actor_unplaced', h.u) END AS unplaced_reason
FROM ego_step e
LEFT JOIN nearest_vehicle n USING (drive_id, ego_id, t_ns)
LEFT JOIN doubtful_object h USING (drive_id, ego_id, t_ns)
