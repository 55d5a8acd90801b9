-- The danger spaces at every step of an overtake, swept along the corridor: as wide as the vehicle, at its lateral position, and as long as
-- its stopping distance. The depth of a vehicle inside a danger space is the least overlap over the axes of both boxes, in corridor
-- coordinates: a turned vehicle counts with its real outline, not with its bounding box.
-- lifetime: part
CREATE TABLE overtake_step (
    drive_id VARCHAR NOT NULL,        -- the drive
    ego_id VARCHAR NOT NULL,          -- the ego
    occurrence INTEGER NOT NULL,      -- see overtake
    t_ns BIGINT NOT NULL,             -- a step from t0 to t_end
    stage VARCHAR NOT NULL,           -- [overtake_stage] {position}
    vbp_id VARCHAR NOT NULL,          -- the vehicle being passed (VBP) {position}
    sure BOOLEAN NOT NULL,            -- see overtake {position}
    ov_id VARCHAR,                    -- of the oncoming vehicles (OV) at this step, the one whose danger space reaches furthest into the ego's, see _oncoming_vehicle; NULL: none {position}
    ov_known BOOLEAN NOT NULL,        -- the positions of all vehicles are known: no other vehicle may be oncoming {position}
    ov_reason VARCHAR,                -- why ov_known is false, and what to provide, as JSON from the macro why; filled also where ov_known is true
    sd_av_m DOUBLE,                   -- stopping distance of the ego (AV): the length of its danger space {position, heading, velocity, size}
    ds_av_s_m DOUBLE,                 -- chain station at which the ego's danger space begins: the middle of the front bumper {position, heading, velocity, size}
    ds_av_d_m DOUBLE,                 -- lateral offset of the middle of the ego's danger space: that of the front bumper's middle, left positive {position, heading, velocity, size}
    ds_av_half_m DOUBLE,              -- half the width of the ego's danger space: half the vehicle's width {position, heading, velocity, size}
    sd_ov_m DOUBLE,                   -- stopping distance of the OV: the length of its danger space {position, heading, velocity, size}
    ds_ov_s_m DOUBLE,                 -- chain station at which the OV's danger space begins; it extends against the corridor {position, heading, velocity, size}
    ds_ov_d_m DOUBLE,                 -- lateral offset of the middle of the OV's danger space {position, heading, velocity, size}
    ds_ov_half_m DOUBLE,              -- half the width of the OV's danger space {position, heading, velocity, size}
    vbp_in_ds_av_m DOUBLE,            -- how far the VBP is inside the ego's danger space, in corridor coordinates; negative: distance from it {position, heading, velocity, size}
    ov_in_ds_av_m DOUBLE,             -- how far an OV is inside the ego's danger space, the most of all OVs; NULL: not known for one OV, and no other is inside {position, heading, velocity, size}
    av_in_ds_ov_m DOUBLE,             -- how far the ego is inside an OV's danger space, as ov_in_ds_av_m {position, heading, velocity, size}
    ds_overlap_m DOUBLE               -- how far the ego's and an OV's danger spaces overlap, as ov_in_ds_av_m {position, heading, velocity, size}
);

