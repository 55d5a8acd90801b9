-- The values that a viewer plots for the first ego of each of the drives $ids, one row per step. NULL: not known, no actor there, or no rule of the
-- run reads the table that it comes from.
WITH
first_ego AS (
    SELECT drive_id, min(actor_id) AS ego_id
    FROM actor
    SEMI JOIN actor_state USING (drive_id, actor_id)
    WHERE is_ego AND list_contains($ids, drive_id)
    GROUP BY drive_id
),
ego_step AS (SELECT e.* FROM ego_state e SEMI JOIN first_ego USING (drive_id, ego_id)),
pair_of_ego AS (SELECT p.* FROM pair p SEMI JOIN first_ego USING (drive_id, ego_id)),
ahead AS (
    SELECT v.*, ttc_s(v.gap_m, v.ego_speed_mps - along_mps(v.speed_mps, v.oncoming)) AS time_s
    FROM vehicle_ahead v
    SEMI JOIN first_ego USING (drive_id, ego_id)
    WHERE v.object_id IS NOT NULL
),
lead_vehicle AS (SELECT drive_id, ego_id, t_ns, any_value(object_id) AS lead_id, any_value(gap_m) AS lead_gap_m FROM ahead WHERE nearest GROUP BY ALL),
-- The same vehicles as in the rule on the time to collision: those that the ego may touch on its present course.
soonest AS (
    SELECT v.drive_id, v.ego_id, v.t_ns, min({'time_s': v.time_s, 'id': v.object_id}) AS first
    FROM ahead v
    JOIN ego_step e ON e.drive_id = v.drive_id AND e.ego_id = v.ego_id AND e.t_ns = v.t_ns
    JOIN pair_of_ego p ON p.drive_id = v.drive_id AND p.ego_id = v.ego_id AND p.t_ns = v.t_ns AND p.object_id = v.object_id
    -- A longer time comes from a difference of the speeds that no log resolves.
    WHERE v.time_s <= 600.0 AND must_keep(v.passes_by, v.grazes, v.time_s >= serious_ttc_s()) AND either_moves(v.ego_speed_mps, v.speed_mps)
        AND on_course(
            v.gap_m, v.time_s, e.d_m, e.lat_half_m, e.speed_mps * sin(e.heading_diff_rad),
            p.d_m, p.lat_half_m, p.speed_mps * sin(p.heading_diff_rad)
        )
    GROUP BY ALL
),
nearest AS (
    SELECT drive_id, ego_id, t_ns, min({'clearance_m': clearance_m, 'id': object_id}) AS first
    FROM pair_of_ego
    WHERE NOT clearance_is_bound
    GROUP BY ALL
),
oncoming_in_overtake AS (
    SELECT drive_id, ego_id, t_ns, min({'gap_m': ds_ov_s_m - ds_av_s_m, 'id': ov_id, 'required_m': sd_av_m + sd_ov_m}) AS first
    FROM overtake_step
    SEMI JOIN first_ego USING (drive_id, ego_id)
    -- Once they have met, there is no gap to keep.
    WHERE ds_ov_s_m - ds_av_s_m >= 0
    GROUP BY ALL
)
-- Verdicts round what they judge to nine decimals, too.
SELECT e.drive_id, e.ego_id, e.t_ns,
    round(e.speed_mps, 9) AS speed_mps, round(e.accel_mps2, 9) AS accel_mps2, round(e.limit_mps, 9) AS limit_mps,
    round(danger_space_m(e.speed_mps), 9) AS stopping_m,
    l.lead_id, round(l.lead_gap_m, 9) AS lead_gap_m, s.first.id AS ttc_id, round(s.first.time_s, 9) AS ttc_s,
    o.first.id AS oncoming_id, round(o.first.gap_m, 9) AS oncoming_gap_m, round(o.first.required_m, 9) AS oncoming_required_m,
    n.first.id AS nearest_id, round(n.first.clearance_m, 9) AS clearance_m
FROM ego_step e
LEFT JOIN lead_vehicle l USING (drive_id, ego_id, t_ns)
LEFT JOIN soonest s USING (drive_id, ego_id, t_ns)
LEFT JOIN oncoming_in_overtake o USING (drive_id, ego_id, t_ns)
LEFT JOIN nearest n USING (drive_id, ego_id, t_ns)
ORDER BY e.drive_id, e.ego_id, e.t_ns
