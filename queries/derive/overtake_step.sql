-- The danger spaces at every step of an overtake, swept along the corridor: as wide as the vehicle where it is across the lane, as long
-- as its stopping distance. How far a vehicle is inside one is the least overlap over the axes of both boxes, in corridor coordinates: a
-- vehicle that stands across the lane reaches no further than its corners.
WITH stage AS (
    SELECT
        o.drive_id, o.ego_id, o.occurrence, o.vbp_id, o.sure, e.t_ns,
        CASE
            WHEN e.t_ns < o.t_out_ns THEN 'pulling_out'
            WHEN o.t2_ns IS NULL OR e.t_ns < o.t2_ns THEN 'passing'
            ELSE 'cutting_in'
        END AS stage,
        e.s_m AS es, e.d_m AS ed, cos(e.heading_diff_rad) AS c, sin(e.heading_diff_rad) AS s, e.length_m / 2 AS hl, e.width_m / 2 AS hw,
        -- a trailer counts by its reach along the lane
        d.drive_id IS NOT NULL AS drawing, e.front_s_m AS ef, e.rear_s_m AS er, e.lat_half_m AS eh,
        -- the danger space is as wide as the vehicle and begins at the middle of its front bumper
        e.s_m + e.length_m / 2 * cos(e.heading_diff_rad) AS fs, e.d_m + e.length_m / 2 * sin(e.heading_diff_rad) AS fd,
        danger_space_m(e.speed_mps) AS sd_av_m, e.limit_mps, ego_lacks(e.x_m, e.yaw_rad, e.lanelet_id, e.front_s_m) AS lacks
    FROM overtake o
    JOIN ego_state e ON e.drive_id = o.drive_id AND e.ego_id = o.ego_id AND e.t_ns >= o.t0_ns AND e.t_ns <= o.t_end_ns
    LEFT JOIN (SELECT DISTINCT drive_id, ego_id FROM ego_part WHERE part = 'trailer') d ON d.drive_id = o.drive_id AND d.ego_id = o.ego_id
    WHERE o.opposing IS DISTINCT FROM false
),
-- by the time alone first, a number: the keys are texts, and most of the drive is no overtake
met AS (
    SELECT
        *, danger_space_m(speed_mps) AS sd_m, cos(heading_diff_rad) AS c, sin(heading_diff_rad) AS s, length_m / 2 AS hl, width_m / 2 AS hw,
        s_m + length_m / 2 * cos(heading_diff_rad) AS fs, d_m + length_m / 2 * sin(heading_diff_rad) AS fd
    FROM pair SEMI JOIN stage USING (t_ns)
),
-- every oncoming vehicle but the one that is passed, which stands the wrong way round: the worst of them counts, of each distance. One whose place across the corridor is not known, for it is still on its
-- way there or has no size, may be the worst unless the danger spaces do not even reach so far
against AS (
    SELECT
        s.drive_id, s.ego_id, s.occurrence, s.t_ns, v.object_id, v.da_m, o.sd_m, o.fs, o.fd, o.hw,
        coalesce(box_depth(o.s_m - s.fs - s.sd_av_m / 2, o.d_m - s.fd, o.c, o.s, s.sd_av_m / 2, s.hw, o.hl, o.hw), short_of(s.sd_av_m - v.da_m)) AS ov_in_m,
        coalesce(
            CASE
                WHEN s.drawing THEN inside3(s.ef - o.fs + o.sd_m, o.fs - s.er, s.eh + o.hw - abs(s.ed - o.fd))
                ELSE box_depth(s.es - o.fs + o.sd_m / 2, s.ed - o.fd, s.c, s.s, o.sd_m / 2, o.hw, s.hl, s.hw)
            END,
            short_of(danger_space_m(v.speed_mps) - v.da_m)
        ) AS av_in_m,
        coalesce(
            inside3(s.fs + s.sd_av_m - o.fs + o.sd_m, o.fs - s.fs, s.hw + o.hw - abs(s.fd - o.fd)),
            short_of(s.sd_av_m + danger_space_m(v.speed_mps) - v.da_m)
        ) AS overlap_m
    FROM stage s
    JOIN oncoming_vehicle v ON v.drive_id = s.drive_id AND v.ego_id = s.ego_id AND v.t_ns = s.t_ns AND v.vehicle AND v.object_id <> s.vbp_id
    LEFT JOIN met o ON o.drive_id = s.drive_id AND o.ego_id = s.ego_id AND o.t_ns = s.t_ns AND o.object_id = v.object_id
),
worst AS (
    SELECT
        drive_id, ego_id, occurrence, t_ns,
        min({'out_m': -coalesce(overlap_m, '-inf'::DOUBLE), 'da_m': da_m, 'id': object_id, 'sd_m': sd_m, 'fs': fs, 'fd': fd, 'hw': hw}) AS o,
        CASE WHEN count(ov_in_m) = count(*) OR max(ov_in_m) >= 0 THEN max(ov_in_m) END AS ov_in_m,
        CASE WHEN count(av_in_m) = count(*) OR max(av_in_m) >= 0 THEN max(av_in_m) END AS av_in_m,
        CASE WHEN count(overlap_m) = count(*) OR max(overlap_m) >= 0 THEN max(overlap_m) END AS overlap_m
    FROM against
    GROUP BY ALL
)
SELECT
    s.drive_id, s.ego_id, s.occurrence, s.t_ns, s.stage, s.vbp_id, s.sure, w.o.id AS ov_id,
    -- nobody is there only as far as can be told: an unseen vehicle at the limit (70 mph where the map has none) must be out of reach
    coalesce(n.n_unplaced = 0 AND (n.object_id IS NOT NULL OR n.free_m > s.sd_av_m + danger_space_m(coalesce(s.limit_mps, 31.3))), false) AS ov_known,
    CASE WHEN n.t_ns IS NULL THEN 'whether somebody comes is not known: ' || coalesce(s.lacks, 'the side that is driven on is not, give it with --handedness')
        WHEN n.n_unplaced > 0 THEN n.unplaced_reason || ': record it'
        ELSE format(
            'nobody is seen to come, but only {:.0f} m are seen: {}', n.free_m,
            CASE n.free_reason WHEN 'sensor_range' THEN 'the sensors reach no further (--sensor-range, if they do)' ELSE 'give a map that goes on' END
        ) END AS ov_reason,
    s.sd_av_m, s.fs AS ds_av_s_m, s.fd AS ds_av_d_m, s.hw AS ds_av_half_m,
    w.o.sd_m AS sd_ov_m, w.o.fs AS ds_ov_s_m, w.o.fd AS ds_ov_d_m, w.o.hw AS ds_ov_half_m,
    box_depth(b.s_m - s.fs - s.sd_av_m / 2, b.d_m - s.fd, b.c, b.s, s.sd_av_m / 2, s.hw, b.hl, b.hw) AS vbp_in_ds_av_m,
    w.ov_in_m AS ov_in_ds_av_m, w.av_in_m AS av_in_ds_ov_m, w.overlap_m AS ds_overlap_m
FROM stage s
LEFT JOIN met b ON b.drive_id = s.drive_id AND b.ego_id = s.ego_id AND b.t_ns = s.t_ns AND b.object_id = s.vbp_id
LEFT JOIN oncoming n ON n.drive_id = s.drive_id AND n.ego_id = s.ego_id AND n.t_ns = s.t_ns
LEFT JOIN worst w ON w.drive_id = s.drive_id AND w.ego_id = s.ego_id AND w.occurrence = s.occurrence AND w.t_ns = s.t_ns
