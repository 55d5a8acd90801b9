-- title = "RSS: proper response"
-- breach = "RSS: no proper response"
-- clause = "RSS definition 4 (Shalev-Shwartz et al. 2017): once a situation is dangerous, brake after the response time until it is safe again"
-- hypothesis = "After the gap to the vehicle ahead had become unsafe, did the ego brake with at least 4 m/s2 within a second and until it was safe again?"
-- kind = "postcondition"
-- subtype = "temporal"
-- window_s = "window_s"
-- derivation = "model"
-- severity = "minor"
-- legal = "should"
-- status = "draft"
-- sense = ">="
-- unit = "m/s2"
-- observes = "deceleration"
-- near_margin = 0.5
-- reads = ["clock", "ego_motion", "step", "vehicle_ahead"]
-- without_time = "at some steps, the vehicle ahead of the ego, its distance or its speed is not known: rss.longitudinal names these steps, and what to record"
-- requires = ["way", "ego_size"]
--
-- [params.rho_s]
-- default = 1.0
-- unit = "s"
-- why = "response time of the ego"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.accel_mps2]
-- default = 3.5
-- unit = "m/s2"
-- why = "greatest acceleration during the response time"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.brake_min_mps2]
-- default = 4.0
-- unit = "m/s2"
-- why = "braking that may be counted on after the response time"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.brake_max_mps2]
-- default = 8.0
-- unit = "m/s2"
-- why = "hardest braking of the vehicle ahead"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.rho_other_s]
-- default = 2.0
-- unit = "s"
-- why = "response time of others, driven by people"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.lat_accel_mps2]
-- default = 0.2
-- unit = "m/s2"
-- why = "greatest acceleration to the side during the response time"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.lat_brake_mps2]
-- default = 0.8
-- unit = "m/s2"
-- why = "braking of the lateral movement after the response time"
-- source = "ad-rss-lib, parameter discussion"
--
-- [params.mu_m]
-- default = 0.1
-- unit = "m"
-- why = "vehicles do not keep their line exactly"
-- source = "ad-rss-lib, parameter discussion (fluctuation margin)"
--
-- [params.window_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: the response time and four seconds of braking, which take 16 m/s off"
--
-- # Draft: it demands braking wherever rss.longitudinal finds a gap too small; ordinary driving does not brake there.

-- @reference
WITH ahead_step AS (
    SELECT s.drive_id, s.ego_id, s.t_ns, s.k, s.seg, v.object_id,
        CASE WHEN v.object_id IS NOT NULL THEN follows(v.in_lane, v.gap_m, v.speed_mps, v.oncoming) AND v.ego_speed_mps > standing_mps()
            AND v.gap_m < rss_longitudinal_m(v.ego_speed_mps, ahead_mps(v.speed_mps, v.oncoming), $rho_s, $accel_mps2, $brake_min_mps2, $brake_max_mps2)
            AND v.across_m < rss_across_m(v.ego_across_mps, $rho_s, v.across_mps, v.speed_mps, $rho_other_s, $lat_accel_mps2, $lat_brake_mps2, $mu_m)
        WHEN v.known THEN false END AS is_unsafe
    FROM step s
    LEFT JOIN vehicle_ahead v ON v.drive_id = s.drive_id AND v.ego_id = s.ego_id AND v.t_ns = s.t_ns
)
SELECT drive_id, ego_id, min(t_ns) AS t_ns, object_id, max(t_ns) AS t_last_ns
FROM (SELECT *, k - row_number() OVER (PARTITION BY drive_id, ego_id, object_id, seg ORDER BY k) AS run FROM ahead_step WHERE is_unsafe)
GROUP BY drive_id, ego_id, object_id, seg, run
UNION ALL
-- If it is not known which vehicle is ahead, or how near it is, the time at which the gap became unsafe is not known.
SELECT drive_id, ego_id, NULL, NULL, NULL FROM ahead_step WHERE is_unsafe IS NULL GROUP BY drive_id, ego_id

-- @condition
-- An acceleration is a mean over the filter's window. It shows whether the ego braked only if the window lies wholly within the time in
-- which the ego must brake. If the danger ends sooner, the mean may be too small although the ego braked hard enough.
SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id, $brake_min_mps2 AS required,
    CASE WHEN braking_span.holds_window OR -m.accel_mps2 >= $brake_min_mps2 THEN -m.accel_mps2 END AS observed,
    s.t_ns >= braking_span.t_from_ns AND s.t_ns <= braking_span.t_to_ns AS applies
FROM reference_step s
JOIN reference r USING (ref_id)
JOIN clock c ON c.drive_id = s.drive_id AND c.ego_id = s.ego_id
CROSS JOIN LATERAL (SELECT r.t_ns + ($rho_s * 1e9)::BIGINT AS t_due_ns, coalesce(filter_half_ns(c.period_ns), 0) AS half_ns) due
CROSS JOIN LATERAL (
    SELECT fit.holds_window, due.t_due_ns + CASE WHEN fit.holds_window THEN due.half_ns ELSE 0 END AS t_from_ns, r.t_last_ns - CASE WHEN fit.holds_window THEN due.half_ns ELSE 0 END AS t_to_ns
    FROM (SELECT r.t_last_ns - due.t_due_ns >= 2 * due.half_ns + c.period_ns AS holds_window) fit
) braking_span
LEFT JOIN ego_motion m ON m.drive_id = s.drive_id AND m.ego_id = s.ego_id AND m.t_ns = s.t_ns
