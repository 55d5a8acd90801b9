-- Periods in which the ego is held up behind a slower vehicle, with an opposing lane in which it could overtake, and the best moment in
-- each period for each profile. Held up: within 5 s, or 10 m, of a lead that drives at less than 80 % of the limit. The ego would pass at
-- its own speed or, if that is faster, at 10 mph more than the lead, up to the limit.
-- lifetime: part
CREATE TABLE opportunity (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- number of the opportunity, from 0, in time order
    object_id VARCHAR NOT NULL,       -- the slower vehicle ahead, which holds up the ego
    profile VARCHAR NOT NULL,         -- [profile_name] see profile (not observed)
    t_start_ns BIGINT NOT NULL,       -- first step at which the ego is held up {position}
    t_end_ns BIGINT NOT NULL,         -- last step at which the ego is held up {position}
    t_best_ns BIGINT,                 -- the step with the most spare distance; NULL: never known {position}
    da_m DOUBLE,                      -- distance ahead at t_best_ns, or the free distance; NULL: unknown {position}
    sda_m DOUBLE,                     -- safe distance ahead at t_best_ns {position, heading, velocity, size}
    spare_s DOUBLE,                   -- time in which the spare distance (da_m minus sda_m) closes {position, heading, velocity, size}
    zone VARCHAR,                     -- [zone] at t_best_ns; NULL: unknown {position, heading, velocity, size}
    taken BOOLEAN NOT NULL            -- an overtake of this vehicle began in this time {position}
);

INSERT INTO opportunity BY NAME
WITH held_up_step AS (
    SELECT
        l.drive_id, l.ego_id, l.t_ns, st.k, st.seg, l.object_id, l.speed_mps AS v_vbp_mps, e.combination_m AS l_av_m, x.half_width_m * 2 AS lane_width_m,
        greatest(e.speed_mps, least(e.limit_mps, l.speed_mps + 4.4704)) AS v_av_mps, e.limit_mps
    FROM lead l
    JOIN ego_state e USING (drive_id, ego_id, t_ns)
    JOIN step st USING (drive_id, ego_id, t_ns)
    JOIN ego_corridor x ON x.drive_id = e.drive_id AND x.ego_id = e.ego_id AND x.chain_id = e.chain_id AND x.t_ns = e.t_ns
    WHERE l.object_id IS NOT NULL AND NOT coalesce(l.oncoming AND l.speed_mps > standing_mps(), false) AND x.over_against AND l.speed_mps < 0.8 * e.limit_mps
        AND l.gap_m < 5 * greatest(e.speed_mps, 2.0)
        AND CASE x.side WHEN 1 THEN x.left_out_m ELSE x.right_out_m END <= over_boundary_m()
),
numbered_step AS (
    SELECT *, k - row_number() OVER (PARTITION BY drive_id, ego_id, object_id, seg ORDER BY k) AS run_no FROM held_up_step
),
judged_step AS (
    SELECT
        h.*, p.profile, coalesce(v.da_m, o.free_m) AS da_m, o.n_unplaced, o.object_id IS NULL AS is_free, v.object_id AS ov_id,
        CASE WHEN h.v_av_mps > h.v_vbp_mps THEN safe_distance_ahead_m(
            h.lane_width_m, p.pull_out_angle_rad, p.cut_in_angle_rad, p.pull_out_headroom_m, p.cut_in_clearance_m, h.l_av_m, a.length_m, h.v_av_mps, h.v_vbp_mps,
            CASE WHEN o.object_id IS NULL THEN h.limit_mps ELSE v.speed_mps END
        ) END AS sda_m,
        h.v_av_mps + CASE WHEN o.object_id IS NULL THEN h.limit_mps ELSE v.speed_mps END AS closing_mps
    FROM numbered_step h
    JOIN actor a ON a.drive_id = h.drive_id AND a.actor_id = h.object_id
    CROSS JOIN (SELECT * FROM profile WHERE profile <> 'observed') p
    LEFT JOIN oncoming o ON o.drive_id = h.drive_id AND o.ego_id = h.ego_id AND o.t_ns = h.t_ns
    LEFT JOIN _oncoming_vehicle v ON v.drive_id = h.drive_id AND v.ego_id = h.ego_id AND v.t_ns = h.t_ns AND v.vehicle
),
-- Of several oncoming vehicles, the one that leaves the least distance counts, see overtake_sda.
worst_ov AS (
    SELECT *
    FROM judged_step
    QUALIFY row_number() OVER (PARTITION BY drive_id, ego_id, t_ns, profile ORDER BY da_m - sda_m NULLS FIRST, ov_id) = 1
),
spare_distance AS (
    SELECT *, CASE WHEN n_unplaced = 0 AND NOT (is_free AND da_m <= sda_m) THEN da_m - sda_m END AS spare_m FROM worst_ov
),
episode AS (
    SELECT
        drive_id, ego_id, object_id, profile, seg, run_no, min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns,
        min({'negative_spare_m': -spare_m, 't_ns': t_ns, 'da_m': da_m, 'sda_m': sda_m, 'closing_mps': closing_mps}) FILTER (spare_m IS NOT NULL) AS best
    FROM spare_distance
    GROUP BY ALL
)
SELECT
    e.drive_id, e.ego_id,
    (dense_rank() OVER (PARTITION BY e.drive_id, e.ego_id ORDER BY e.t_start_ns, e.object_id) - 1)::INTEGER AS occurrence,
    e.object_id, e.profile, e.t_start_ns, e.t_end_ns, e.best.t_ns AS t_best_ns, e.best.da_m AS da_m, e.best.sda_m AS sda_m,
    -e.best.negative_spare_m / nullif(e.best.closing_mps, 0) AS spare_s,
    overtake_zone(-e.best.negative_spare_m, -e.best.negative_spare_m / nullif(e.best.closing_mps, 0)) AS zone,
    EXISTS (
        FROM overtake o JOIN clock c USING (drive_id, ego_id)
        WHERE o.drive_id = e.drive_id AND o.ego_id = e.ego_id AND o.vbp_id = e.object_id
            AND o.t0_ns >= e.t_start_ns AND o.t0_ns <= e.t_end_ns + c.max_gap_ns
    ) AS taken
FROM episode e
