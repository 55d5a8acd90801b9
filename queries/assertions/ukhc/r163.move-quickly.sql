-- title = "Quickly past the vehicle being overtaken"
-- breach = "Too slow past the vehicle being overtaken"
-- clause = "UKHC R163: move quickly past the vehicle you are overtaking once you have started"
-- hypothesis = "Was the ego back in its lane in at most one and a half times the time that the least aggressive profile takes?"
-- kind = "execution"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = "<="
-- unit = "s"
-- observes = "time out of its lane"
-- near_margin = 1.0
-- reads = ["overtake", "profile"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [params.slack]
-- default = 1.5
-- unit = ""
-- why = "our default: half as long again as the model"
--
-- # Draft: what is quick is a judgement, and the profiles are those of the slow overtakes of Harper et al. 2021.
--
-- [reasons.overtaken_speed_unknown]
-- says = "the speed of {object_id} where the ego pulled out is not known"
-- advice = "record it from before that"
--
-- [reasons.pulled_out_no_faster]
-- says = "the ego pulled out no faster than {object_id}: the model has no time for that"

-- @reference
SELECT drive_id, ego_id, coalesce(t3_ns, t0_ns) AS t_ns, vbp_id AS object_id, occurrence
FROM overtake
WHERE passed AND opposing IS DISTINCT FROM false
-- If two vehicles are passed in one go, the time lasts until the ego is back ahead of the last one, and span_m covers both.
QUALIFY occurrence = max(occurrence) OVER (PARTITION BY drive_id, ego_id, t0_ns)

-- @condition
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, CASE WHEN o.begin_seen THEN (o.t3_ns - o.t0_ns) / 1e9 END AS observed,
    CASE WHEN NOT o.begin_seen THEN why('overtake_begin_unseen')
        WHEN o.t3_ns IS NULL THEN why('return_unseen')
        WHEN o.v_vbp_mps IS NULL THEN why('overtaken_speed_unknown', {'object_id': o.vbp_id})
        WHEN o.v_av_mps <= o.v_vbp_mps THEN why('pulled_out_no_faster', {'object_id': o.vbp_id}) END AS reason,
    $slack * (
        pull_out_time_s(o.lane_width_m, p.pull_out_angle_rad, o.v_av_mps) + pull_out_time_s(o.lane_width_m, p.cut_in_angle_rad, o.v_av_mps)
        + passing_time_s(o.lane_width_m, p.pull_out_angle_rad, p.pull_out_headroom_m, p.cut_in_clearance_m, o.l_av_m, o.span_m, o.v_av_mps, o.v_vbp_mps)
    ) AS required
FROM reference r
JOIN overtake o USING (drive_id, ego_id, occurrence)
CROSS JOIN (FROM profile WHERE pull_out_angle_rad IS NOT NULL QUALIFY style = min(style) OVER ()) p
