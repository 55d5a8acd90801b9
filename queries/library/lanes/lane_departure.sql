-- Boundaries that the ego crosses in a manoeuvre, out of its running lane and back into it. In a manoeuvre, the ego's centre crosses the
-- boundary, too, or the ego overtakes astride of the line.
-- lifetime: part
CREATE TABLE lane_departure (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the departure, from 0, in time order
    t_ns BIGINT NOT NULL,             -- first step with a corner more than 0.05 m over a boundary, in a manoeuvre: the centre crossed too, or a vehicle was overtaken; for the way back, see t_return_ns and t_back_ns of excursion
    begin_seen BOOLEAN NOT NULL,      -- see excursion {position}
    side VARCHAR NOT NULL,            -- [side] the side of the boundary {position}
    back BOOLEAN NOT NULL             -- the departure is the way back of an excursion: the ego crosses the boundary towards the running lane {position}
);

INSERT INTO lane_departure BY NAME
WITH manoeuvre_excursion AS (
    SELECT x.*
    FROM excursion x
    JOIN ego_state e ON e.drive_id = x.drive_id AND e.ego_id = x.ego_id AND e.t_ns = x.t0_ns AND e.chain_id = x.chain_id
    WHERE x.centre_over OR EXISTS (FROM overtake o WHERE o.drive_id = x.drive_id AND o.ego_id = x.ego_id AND o.chain_id = x.chain_id AND o.side = x.side AND o.t0_ns >= x.t0_ns AND o.t0_ns <= x.t_end_ns AND o.passed)
),
boundary_crossing AS (
    SELECT drive_id, ego_id, t0_ns AS t_ns, begin_seen, side, false AS back FROM manoeuvre_excursion
    UNION ALL
    SELECT drive_id, ego_id, coalesce(t_return_ns, t_back_ns), true, -side, true FROM manoeuvre_excursion WHERE coalesce(t_return_ns, t_back_ns) IS NOT NULL
)
SELECT
    drive_id, ego_id, (row_number() OVER (PARTITION BY drive_id, ego_id ORDER BY t_ns, side, back) - 1)::INTEGER AS occurrence,
    t_ns, begin_seen, CASE side WHEN 1 THEN 'left' ELSE 'right' END AS side, back
FROM boundary_crossing
