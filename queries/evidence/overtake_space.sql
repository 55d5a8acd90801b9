-- The danger spaces of the drives $ids, one row per ego and step.
SELECT o.drive_id, o.ego_id, o.t_ns, any_value(e.chain_id) AS chain_id, any_value(o.ds_av_s_m) AS s_m, any_value(o.ds_av_d_m) AS d_m,
    any_value(o.ds_av_half_m) AS half_m, max(o.sd_av_m) AS sd_av_m, max(o.sd_ov_m) AS sd_ov_m, min(o.stage) AS stage,
    list(DISTINCT o.vbp_id ORDER BY o.vbp_id) AS vbp_ids, min(o.ov_id) AS ov_id, any_value(o.ds_ov_s_m) AS ov_s_m,
    any_value(o.ds_ov_d_m) AS ov_d_m, any_value(o.ds_ov_half_m) AS ov_half_m,
    bool_or(coalesce(o.vbp_in_ds_av_m >= 0, false) OR coalesce(o.ov_in_ds_av_m >= 0, false)) AS av_met,
    bool_or(coalesce(o.av_in_ds_ov_m >= 0, false)) AS ov_met,
    bool_or(coalesce(o.ds_overlap_m >= 0, false)) AS overlap
FROM overtake_step o
JOIN ego_state e USING (drive_id, ego_id, t_ns)
WHERE list_contains($ids, o.drive_id)
GROUP BY o.drive_id, o.ego_id, o.t_ns
ORDER BY o.drive_id, o.ego_id, o.t_ns
