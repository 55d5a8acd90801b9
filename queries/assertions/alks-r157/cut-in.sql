-- title = "No collision with a vehicle that cuts in"
-- breach = "Collision with a vehicle that cut in"
-- clause = "UN R157 5.2.5.2: avoid a collision with a slower vehicle that cuts in and keeps its speed, if it was seen to move over for 0.72 s and leaves more than the time to collision given by the formula"
-- hypothesis = "After a slower vehicle cut in with enough time left, did the ego avoid touching it?"
-- kind = "postcondition"
-- subtype = "temporal"
-- window_s = "window_s"
-- derivation = "direct"
-- severity = "critical"
-- legal = "must"
-- status = "stable"
-- sense = ">"
-- unit = "m"
-- observes = "clearance to the vehicle that cut in"
-- near_margin = 0.5
-- reads = ["cut_in", "ego_state", "lost_object", "pair"]
-- requires = ["mode_engaged", "map", "registration", "ego_size"]
--
-- [params.window_s]
-- default = 5.0
-- unit = "s"
-- why = "our default: by then the conflict is over"
--
-- [params.brake_mps2]
-- default = 6.0
-- unit = "m/s2"
-- why = "deceleration that the system is assumed to be capable of"
-- source = "UN R157 5.2.5.2"
--
-- [params.delay_s]
-- default = 0.35
-- unit = "s"
-- why = "time until it brakes that hard (0.25 s in EU 2022/1426)"
-- source = "UN R157 5.2.5.2"
--
-- [params.visible_s]
-- default = 0.72
-- unit = "s"
-- why = "the system must have seen the vehicle move over for this long"
-- source = "UN R157 5.2.5.2"
--
-- [params.pause_s]
-- default = 2.0
-- unit = "s"
-- why = "our default: if the centre of the vehicle comes into the lane later than this after its edge did, the vehicle cuts in a second time"
--
-- [params.moved_m]
-- default = 0.05
-- unit = "m"
-- why = "our default: a vehicle that comes nearer to the line by more than this has begun to move over; one that has not gives no warning"
--
-- [params.slowed_mps]
-- default = 1.0
-- unit = "m/s"
-- why = "our default: a vehicle that has lost more than this since it cut in has not kept its speed"
--
-- [reasons.cutter_slowed]
-- says = "{object_id} was {slower_mps:.1f} m/s slower than when it cut in: it is not known whether the ego would have touched it if it had kept its speed"

-- @reference
SELECT drive_id, ego_id, t_ns, object_id, speed_mps, again
FROM (
    SELECT drive_id, ego_id, t_ns, object_id, false AS again, gap_m, ego_speed_mps, speed_mps FROM cut_in
    UNION ALL
    SELECT c.drive_id, c.ego_id, c.in_place_ns, c.object_id, true, p.rear_s_m - e.front_s_m, e.speed_mps, p.speed_mps
    FROM cut_in c
    LEFT JOIN ego_state e ON e.drive_id = c.drive_id AND e.ego_id = c.ego_id AND e.t_ns = c.in_place_ns
    LEFT JOIN pair p ON p.drive_id = c.drive_id AND p.ego_id = c.ego_id AND p.t_ns = c.in_place_ns AND p.object_id = c.object_id
    WHERE c.in_place_ns - c.t_ns > $pause_s * 1e9
)
-- Only cut-ins of slower vehicles whose time to collision leaves the system a chance. If a speed is not known, the cut-in may be one of
-- these.
WHERE coalesce(ego_speed_mps > speed_mps AND gap_m > (ego_speed_mps - speed_mps) * ((ego_speed_mps - speed_mps) / (2 * $brake_mps2) + $delay_s), true)

-- @condition
-- A vehicle that does not come nearer to the line during the three seconds before the last visible_s gives no warning: the system had no
-- chance, and the rule does not apply.
WITH approach AS (
    SELECT r.ref_id, max({'t_ns': p.t_ns, 'off_m': abs(p.d_m)}).off_m < max(abs(p.d_m)) - $moved_m AS has_approached
    FROM reference r
    JOIN pair p ON p.drive_id = r.drive_id AND p.ego_id = r.ego_id AND p.object_id = r.object_id
        AND p.t_ns <= r.t_ns - ($visible_s * 1e9)::BIGINT AND p.t_ns >= r.t_ns - ($visible_s * 1e9)::BIGINT - 3_000_000_000
    WHERE p.d_m IS NOT NULL
    GROUP BY r.ref_id
)
SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id, s.object_id, 0 AS required, p.clearance_is_bound AS at_least, r.again OR coalesce(a.has_approached, true) AS applies,
    -- A vehicle whose track ended in sight and far away can no longer be touched.
    CASE WHEN s.object_id IS NULL THEN NULL WHEN p.object_id IS NOT NULL THEN CASE WHEN p.clearance_m > 0 OR (slower.mps > $slowed_mps) IS DISTINCT FROM true THEN p.clearance_m END
        WHEN l.object_id IS NULL THEN 'inf'::DOUBLE END AS observed,
    CASE WHEN p.clearance_m <= 0 AND slower.mps > $slowed_mps THEN why('cutter_slowed', {'object_id': s.object_id, 'slower_mps': slower.mps}) END AS reason
FROM reference_step s
JOIN reference r USING (ref_id)
LEFT JOIN approach a USING (ref_id)
LEFT JOIN pair p ON p.drive_id = s.drive_id AND p.ego_id = s.ego_id AND p.t_ns = s.t_ns AND p.object_id = s.object_id
LEFT JOIN lost_object l ON l.drive_id = s.drive_id AND l.ego_id = s.ego_id AND l.object_id = s.object_id AND s.t_ns >= l.t_from_ns AND s.t_ns <= l.t_to_ns
CROSS JOIN LATERAL (SELECT r.speed_mps - p.speed_mps AS mps) slower
