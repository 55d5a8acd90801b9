-- The stretches of a drive in which its log has lost data; both ends are excluded. A stretch that begins within another ends with it or
-- later. The table quality also contains the drives of earlier batches.
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
