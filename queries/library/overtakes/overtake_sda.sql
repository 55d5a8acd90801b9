-- Distance ahead and safe distance ahead for every profile. The profile `observed` uses the angles and gaps of this overtake, and the
-- driven distance. If the ego passes several vehicles in one excursion, each counts with the length of the whole row up to its front. The
-- formula uses one speed for the whole manoeuvre: the speed at t0 or, for the profile `observed` of a completed overtake, the mean speed.
--
-- An ego that accelerated to overtake needed less distance than its speed at t0 gives. It is not known which of the two speeds it planned
-- with. If the log ends before the ego is back, the greatest possible mean speed until its return replaces the mean speed. This speed is
-- limited by the ego's highest speed or the speed limit (without a limit in the map, that of the fastest roads). After a collision, the ego
-- cannot accelerate.
-- lifetime: part
CREATE TABLE overtake_sda (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- see overtake
    profile VARCHAR NOT NULL,         -- [profile_name] see profile; selected or not
    t0_ns BIGINT NOT NULL,            -- see overtake {position}
    ov_id VARCHAR,                    -- of the oncoming vehicles at t0 (see _oncoming_vehicle), the one that leaves the least spare distance; NULL: none {position}
    da_m DOUBLE,                      -- distance ahead to the OV; NULL: unknown; or more than sda_m, while another OV cannot be excluded; or too little at the ego's speed at t0, but enough at its mean speed (or at the speed reached at the end of the log) {position}
    at_least BOOLEAN NOT NULL,        -- da_m is only a lower bound: no OV is seen within this free distance {position}
    nobody BOOLEAN NOT NULL,          -- the positions of all vehicles are known, and there is no OV within da_m {position}
    sda_m DOUBLE,                     -- safe distance ahead, at the ego's speed at t0. Profile observed: at the ego's mean speed, if completed; at least the distance that ego and OV covered during the overtake plus the OV's stopping distance, if da_m is no more than that; NULL: undefined {position, heading, velocity, size}
    spare_m DOUBLE,                   -- spare distance: the distance ahead minus sda_m; not NULL where da_m is NULL only because of a doubt {position, heading, velocity, size}
    spare_s DOUBLE,                   -- time in which spare_m closes at the speed v_AV + v_OV {position, heading, velocity, size}
    zone VARCHAR,                     -- [zone] NULL: unknown {position, heading, velocity, size}
    reason VARCHAR,                   -- why sda_m or da_m is NULL, or a remark on them, as JSON from the macro why
    pull_out_m DOUBLE,                -- part of sda_m: the distance that the ego drives to pull out; NULL: sda_m is the distance covered (covered_m), or undefined {position, heading, velocity, size}
    passing_m DOUBLE,                 -- part of sda_m: the distance that the ego drives beside the VBP; NULL: as pull_out_m {position, heading, velocity, size}
    cut_in_m DOUBLE,                  -- part of sda_m: the distance that the ego drives to cut in; NULL: as pull_out_m {position, heading, velocity, size}
    oncoming_m DOUBLE,                -- part of sda_m: the distance that the OV drives during the overtake; NULL: as pull_out_m {position, heading, velocity, size}
    covered_m DOUBLE,                 -- part of sda_m: the distance that the ego and the OV covered during the overtake, until both stand; NULL: sda_m is from the formula, or undefined {position, heading, velocity, size}
    stopping_m DOUBLE                 -- part of sda_m: the OV's stopping distance; NULL: undefined {position, heading, velocity, size}
);

