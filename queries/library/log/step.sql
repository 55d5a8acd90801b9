-- The steps at which an ego is judged: its samples, numbered, with the time to the next one and the stretches between holes.
-- lifetime: part
CREATE TABLE step (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- time of the step: a sample of the ego
    k INTEGER NOT NULL,               -- number of the step, from 0, in time order
    dt_ns BIGINT,                     -- time since the previous step; NULL: the first step
    seg INTEGER NOT NULL,             -- number of the segment, from 0: it increases after each hole (a gap longer than max_gap_ns) and each lost time
    travel_m DOUBLE NOT NULL          -- distance driven since the first step, summed over the known positions
);

INSERT INTO step BY NAME
SELECT
    drive_id, ego_id, t_ns,
    (row_number() OVER w - 1)::INTEGER AS k,
    dt_ns,
    (sum(CASE WHEN dt_ns > max_gap_ns OR is_after_loss THEN 1 ELSE 0 END) OVER (w ROWS UNBOUNDED PRECEDING))::INTEGER AS seg,
    from_picometres(sum(to_picometres(coalesce(sqrt((x_m - x_before_m) ** 2 + (y_m - y_before_m) ** 2), 0.0))) OVER (w ROWS UNBOUNDED PRECEDING)) AS travel_m
FROM (
    SELECT
        c.drive_id, c.ego_id, a.t_ns, c.max_gap_ns, a.x_m, a.y_m,
        a.t_ns - lag(a.t_ns) OVER v AS dt_ns, lag(a.x_m) OVER v AS x_before_m, lag(a.y_m) OVER v AS y_before_m,
        -- Steps of the ego within one lost stretch form a segment of their own.
        coalesce(len(list_filter(l.lost, lambda t: t.t_from_ns < a.t_ns AND t.t_to_ns > lag(a.t_ns) OVER v
            AND NOT (t.t_from_ns < lag(a.t_ns) OVER v AND t.t_to_ns > a.t_ns))) > 0, false) AS is_after_loss
    FROM clock c JOIN actor_state a ON a.drive_id = c.drive_id AND a.actor_id = c.ego_id
    LEFT JOIN (SELECT drive_id, list({'t_from_ns': t_from_ns, 't_to_ns': t_to_ns}) AS lost FROM lost_time GROUP BY drive_id) l ON l.drive_id = c.drive_id
    WINDOW v AS (PARTITION BY c.drive_id, c.ego_id ORDER BY a.t_ns)
)
WINDOW w AS (PARTITION BY drive_id, ego_id ORDER BY t_ns)
