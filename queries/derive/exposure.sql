SELECT
    e.drive_id, e.ego_id, max(e.travel_m) / 1000 AS km,
    sum(CASE WHEN st.dt_ns <= c.max_gap_ns THEN st.dt_ns ELSE 0 END)::DOUBLE / 3.6e12 AS hours,
    count(*) AS n_steps
FROM ego_state e
JOIN step st USING (drive_id, ego_id, t_ns)
JOIN clock c USING (drive_id, ego_id)
GROUP BY ALL
