-- The nearest vehicle behind the ego with the same direction, in the running lane and in the strip of one lane's width on either side,
-- within 200 m. It may stand, or be alongside (gap_m below 0). A row without an object means that there is no vehicle. There is no row if
-- the ego has no position on the corridor, or if an actor of unknown class, or without a position on the corridor, may be nearer.
-- lifetime: part
CREATE TABLE follower (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; no row: it is not known which vehicle is behind
    lane VARCHAR NOT NULL,            -- [lane_of_follower] the lane; one row per lane {position}
    object_id VARCHAR,                -- the nearest vehicle behind in this lane, within 200 m, that heads in the ego's direction; NULL: no vehicle
    gap_m DOUBLE,                     -- distance from its front to the ego's rear along the corridor; negative: alongside {position, heading, size}
    speed_mps DOUBLE,                 -- speed of the follower {velocity}
    closing_mps DOUBLE                -- speed of the follower minus that of the ego {velocity}
);

INSERT INTO follower BY NAME
WITH follower_candidate AS (
    SELECT
        p.drive_id, p.ego_id, p.t_ns, {'gap_m': e.rear_s_m - p.front_s_m, 'object_id': p.object_id, 'speed_mps': p.speed_mps} AS candidate,
        p.d_m, p.lat_half_m, p.half_width_m, is_vehicle(p.actor_class) AS vehicle
    FROM pair p
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    WHERE may_be_vehicle(p.actor_class) AND p.s_m <= e.s_m AND abs(p.heading_diff_rad) < pi() / 2
        AND e.rear_s_m - p.front_s_m <= follower_m()
),
lane_follower AS (
    SELECT drive_id, ego_id, t_ns, lane, min(candidate) FILTER (vehicle) AS follower_candidate, min(candidate.gap_m) FILTER (vehicle IS NULL) AS unclassified_gap_m
    FROM (
        SELECT *, 'own' AS lane FROM follower_candidate WHERE in_lane(d_m, lat_half_m, half_width_m)
        UNION ALL
        SELECT *, 'left' FROM follower_candidate WHERE in_lane(d_m - 2 * half_width_m, lat_half_m, half_width_m)
        UNION ALL
        SELECT *, 'right' FROM follower_candidate WHERE in_lane(d_m + 2 * half_width_m, lat_half_m, half_width_m)
    )
    GROUP BY ALL
),
hidden_vehicle AS (
    SELECT drive_id, ego_id, t_ns, min(least_m) FILTER (NOT late) AS least_m, min(least_m) AS least_with_late_m FROM hidden WHERE vehicle AND ahead IS DISTINCT FROM true GROUP BY ALL
)
SELECT
    e.drive_id, e.ego_id, e.t_ns, v.lane, f.follower_candidate.object_id AS object_id, f.follower_candidate.gap_m AS gap_m, f.follower_candidate.speed_mps AS speed_mps,
    f.follower_candidate.speed_mps - e.speed_mps AS closing_mps
FROM ego_state e
CROSS JOIN (VALUES ('own'), ('left'), ('right')) AS v(lane)
LEFT JOIN lane_follower f ON f.drive_id = e.drive_id AND f.ego_id = e.ego_id AND f.t_ns = e.t_ns AND f.lane = v.lane
LEFT JOIN hidden_vehicle h ON h.drive_id = e.drive_id AND h.ego_id = e.ego_id AND h.t_ns = e.t_ns
WHERE e.rear_s_m IS NOT NULL AND coalesce(least(CASE WHEN f.follower_candidate IS NULL THEN h.least_with_late_m ELSE h.least_m END, f.unclassified_gap_m) >= coalesce(f.follower_candidate.gap_m, follower_m()), true)
