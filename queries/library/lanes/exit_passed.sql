-- Exits that the ego reaches, whether it takes them or not.
-- lifetime: part
CREATE TABLE exit_passed (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the exit, from 0, in time order
    lanelet_id VARCHAR NOT NULL,      -- the exit lanelet beside the ego's lane
    side VARCHAR NOT NULL,            -- [side] {position}
    t_near_ns BIGINT NOT NULL,        -- first step with the ego beside the exit lanelet, or on it {position}
    t_gore_ns BIGINT,                 -- first step past the end of the exit lanelet, where the choice is final; NULL: the log ends before {position}
    taken BOOLEAN                     -- the ego was in the exit lane at its end; NULL: end not reached {position}
);

INSERT INTO exit_passed BY NAME
WITH exit_step AS (
    SELECT e.drive_id, e.ego_id, e.t_ns, x.side, a.lanelet_id = x.lanelet_id AS on_exit, x.lanelet_id, st.k, st.seg
    FROM ego_state e
    JOIN step st USING (drive_id, ego_id, t_ns)
    JOIN data_log g ON g.drive_id = e.drive_id
    JOIN ego_lane a ON a.drive_id = e.drive_id AND a.ego_id = e.ego_id AND a.t_ns = e.t_ns
    JOIN _exit_lane x ON x.environment_id = g.environment_id AND (x.lanelet_id = a.lanelet_id)
    UNION ALL
    SELECT e.drive_id, e.ego_id, e.t_ns, x.side, false, x.lanelet_id, st.k, st.seg
    FROM ego_state e
    JOIN step st USING (drive_id, ego_id, t_ns)
    JOIN data_log g ON g.drive_id = e.drive_id
    JOIN _exit_lane x ON x.environment_id = g.environment_id AND x.from_id = e.lanelet_id
),
-- Consecutive steps beside or on exit lanelets of one side are a run: the lanelets follow each other and belong to the same exit. A hole
-- ends the run, because it is not known whether the ego took the exit in the hole.
run_step AS (
    SELECT *, k - dense_rank() OVER (PARTITION BY drive_id, ego_id, seg, side ORDER BY k) AS run FROM exit_step
),
exit_run AS (
    SELECT
        drive_id, ego_id, seg, side, run, min(t_ns) AS t_near_ns, max(k) AS k_last,
        max({'k': k, 'on_exit': on_exit, 'id': lanelet_id}) AS last
    FROM run_step
    GROUP BY ALL
)
SELECT
    w.drive_id, w.ego_id, (row_number() OVER (PARTITION BY w.drive_id, w.ego_id ORDER BY w.t_near_ns, w.side) - 1)::INTEGER AS occurrence,
    w.last.id AS lanelet_id, w.side, w.t_near_ns, st.t_ns AS t_gore_ns, CASE WHEN st.t_ns IS NOT NULL THEN w.last.on_exit END AS taken
FROM exit_run w
LEFT JOIN step st ON st.drive_id = w.drive_id AND st.ego_id = w.ego_id AND st.k = w.k_last + 1 AND st.seg = w.seg
