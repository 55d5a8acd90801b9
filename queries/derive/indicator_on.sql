-- Every stretch with an indicator on. Hazard lights are neither side; an unknown state ends a stretch.
WITH state AS (
    SELECT st.drive_id, st.ego_id, st.k, st.seg, st.t_ns, s.indicator,
        lag({'indicator': s.indicator, 'seg': st.seg}) OVER w AS before
    FROM step st
    JOIN state_dynamics s ON s.drive_id = st.drive_id AND s.actor_id = st.ego_id AND s.t_ns = st.t_ns
    WINDOW w AS (PARTITION BY st.drive_id, st.ego_id ORDER BY st.k)
),
lit AS (
    SELECT *, sum((before.indicator IS DISTINCT FROM indicator OR before.seg <> seg)::INTEGER)
        OVER (PARTITION BY drive_id, ego_id ORDER BY k ROWS UNBOUNDED PRECEDING) AS n
    FROM state
    WHERE indicator IN ('left', 'right')
)
SELECT
    drive_id, ego_id,
    (row_number() OVER (PARTITION BY drive_id, ego_id ORDER BY min(t_ns)) - 1)::INTEGER AS occurrence,
    any_value(indicator) AS side, min(t_ns) AS t_on_ns, max(t_ns) AS t_off_ns,
    coalesce(min({'k': k, 'unseen': before.indicator IS NULL OR before.seg <> seg}).unseen, true) AS at_log_start
FROM lit
GROUP BY drive_id, ego_id, n
