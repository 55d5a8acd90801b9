-- The sampling period of every ego of the drives, and its first and last sample.
-- lifetime: part
CREATE TABLE _ego_clock (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- an ego of the drive, also if it is judged in another part of the run
    period_ns BIGINT NOT NULL,        -- see clock
    max_gap_ns BIGINT NOT NULL,       -- see clock
    t_start_ns BIGINT NOT NULL,       -- the ego's first sample
    t_end_ns BIGINT NOT NULL          -- the ego's last sample
);

INSERT INTO _ego_clock BY NAME
SELECT
    drive_id, actor_id AS ego_id, period_ns,
    ceil(period_ns * max_gap_periods())::BIGINT AS max_gap_ns,
    t_start_ns, t_end_ns
FROM (
    SELECT
        s.drive_id, s.actor_id,
        -- A single sample has no period: 0.1 s is assumed, the usual step in this field.
        coalesce(quantile_disc(s.dt_ns, 0.5), 100_000_000)::BIGINT AS period_ns,
        min(s.t_ns) AS t_start_ns, max(s.t_ns) AS t_end_ns
    FROM (
        SELECT a.drive_id, a.actor_id, a.t_ns, a.t_ns - lag(a.t_ns) OVER (PARTITION BY a.drive_id, a.actor_id ORDER BY a.t_ns) AS dt_ns
        FROM actor_state a JOIN actor e ON e.drive_id = a.drive_id AND e.actor_id = a.actor_id AND e.is_ego
    ) s
    GROUP BY ALL
)
