-- Distance and time of each ego, in total and with the automated driver. They are summed as whole micrometres and nanoseconds, so that the
-- order of summation does not change the result.
SELECT
    st.drive_id, st.ego_id, max(st.travel_m) / 1000 AS km,
    sum(dt_ns)::DOUBLE / 3.6e12 AS hours,
    coalesce(sum(distance_um) FILTER (engaged), 0)::DOUBLE / 1e9 AS engaged_km,
    coalesce(sum(dt_ns) FILTER (engaged), 0)::DOUBLE / 3.6e12 AS engaged_hours,
    count(*) AS n_steps
FROM (
    SELECT
        s.drive_id, s.ego_id, s.travel_m, ec.engaged, CASE WHEN s.dt_ns <= c.max_gap_ns THEN s.dt_ns ELSE 0 END AS dt_ns,
        round(1e6 * (s.travel_m - lag(s.travel_m, 1, 0.0::DOUBLE) OVER (PARTITION BY s.drive_id, s.ego_id ORDER BY s.t_ns)))::BIGINT AS distance_um
    FROM step s
    JOIN clock c USING (drive_id, ego_id)
    LEFT JOIN ego_condition ec ON ec.drive_id = s.drive_id AND ec.ego_id = s.ego_id AND ec.t_ns = s.t_ns
) st
GROUP BY ALL
