-- Every stretch of steps with an indicator on. Hazard lights count for neither side. An unknown state ends a stretch.
-- lifetime: part
CREATE TABLE indicator_on (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the stretch with an indicator on, from 0, in time order
    side VARCHAR NOT NULL,            -- [side]
    t_on_ns BIGINT NOT NULL,          -- first step with the indicator on; at the step before, it was off or on the other side
    t_off_ns BIGINT NOT NULL,         -- last step with the indicator on
    at_log_start BOOLEAN NOT NULL     -- the state at the step before is not known, as at the log's start or after a hole: t_on_ns may not be its start
);

INSERT INTO indicator_on BY NAME
WITH indicator_step AS (
    SELECT st.drive_id, st.ego_id, st.k, st.seg, st.t_ns, s.indicator,
        lag({'indicator': s.indicator, 'seg': st.seg}) OVER w AS previous
    FROM step st
    JOIN state_dynamics s ON s.drive_id = st.drive_id AND s.actor_id = st.ego_id AND s.t_ns = st.t_ns
    WINDOW w AS (PARTITION BY st.drive_id, st.ego_id ORDER BY st.k)
),
lit_step AS (
    SELECT *, sum((previous.indicator IS DISTINCT FROM indicator OR previous.seg <> seg)::INTEGER)
        OVER (PARTITION BY drive_id, ego_id ORDER BY k ROWS UNBOUNDED PRECEDING) AS stretch_no
    FROM indicator_step
    WHERE indicator IN ('left', 'right')
)
SELECT
    drive_id, ego_id,
    (row_number() OVER (PARTITION BY drive_id, ego_id ORDER BY min(t_ns)) - 1)::INTEGER AS occurrence,
    any_value(indicator) AS side, min(t_ns) AS t_on_ns, max(t_ns) AS t_off_ns,
    coalesce(min({'k': k, 'unseen': previous.indicator IS NULL OR previous.seg <> seg}).unseen, true) AS at_log_start
FROM lit_step
GROUP BY drive_id, ego_id, stretch_no
