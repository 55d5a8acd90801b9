-- Way and time, all of it and with the automated driver; micrometres and nanoseconds are whole numbers, so no order of adding shows.
SELECT
    st.drive_id, st.ego_id, max(st.travel_m) / 1000 AS km,
    sum(dt_ns)::DOUBLE / 3.6e12 AS hours,
    coalesce(sum(way_um) FILTER (engaged), 0)::DOUBLE / 1e9 AS engaged_km,
    coalesce(sum(dt_ns) FILTER (engaged), 0)::DOUBLE / 3.6e12 AS engaged_hours,
    count(*) AS n_steps
FROM (
    SELECT
        s.drive_id, s.ego_id, s.travel_m, e.engaged, CASE WHEN s.dt_ns <= c.max_gap_ns THEN s.dt_ns ELSE 0 END AS dt_ns,
        round(1e6 * (s.travel_m - lag(s.travel_m, 1, 0.0::DOUBLE) OVER (PARTITION BY s.drive_id, s.ego_id ORDER BY s.t_ns)))::BIGINT AS way_um
    FROM step s
    JOIN clock c USING (drive_id, ego_id)
    LEFT JOIN ego_condition e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
) st
GROUP BY ALL
