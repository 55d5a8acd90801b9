-- Distance and time of each ego, in total and with the automated driver. They are summed as whole micrometres and nanoseconds, so that the
-- order of summation does not change the result. The time in which an ego is absent from its log does not count.
-- lifetime: run
CREATE TABLE exposure (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    km DOUBLE NOT NULL,               -- distance driven, in kilometres
    hours DOUBLE NOT NULL,            -- duration, without holes and without the time in which the ego is absent
    engaged_km DOUBLE NOT NULL,       -- distance driven up to the steps at which the automated driver drives (see ego_condition)
    engaged_hours DOUBLE NOT NULL,    -- duration up to these steps
    n_steps BIGINT NOT NULL           -- number of ego steps
);

INSERT INTO exposure BY NAME
WITH unplaced_state AS (
    SELECT a.drive_id, a.actor_id, a.t_ns
    FROM actor_state a
    SEMI JOIN quality q ON q.check_id = 'ego_absent' AND q.drive_id = a.drive_id AND q.actor_id = a.actor_id
    WHERE a.x_m IS NULL OR a.y_m IS NULL
)
SELECT
    st.drive_id, st.ego_id, max(st.travel_m) / 1000 AS km,
    sum(dt_ns)::DOUBLE / 3.6e12 AS hours,
    coalesce(sum(distance_um) FILTER (engaged), 0)::DOUBLE / 1e9 AS engaged_km,
    coalesce(sum(dt_ns) FILTER (engaged), 0)::DOUBLE / 3.6e12 AS engaged_hours,
    count(*) AS n_steps
FROM (
    SELECT
        s.drive_id, s.ego_id, s.travel_m, ec.engaged, CASE WHEN s.dt_ns <= c.max_gap_ns AND u.t_ns IS NULL THEN s.dt_ns ELSE 0 END AS dt_ns,
        round(1e6 * (s.travel_m - lag(s.travel_m, 1, 0.0::DOUBLE) OVER (PARTITION BY s.drive_id, s.ego_id ORDER BY s.t_ns)))::BIGINT AS distance_um
    FROM step s
    JOIN clock c USING (drive_id, ego_id)
    LEFT JOIN unplaced_state u ON u.drive_id = s.drive_id AND u.actor_id = s.ego_id AND u.t_ns = s.t_ns
    LEFT JOIN ego_condition ec ON ec.drive_id = s.drive_id AND ec.ego_id = s.ego_id AND ec.t_ns = s.t_ns
) st
GROUP BY ALL
