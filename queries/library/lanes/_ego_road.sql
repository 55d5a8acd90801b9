-- Stations along the road, common to all lanes between which the ego changes. Where it crosses from one lane into the next, the two chains
-- have the same station. A chain that the ego entered without crossing a line begins a new road.
-- lifetime: part
CREATE TABLE _ego_road (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    chain_id INTEGER NOT NULL,        -- a running chain, see chain
    road INTEGER NOT NULL,            -- number of the road, from 1, in time order; chains between which the ego changed lanes are one road {position}
    offset_m DOUBLE NOT NULL          -- difference that is added to a station of the chain to get the station along the road {position}
);

INSERT INTO _ego_road BY NAME
WITH chain_start AS (
    SELECT drive_id, ego_id, chain_id, min(t_ns) AS t_ns FROM ego_state WHERE chain_id IS NOT NULL GROUP BY ALL
),
chain_change AS (
    SELECT l.drive_id, l.ego_id, l.to_chain_id AS chain_id, to_picometres(a.s_m) - to_picometres(b.s_m) AS shift_pm
    FROM lane_crossing l
    JOIN ego_corridor a ON a.drive_id = l.drive_id AND a.ego_id = l.ego_id AND a.chain_id = l.from_chain_id AND a.t_ns = l.t_ns
    JOIN ego_corridor b ON b.drive_id = l.drive_id AND b.ego_id = l.ego_id AND b.chain_id = l.to_chain_id AND b.t_ns = l.t_ns
)
SELECT
    drive_id, ego_id, chain_id, sum((c.shift_pm IS NULL)::INTEGER) OVER w AS road, from_picometres(sum(coalesce(c.shift_pm, 0)) OVER w) AS offset_m
FROM chain_start b
LEFT JOIN chain_change c USING (drive_id, ego_id, chain_id)
WINDOW w AS (PARTITION BY drive_id, ego_id ORDER BY b.t_ns ROWS UNBOUNDED PRECEDING)