INSERT INTO overtake_step BY NAME
WITH stage AS (
    SELECT
        o.drive_id, o.ego_id, o.occurrence, o.vbp_id, o.sure AND e.t_ns >= o.t_begun_ns AS sure, e.t_ns,
        CASE
            WHEN e.t_ns < o.t_out_ns THEN 'pulling_out'
            WHEN o.t2_ns IS NULL OR e.t_ns < o.t2_ns THEN 'passing'
            ELSE 'cutting_in'
        END AS stage,
        e.s_m AS ego_s_m, e.d_m AS ego_d_m, cos(e.heading_diff_rad) AS c, sin(e.heading_diff_rad) AS s, e.length_m / 2 AS box_half_length_m, e.width_m / 2 AS box_half_width_m,
        -- A trailer counts by its extent along the lane.
        d.drive_id IS NOT NULL AS has_trailer, e.front_s_m AS ego_front_m, e.rear_s_m AS ego_rear_m, e.lat_half_m AS ego_lat_half_m,
        -- The danger space is as wide as the vehicle and begins at the middle of its front bumper.
        e.s_m + e.length_m / 2 * cos(e.heading_diff_rad) AS bumper_s_m, e.d_m + e.length_m / 2 * sin(e.heading_diff_rad) AS bumper_d_m,
        danger_space_m(e.speed_mps) AS sd_av_m, e.limit_mps, ego_lacks(e.x_m, e.yaw_rad, e.lanelet_id, e.front_s_m) AS ego_lack
    FROM overtake o
    JOIN ego_state e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.t_ns >= o.t0_ns AND e.t_ns <= o.t_end_ns
    LEFT JOIN (SELECT DISTINCT drive_id, ego_id FROM _ego_part WHERE part = 'trailer') d ON d.drive_id = o.drive_id AND d.ego_id = o.ego_id
    WHERE o.opposing IS DISTINCT FROM false
),
-- The first join is by time alone, which is a number: the keys are texts, and most of the drive is outside overtakes.
pair_in_overtake AS (
    SELECT
        *, danger_space_m(speed_mps) AS sd_m, cos(heading_diff_rad) AS c, sin(heading_diff_rad) AS s, length_m / 2 AS box_half_length_m, width_m / 2 AS box_half_width_m,
        s_m + length_m / 2 * cos(heading_diff_rad) AS bumper_s_m, d_m + length_m / 2 * sin(heading_diff_rad) AS bumper_d_m
    FROM pair SEMI JOIN stage USING (t_ns)
),
-- All oncoming vehicles except the vehicle being passed (VBP), which may stand against the traffic. For each of the three overlaps
-- (ov_in_m, av_in_m, overlap_m) the worst vehicle counts. If a vehicle's lateral position is not known, because it is still on another lane
-- or has no size, it may be the worst one, unless the danger spaces do not reach that far.
ov_overlap AS (
    SELECT
        s.drive_id, s.ego_id, s.occurrence, s.t_ns, v.object_id, v.da_m, o.sd_m, o.bumper_s_m, o.bumper_d_m, o.box_half_width_m,
        coalesce(box_depth(o.s_m - s.bumper_s_m - s.sd_av_m / 2, o.d_m - s.bumper_d_m, o.c, o.s, s.sd_av_m / 2, s.box_half_width_m, o.box_half_length_m, o.box_half_width_m), depth_if_apart(s.sd_av_m - v.da_m)) AS ov_in_m,
        coalesce(
            CASE
                WHEN s.has_trailer THEN least_of_three(s.ego_front_m - o.bumper_s_m + o.sd_m, o.bumper_s_m - s.ego_rear_m, s.ego_lat_half_m + o.box_half_width_m - abs(s.ego_d_m - o.bumper_d_m))
                ELSE box_depth(s.ego_s_m - o.bumper_s_m + o.sd_m / 2, s.ego_d_m - o.bumper_d_m, s.c, s.s, o.sd_m / 2, o.box_half_width_m, s.box_half_length_m, s.box_half_width_m)
            END,
            depth_if_apart(danger_space_m(v.speed_mps) - v.da_m)
        ) AS av_in_m,
        coalesce(
            least_of_three(s.bumper_s_m + s.sd_av_m - o.bumper_s_m + o.sd_m, o.bumper_s_m - s.bumper_s_m, s.box_half_width_m + o.box_half_width_m - abs(s.bumper_d_m - o.bumper_d_m)),
            depth_if_apart(s.sd_av_m + danger_space_m(v.speed_mps) - v.da_m)
        ) AS overlap_m
    FROM stage s
    JOIN _oncoming_vehicle v ON v.drive_id = s.drive_id AND v.ego_id = s.ego_id AND v.t_ns = s.t_ns AND v.vehicle AND v.object_id <> s.vbp_id
    LEFT JOIN pair_in_overtake o ON o.drive_id = s.drive_id AND o.ego_id = s.ego_id AND o.t_ns = s.t_ns AND o.object_id = v.object_id
),
worst_ov AS (
    SELECT
        drive_id, ego_id, occurrence, t_ns,
        min({'out_m': -coalesce(overlap_m, '-inf'::DOUBLE), 'da_m': da_m, 'id': object_id, 'sd_m': sd_m, 'bumper_s_m': bumper_s_m, 'bumper_d_m': bumper_d_m, 'box_half_width_m': box_half_width_m}) AS o,
        CASE WHEN count(ov_in_m) = count(*) OR max(ov_in_m) >= 0 THEN max(ov_in_m) END AS ov_in_m,
        CASE WHEN count(av_in_m) = count(*) OR max(av_in_m) >= 0 THEN max(av_in_m) END AS av_in_m,
        CASE WHEN count(overlap_m) = count(*) OR max(overlap_m) >= 0 THEN max(overlap_m) END AS overlap_m
    FROM ov_overlap
    GROUP BY ALL
)
SELECT
    s.drive_id, s.ego_id, s.occurrence, s.t_ns, s.stage, s.vbp_id, s.sure, w.o.id AS ov_id,
    -- It is known that no vehicle comes only within the visible range: an unseen vehicle at the speed limit (70 mph if the map has none)
    -- must be out of reach.
    coalesce(n.n_unplaced = 0 AND (n.object_id IS NOT NULL OR n.free_m > s.sd_av_m + danger_space_m(coalesce(s.limit_mps, 31.3))), false) AS ov_known,
    CASE WHEN n.t_ns IS NULL THEN CASE WHEN s.ego_lack IS NULL THEN why('oncoming_side_unknown') ELSE why('oncoming_unknown', {'lack': s.ego_lack}) END
        WHEN n.n_unplaced > 0 THEN why('record_actor', {'lack': n.unplaced_reason})
        ELSE why(CASE n.free_reason WHEN 'sensor_range' THEN 'free_to_sensor_range' ELSE 'free_to_map_end' END, {'free_m': n.free_m}) END AS ov_reason,
    s.sd_av_m, s.bumper_s_m AS ds_av_s_m, s.bumper_d_m AS ds_av_d_m, s.box_half_width_m AS ds_av_half_m,
    w.o.sd_m AS sd_ov_m, w.o.bumper_s_m AS ds_ov_s_m, w.o.bumper_d_m AS ds_ov_d_m, w.o.box_half_width_m AS ds_ov_half_m,
    box_depth(b.s_m - s.bumper_s_m - s.sd_av_m / 2, b.d_m - s.bumper_d_m, b.c, b.s, s.sd_av_m / 2, s.box_half_width_m, b.box_half_length_m, b.box_half_width_m) AS vbp_in_ds_av_m,
    w.ov_in_m AS ov_in_ds_av_m, w.av_in_m AS av_in_ds_ov_m, w.overlap_m AS ds_overlap_m
FROM stage s
LEFT JOIN pair_in_overtake b ON b.drive_id = s.drive_id AND b.ego_id = s.ego_id AND b.t_ns = s.t_ns AND b.object_id = s.vbp_id
LEFT JOIN oncoming n ON n.drive_id = s.drive_id AND n.ego_id = s.ego_id AND n.t_ns = s.t_ns
LEFT JOIN worst_ov w ON w.drive_id = s.drive_id AND w.ego_id = s.ego_id AND w.occurrence = s.occurrence AND w.t_ns = s.t_ns
