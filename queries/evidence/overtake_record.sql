INSERT INTO overtake_record BY NAME
WITH step_verdicts AS (
    SELECT o.drive_id, o.ego_id, o.occurrence, o.t_ns, o.stage, t.k, t.seg,
        [CASE WHEN vbp_in_ds_av_m >= 0 THEN 'fail' WHEN vbp_in_ds_av_m < 0 THEN 'pass' ELSE 'unknown' END,
            danger_space_verdict(ov_in_ds_av_m, ov_id, ov_known), danger_space_verdict(av_in_ds_ov_m, ov_id, ov_known), danger_space_verdict(ds_overlap_m, ov_id, ov_known)] AS said,
        vbp_in_ds_av_m AS a, ov_in_ds_av_m AS b, av_in_ds_ov_m AS c, ds_overlap_m AS d
    FROM overtake_step o JOIN step t USING (drive_id, ego_id, t_ns)
),
changed AS (
    SELECT *, (lag((stage, seg, said)) OVER w IS DISTINCT FROM (stage, seg, said))::INTEGER AS fresh FROM step_verdicts
    WINDOW w AS (PARTITION BY drive_id, ego_id, occurrence ORDER BY t_ns)
),
numbered AS (
    SELECT *, sum(fresh) OVER (PARTITION BY drive_id, ego_id, occurrence ORDER BY t_ns ROWS UNBOUNDED PRECEDING) AS run FROM changed
),
stretch AS (
    SELECT drive_id, ego_id, occurrence, run, stage, said, min(t_ns) AS t_start_ns, max(t_ns) AS t_end_ns, count(*) AS n,
        [max(a), max(b), max(c), max(d)] AS worst_m
    FROM numbered GROUP BY ALL
),
stretches AS (
    SELECT drive_id, ego_id, occurrence, list({'stage': stage, 't_start_ns': t_start_ns, 't_end_ns': t_end_ns, 'n': n, 'said': said,
        'worst_m': worst_m} ORDER BY run) AS stretches
    FROM stretch GROUP BY ALL
),
profiles AS (
    SELECT s.drive_id, s.ego_id, s.occurrence, list({'profile': s.profile, 'style': p.style, 'da_m': s.da_m, 'at_least': s.at_least,
        'nobody': s.nobody, 'sda_m': s.sda_m, 'spare_m': s.spare_m, 'spare_s': s.spare_s, 'zone': s.zone, 'reason': w.words
        } ORDER BY p.style, s.profile) AS profiles
    FROM overtake_sda s JOIN profile p USING (profile) LEFT JOIN _worded w ON w.cause = s.reason GROUP BY ALL
)
SELECT o.drive_id, o.ego_id, o.occurrence, o.status, o.opposing, o.vbp_id, o.ov_id, o.begin_seen, o.t0_ns, o.t1_ns, o.t2_ns, o.t3_ns,
    o.t_end_ns, o.v_av_mps, o.v_vbp_mps, o.v_ov_mps, o.l_av_m, o.l_vbp_m, o.lane_width_m, o.da_m, coalesce(p.profiles, []) AS profiles,
    coalesce(s.stretches, []) AS stretches
FROM overtake o
LEFT JOIN profiles p USING (drive_id, ego_id, occurrence)
LEFT JOIN stretches s USING (drive_id, ego_id, occurrence)
