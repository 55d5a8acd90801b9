-- The stretches of a drive in which its log has lost data; both ends are excluded. A stretch that begins within another ends with it or
-- later. The table quality also contains the drives of earlier batches.
-- lifetime: part
CREATE TABLE lost_time (
    drive_id VARCHAR NOT NULL,        -- the drive
    t_from_ns BIGINT NOT NULL,        -- last time before the loss: the log lacks records between this time and t_to_ns
    t_to_ns BIGINT NOT NULL           -- first time after the loss; the two are far apart if the beginning or end of the log is lost
);

INSERT INTO lost_time BY NAME
SELECT drive_id, t_from_ns, max(t_to_ns) OVER (PARTITION BY drive_id ORDER BY t_from_ns ROWS UNBOUNDED PRECEDING) AS t_to_ns
FROM (
    SELECT
        q.drive_id, coalesce(q.t_first_ns, -9_000_000_000_000_000_000) AS t_from_ns,
        max(coalesce(q.t_last_ns, 9_000_000_000_000_000_000)) AS t_to_ns
    FROM quality q
    SEMI JOIN actor a ON a.drive_id = q.drive_id
    WHERE q.check_id = 'lost_time'
    GROUP BY ALL
)
