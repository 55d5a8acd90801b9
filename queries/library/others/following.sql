-- The vehicle that the ego follows at each step: the nearest of the vehicles ahead, without oncoming vehicles and without those that the
-- ego overtakes or passes inside its lane. A vehicle beside the ego is not ahead.
-- lifetime: part
CREATE TABLE following (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    t_ns BIGINT NOT NULL,             -- the step; every step has a row
    object_id VARCHAR,                -- the nearest vehicle ahead that the ego follows, else the lead; NULL: none, or not known
    follows BOOLEAN,                  -- the ego is behind this vehicle and goes its way: in its lane, outside an overtake or lane change (of up to 10 s astride the line), and it is neither oncoming nor beside. A standing vehicle must be in the way of the ego's box at this step and when the ego arrives. A moving one must be in its way, or have its centre in the lane and be more than 3 s from being passed; NULL: not known {position}
    gap_m DOUBLE,                     -- see lead {position, heading, size}
    ego_speed_mps DOUBLE,             -- speed of the ego {velocity}
    speed_mps DOUBLE,                 -- speed of the vehicle {velocity}
    joined_ns BIGINT,                 -- see vehicle_ahead: the time since which the gap is new; NULL: the vehicle was ahead before, or its arrival was not seen {position}
    let_in_ns BIGINT,                 -- see vehicle_ahead: the time since which the gap is new, if the ego did not change lanes {position}
    free_m DOUBLE                     -- see vehicle_ahead: if it is not known which vehicle is ahead, none is nearer than this {position, heading, size}
);

INSERT INTO following BY NAME
WITH manoeuvre_step AS (
    SELECT drive_id, ego_id, t_ns, bool_or(is_sure) AS is_sure
    FROM (
        -- An ego that is astride of the line for longer than a lane change takes, and passes no actor, occupies both lanes.
        SELECT *, t_astride_ns IS NULL OR t_ns - t_astride_ns <= longest_change_ns() OR passing_id IS NOT NULL OR overtaking AS is_sure
        FROM line_step
        WHERE manoeuvre
    )
    WHERE is_sure IS DISTINCT FROM false
    GROUP BY ALL
),
candidate AS (
    SELECT
        s.drive_id, s.ego_id, s.t_ns, v.object_id, v.gap_m, v.ego_speed_mps, v.speed_mps, v.joined_ns, v.let_in_ns, v.nearest, v.free_m,
        CASE
            WHEN v.t_ns IS NULL OR NOT v.known THEN NULL
            WHEN v.object_id IS NULL OR m.is_sure THEN false
            ELSE CASE WHEN m.t_ns IS NULL THEN true END
                -- A motorcycle or bicycle on the line may ride between the lanes, past this vehicle.
                AND CASE WHEN NOT may_ride_on_line(a.actor_class, e.d_m, e.lat_half_m, p.d_m, p.lat_half_m, p.half_width_m) THEN true END
                AND v.in_lane AND v.gap_m >= 0 AND NOT v.oncoming AND (
                -- A vehicle that stands must be in the ego's way, both now and when the ego gets there. Otherwise the ego steers round it,
                -- or passes it at the edge of the lane.
                v.across_m < 0 AND (v.speed_mps > standing_mps() OR v.passes_by IS DISTINCT FROM true AND on_course(
                    v.gap_m, ttc_s(v.gap_m, v.ego_speed_mps), e.d_m, e.lat_half_m, e.speed_mps * sin(e.heading_diff_rad), p.d_m, p.lat_half_m, 0.0
                ))
                -- A vehicle that moves beside the ego's path must have its centre in the lane, and must not be about to be passed.
                OR v.speed_mps > standing_mps() AND abs(p.d_m) <= p.half_width_m AND v.gap_m >= drift_s() * (v.ego_speed_mps - v.speed_mps)
            )
        END AS follows
    FROM step s
    LEFT JOIN vehicle_ahead v ON v.drive_id = s.drive_id AND v.ego_id = s.ego_id AND v.t_ns = s.t_ns
    LEFT JOIN manoeuvre_step m ON m.drive_id = s.drive_id AND m.ego_id = s.ego_id AND m.t_ns = s.t_ns
    LEFT JOIN ego_state e ON e.drive_id = s.drive_id AND e.ego_id = s.ego_id AND e.t_ns = s.t_ns
    LEFT JOIN pair p ON p.drive_id = v.drive_id AND p.ego_id = v.ego_id AND p.t_ns = v.t_ns AND p.object_id = v.object_id
    LEFT JOIN actor a ON a.drive_id = s.drive_id AND a.actor_id = s.ego_id
)
SELECT drive_id, ego_id, t_ns, object_id, gap_m, ego_speed_mps, speed_mps, joined_ns, let_in_ns, follows, free_m
FROM (
    SELECT *, row_number() OVER (
        PARTITION BY drive_id, ego_id, t_ns
        -- No vehicle is nearer than the lead. Another vehicle counts as followed only if it is known for every vehicle whether the ego
        -- follows it.
        ORDER BY CASE WHEN follows AND nearest THEN 0 WHEN follows IS NULL THEN 1 WHEN follows THEN 2 ELSE 3 END, nearest DESC, gap_m, object_id
    ) AS rank_no
    FROM candidate
)
WHERE rank_no = 1
