-- Steps at which the ego crosses into an exit lane, and the last exit sign before this step.
-- lifetime: part
CREATE TABLE exit_taken (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the exit, from 0, in time order
    t_ns BIGINT NOT NULL,             -- first step with a corner more than 0.05 m over the exit lane's boundary
    side VARCHAR NOT NULL,            -- [side] {position}
    lanelet_id VARCHAR NOT NULL,      -- the exit lanelet
    t_sign_ns BIGINT,                 -- first step at or past the last exit sign before the exit; NULL: passed before the log began {position}
    sign_id VARCHAR                   -- that sign; NULL: the map has none on the ego's path
);

INSERT INTO exit_taken BY NAME
WITH boundary_crossing AS (
    SELECT
        x.drive_id, x.ego_id, x.chain_id, x.t0_ns, x.side, g.environment_id, e.front_s_m,
        min({'t_ns': a.t_ns, 'lanelet_id': a.lanelet_id}).lanelet_id AS to_id
    FROM excursion x
    JOIN ego_state e ON e.drive_id = x.drive_id AND e.ego_id = x.ego_id AND e.t_ns = x.t0_ns AND e.chain_id = x.chain_id
    JOIN data_log g ON g.drive_id = x.drive_id
    JOIN ego_lane a ON a.drive_id = x.drive_id AND a.ego_id = x.ego_id AND a.t_ns >= x.t0_ns AND a.t_ns <= x.t_end_ns
        AND a.lanelet_id <> e.lanelet_id
    WHERE x.centre_over AND x.begin_seen
    GROUP BY ALL
),
exit_entry AS (
    SELECT c.*, CASE c.side WHEN 1 THEN 'left' ELSE 'right' END AS side_name
    FROM boundary_crossing c
    JOIN _exit_lane l ON l.environment_id = c.environment_id AND l.lanelet_id = c.to_id
    JOIN ego_state e ON e.drive_id = c.drive_id AND e.ego_id = c.ego_id AND e.t_ns = c.t0_ns
    -- An ego that is already on an exit lane does not cross into one.
    ANTI JOIN _exit_lane f ON f.environment_id = c.environment_id AND f.lanelet_id = e.lanelet_id
),
last_sign AS (
    SELECT t.drive_id, t.ego_id, t.t0_ns, max({'s_m': c.s_start_m + s.lane_s_m, 'id': s.signal_id, 'chain_id': c.chain_id}) AS last
    FROM exit_entry t
    JOIN chain c ON c.drive_id = t.drive_id AND c.ego_id = t.ego_id AND c.chain_id = t.chain_id
    JOIN traffic_signal s ON s.environment_id = t.environment_id AND s.lanelet_id = c.lanelet_id AND s.kind = 'exit'
    WHERE c.s_start_m + s.lane_s_m <= t.front_s_m
    GROUP BY ALL
),
sign_passage AS (
    SELECT s.drive_id, s.ego_id, s.t0_ns, s.last.id AS sign_id, min(e.t_ns) AS t_sign_ns, min(c.t_start_ns) AS t_log_ns
    FROM last_sign s
    JOIN clock c USING (drive_id, ego_id)
    JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.chain_id = s.last.chain_id AND e.front_s_m >= s.last.s_m
    GROUP BY ALL
)
SELECT
    t.drive_id, t.ego_id, (row_number() OVER (PARTITION BY t.drive_id, t.ego_id ORDER BY t.t0_ns) - 1)::INTEGER AS occurrence,
    t.t0_ns AS t_ns, t.side_name AS side, t.to_id AS lanelet_id,
    CASE WHEN r.t_sign_ns > r.t_log_ns THEN r.t_sign_ns END AS t_sign_ns, r.sign_id
FROM exit_entry t
LEFT JOIN sign_passage r USING (drive_id, ego_id, t0_ns)