INSERT INTO overtake_sda BY NAME
WITH ov_candidate AS (
    SELECT o.drive_id, o.ego_id, o.occurrence, v.object_id AS ov_id, v.da_m, v.speed_mps AS v_ov_mps
    FROM overtake o
    JOIN _oncoming_vehicle v ON v.drive_id = o.drive_id AND v.ego_id = o.ego_id AND v.t_ns = o.t0_ns AND v.vehicle
    UNION ALL
    SELECT drive_id, ego_id, occurrence, NULL, da_m, v_ov_mps FROM overtake WHERE ov_id IS NULL
),
-- The ego and the OV at each step of the overtake. A standing vehicle adds no distance, however long it is recorded.
step_with_ov AS (
    SELECT
        v.drive_id, v.ego_id, v.occurrence, v.ov_id, v.da_m, e.t_ns, coalesce(n.da_m, p.rear_s_m - e.front_s_m) AS now_m, now_m IS NOT NULL AS is_seen,
        (e.speed_mps <= standing_mps()) IS NOT true AS ego_moves, (p.speed_mps <= standing_mps()) IS NOT true AS ov_moves
    FROM overtake o
    JOIN ov_candidate v USING (drive_id, ego_id, occurrence)
    JOIN ego_state e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.t_ns >= o.t0_ns AND e.t_ns <= o.t_end_ns
    LEFT JOIN pair p ON p.drive_id = e.drive_id AND p.ego_id = e.ego_id AND p.t_ns = e.t_ns AND p.object_id = v.ov_id
    -- A vehicle from another lane still has to drive round the corner. A vehicle that the ego has met is only in pair.
    LEFT JOIN _oncoming_vehicle n ON n.drive_id = e.drive_id AND n.ego_id = e.ego_id AND n.t_ns = e.t_ns AND n.object_id = v.ov_id
),
-- The distance by which the two have approached each other until both stand, the last step at which this is seen, and the last step at
-- which the ego moves.
closed_distance AS (
    SELECT s.drive_id, s.ego_id, s.occurrence, s.ov_id, s.da_m - min(s.now_m) AS closed_m, max(s.t_ns) FILTER (s.is_seen) AS t_seen_ns, any_value(m.t_ego_ns) AS t_ego_ns
    FROM step_with_ov s
    JOIN (
        SELECT drive_id, ego_id, occurrence, ov_id, max(t_ns) FILTER (ego_moves) AS t_ego_ns, max(t_ns) FILTER (ego_moves OR is_seen AND ov_moves) AS t_both_ns FROM step_with_ov GROUP BY ALL
    ) m ON m.drive_id = s.drive_id AND m.ego_id = s.ego_id AND m.occurrence = s.occurrence AND m.ov_id IS NOT DISTINCT FROM s.ov_id
    WHERE s.t_ns <= m.t_both_ns
    GROUP BY s.drive_id, s.ego_id, s.occurrence, s.ov_id, s.da_m
),
collision AS (
    SELECT drive_id, ego_id, t_ns FROM impact
    UNION
    SELECT drive_id, ego_id, t_ns FROM pair WHERE clearance_m <= 0 AND NOT clearance_is_bound
),
highest_speed AS (
    SELECT
        o.drive_id, o.ego_id, o.occurrence,
        greatest(max(e.speed_mps), CASE WHEN count(c.t_ns) = 0 THEN max(coalesce(e.limit_mps, fastest_mps())) END) AS v_most_mps
    FROM overtake o
    JOIN ego_state e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.t_ns >= o.t0_ns AND e.t_ns <= o.t_end_ns
    LEFT JOIN collision c ON c.drive_id = e.drive_id AND c.ego_id = e.ego_id AND c.t_ns = e.t_ns
    WHERE o.status = 'truncated'
    GROUP BY ALL
),
-- The distance that the ego and the OV covered during the overtake, plus the OV's stopping distance. While the OV is not seen, its speed at
-- t0 counts. If the ego, the log or a collision ended the overtake early, the whole overtake would have needed more.
driven_distance AS (
    SELECT
        o.drive_id, o.ego_id, o.occurrence, v.ov_id, v.da_m, v.v_ov_mps, m.v_most_mps, h.t_ns < o.t_end_ns AS stands, (h.t_ns - o.t0_ns) / 1e9 AS out_s,
        (o.t_end_ns - o.t0_ns) / 1e9 AS gone_s, f.travel_m - e.travel_m AS gone_m, f.speed_mps AS v_end_mps, CASE WHEN o.status = 'completed' THEN gone_m / nullif(gone_s, 0) END AS v_mean_mps,
        coalesce(c.closed_m, 0.0) + greatest(0.0, b.front_s_m - a.front_s_m) + v.v_ov_mps * greatest(0, h.t_ns - h.t_seen_ns) / 1e9 + stopping_distance_m(v.v_ov_mps) AS driven_m
    FROM overtake o
    JOIN ov_candidate v USING (drive_id, ego_id, occurrence)
    LEFT JOIN closed_distance c ON c.drive_id = o.drive_id AND c.ego_id = o.ego_id AND c.occurrence = o.occurrence AND c.ov_id IS NOT DISTINCT FROM v.ov_id
    CROSS JOIN LATERAL (SELECT coalesce(c.t_ego_ns, o.t0_ns) AS t_ns, coalesce(c.t_seen_ns, o.t0_ns) AS t_seen_ns) h
    LEFT JOIN ego_corridor a ON a.drive_id = o.drive_id AND a.ego_id = o.ego_id AND a.chain_id = o.chain_id AND a.t_ns = h.t_seen_ns
    LEFT JOIN ego_corridor b ON b.drive_id = o.drive_id AND b.ego_id = o.ego_id AND b.chain_id = o.chain_id AND b.t_ns = h.t_ns
    LEFT JOIN ego_state e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.t_ns = o.t0_ns
    LEFT JOIN ego_state f ON f.drive_id = o.drive_id AND f.ego_id = o.ego_id AND f.t_ns = o.t_end_ns
    LEFT JOIN highest_speed m ON m.drive_id = o.drive_id AND m.ego_id = o.ego_id AND m.occurrence = o.occurrence
),
formula_input AS (
    SELECT
        o.* REPLACE (
            CASE WHEN p.profile = 'observed' THEN coalesce(d.v_mean_mps, o.v_av_mps) ELSE o.v_av_mps END AS v_av_mps,
            d.ov_id AS ov_id, d.da_m AS da_m, d.v_ov_mps AS v_ov_mps
        ),
        o.ov_id AS nearest_id, d.out_s, d.stands, p.profile, d.v_mean_mps, d.v_most_mps, d.gone_s, d.gone_m, d.v_end_mps,
        CASE WHEN p.profile = 'observed' THEN d.driven_m END AS driven_m,
        CASE WHEN p.profile <> 'observed' THEN p.pull_out_angle_rad WHEN o.status = 'completed' THEN o.pull_out_angle_rad END AS beta_rad,
        CASE p.profile WHEN 'observed' THEN o.cut_in_angle_rad ELSE p.cut_in_angle_rad END AS theta_rad,
        CASE p.profile WHEN 'observed' THEN o.vbp_gap_m - o.span_m + o.l_vbp_m ELSE p.pull_out_headroom_m END AS headroom_m,
        CASE p.profile WHEN 'observed' THEN o.t2_gap_m ELSE p.cut_in_clearance_m END AS clearance_m
    FROM overtake o
    JOIN driven_distance d USING (drive_id, ego_id, occurrence)
    CROSS JOIN profile p
),
-- The faster the ego overtakes, the sooner it is back, and the less it can have accelerated until then. Of 64 speeds up to the highest, the
-- greatest possible mean speed is taken.
later_speed AS (
    SELECT
        *,
        CASE WHEN v_most_mps IS NULL THEN v_mean_mps ELSE list_max(list_filter(
            [v_av_mps + (v_most_mps - v_av_mps) * k / 64 for k in range(1, 65)],
            lambda v: v > v_vbp_mps AND v <= coalesce(most_mean_mps(overtaking_time_s(lane_width_m, beta_rad, theta_rad, headroom_m, clearance_m, l_av_m, span_m, v, v_vbp_mps), gone_s, gone_m, v_end_mps, v_most_mps), v_most_mps)
        )) END AS v_later_mps
    FROM formula_input
),
planned_distance AS (
    SELECT
        *, begin_seen AND vbp_placed AND opposing IS NOT NULL AS is_known,
        CASE WHEN beta_rad > 0 AND theta_rad > 0 AND v_av_mps > v_vbp_mps THEN
            safe_distance_ahead_m(lane_width_m, beta_rad, theta_rad, headroom_m, clearance_m, l_av_m, span_m, v_av_mps, v_vbp_mps, v_ov_mps)
        END AS planned_m,
        CASE WHEN beta_rad > 0 AND theta_rad > 0 AND v_later_mps > v_av_mps AND v_later_mps > v_vbp_mps THEN
            safe_distance_ahead_m(lane_width_m, beta_rad, theta_rad, headroom_m, clearance_m, l_av_m, span_m, v_later_mps, v_vbp_mps, v_ov_mps)
        END AS sped_up_m
    FROM later_speed
),
required_distance AS (
    -- The driven distance counts only if it is at least DA: then it shows that DA was too small. If DA is larger, the overtake had enough,
    -- and only the formula counts. For an overtake that was not completed, the distance that would have been enough is not known.
    SELECT
        *, CASE WHEN da_m <= driven_m THEN greatest(planned_m, driven_m) ELSE planned_m END AS sda_m,
        coalesce(da_m <= driven_m AND (planned_m IS NULL OR driven_m > planned_m), false) AS is_driven, coalesce(da_m <= sda_m AND da_m > sped_up_m, false) AS has_sped_up
    FROM planned_distance
),
-- Of several oncoming vehicles, one that leaves too little distance comes first, then one for which this is not known, then the one that
-- leaves the least distance.
worst_ov AS (
    SELECT *
    FROM required_distance
    QUALIFY row_number() OVER (
        PARTITION BY drive_id, ego_id, occurrence, profile
        ORDER BY CASE WHEN da_m <= sda_m AND NOT has_sped_up THEN 0 WHEN da_m > sda_m THEN 2 ELSE 1 END, da_m - sda_m, ov_id
    ) = 1
),
passing AS (
    SELECT *, passing_time_s(lane_width_m, beta_rad, headroom_m, clearance_m, l_av_m, span_m, v_av_mps, v_vbp_mps) AS passing_s FROM worst_ov
)
SELECT
    drive_id, ego_id, occurrence, profile, t0_ns, ov_id,
    CASE WHEN is_known AND NOT has_sped_up AND (n_unplaced = 0 OR da_m <= sda_m) THEN da_m END AS da_m,
    ov_id IS NULL AS at_least,
    coalesce(ov_id IS NULL AND n_unplaced = 0, false) AS nobody,
    sda_m, da_m - sda_m AS spare_m, (da_m - sda_m) / nullif(v_av_mps + v_ov_mps, 0) AS spare_s,
    -- Without an OV, a zone is given only if all vehicles have positions and the free distance is greater than SDA. With an OV and a
    -- vehicle without a position, only zone A is certain: that vehicle may leave even less distance.
    CASE WHEN is_known AND NOT has_sped_up AND CASE WHEN ov_id IS NULL THEN n_unplaced = 0 AND da_m > sda_m ELSE n_unplaced = 0 OR da_m <= sda_m END THEN overtake_zone(da_m - sda_m, (da_m - sda_m) / nullif(v_av_mps + v_ov_mps, 0)) END AS zone,
    CASE
        WHEN NOT begin_seen THEN why('overtake_begin_unseen')
        WHEN NOT vbp_placed THEN why('passed_unplaced', {'object_id': vbp_id})
        WHEN opposing IS NULL THEN why('no_overtaking_lane')
        WHEN da_m IS NULL THEN why('ego_unplaced_at_overtake')
        WHEN sda_m IS NULL AND v_av_mps <= v_vbp_mps THEN why('not_faster_than_passed')
        WHEN sda_m IS NULL AND profile = 'observed' AND status <> 'completed' THEN CASE status WHEN 'truncated' THEN why('overtake_truncated') ELSE why('overtake_aborted') END
        WHEN sda_m IS NULL AND ov_id IS NULL AND v_ov_mps IS NULL THEN why('no_oncoming_no_limit')
        WHEN sda_m IS NULL THEN why('speed_or_size_unknown')
        WHEN has_sped_up THEN why(CASE status WHEN 'truncated' THEN 'may_speed_up' ELSE 'sped_up' END, {'v_mps': v_av_mps, 'sda_m': sda_m, 'v_later_mps': v_later_mps, 'later_sda_m': sped_up_m, 'da_m': da_m})
        WHEN n_unplaced > 0 AND da_m > sda_m THEN why('record_actor_unbroken', {'lack': unplaced_reason})
        WHEN ov_id IS NULL AND da_m <= sda_m THEN why(CASE free_reason WHEN 'sensor_range' THEN 'short_sight_sensors' ELSE 'short_sight_map' END, {'free_m': da_m})
        WHEN ov_id IS NULL THEN why('no_oncoming', {'free_m': da_m})
        WHEN da_m <= sda_m AND sda_m = driven_m THEN why(CASE WHEN stands THEN 'out_of_lane_until_it_stood' ELSE 'out_of_lane' END, {'out_s': out_s})
        WHEN ov_id <> nearest_id THEN why('later_oncoming_worse', {'object_id': ov_id, 'nearest_id': nearest_id, 'da_m': da_m, 'sda_m': sda_m})
    END AS reason,
    CASE WHEN sda_m IS NOT NULL AND NOT is_driven THEN lane_width_m / tan(beta_rad) END AS pull_out_m,
    CASE WHEN sda_m IS NOT NULL AND NOT is_driven THEN v_av_mps * passing_s END AS passing_m,
    CASE WHEN sda_m IS NOT NULL AND NOT is_driven THEN lane_width_m / tan(theta_rad) END AS cut_in_m,
    CASE WHEN sda_m IS NOT NULL AND NOT is_driven THEN
        v_ov_mps * (pull_out_time_s(lane_width_m, beta_rad, v_av_mps) + passing_s + pull_out_time_s(lane_width_m, theta_rad, v_av_mps))
    END AS oncoming_m,
    CASE WHEN sda_m IS NOT NULL AND is_driven THEN driven_m - stopping_distance_m(v_ov_mps) END AS covered_m,
    CASE WHEN sda_m IS NOT NULL THEN stopping_distance_m(v_ov_mps) END AS stopping_m
FROM passing
