-- The stretches in which the log has the position of an actor. A hole or a lost time ends a stretch. Later parts of a drive add no rows.
-- lifetime: run
CREATE TABLE recorded (
    drive_id VARCHAR NOT NULL,        -- the drive
    actor_id VARCHAR NOT NULL,        -- an actor of the log
    t_from_ns BIGINT NOT NULL,        -- start of a stretch in which the actor's position is known, without a hole or lost time
    t_to_ns BIGINT NOT NULL           -- end of the stretch
);

INSERT INTO recorded BY NAME
WITH
    sample AS (
        SELECT
            a.drive_id, a.actor_id, a.t_ns, c.max_gap_ns, l.lost,
            lag(a.t_ns) OVER (PARTITION BY a.drive_id, a.actor_id ORDER BY a.t_ns) AS t_before_ns
        FROM actor_state a
        JOIN (SELECT drive_id, max(max_gap_ns) AS max_gap_ns FROM _ego_clock GROUP BY drive_id) c ON c.drive_id = a.drive_id
        LEFT JOIN (SELECT drive_id, list({'t_from_ns': t_from_ns, 't_to_ns': t_to_ns}) AS lost FROM lost_time GROUP BY drive_id) l
            ON l.drive_id = a.drive_id
        ANTI JOIN recorded r ON r.drive_id = a.drive_id
        WHERE a.x_m IS NOT NULL AND a.y_m IS NOT NULL
    ),
    numbered AS (
        SELECT *, sum(CASE WHEN t_ns - t_before_ns > max_gap_ns OR len(list_filter(lost, lambda t: t.t_from_ns < t_ns AND t.t_to_ns > t_before_ns)) > 0
            THEN 1 ELSE 0 END) OVER (PARTITION BY drive_id, actor_id ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS stretch
        FROM sample
    )
SELECT drive_id, actor_id, min(t_ns) AS t_from_ns, max(t_ns) AS t_to_ns
FROM numbered
GROUP BY drive_id, actor_id, stretch
