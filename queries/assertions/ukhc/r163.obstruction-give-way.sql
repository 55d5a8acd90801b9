-- title = "Giving way to oncoming traffic when passing an obstruction"
-- breach = "Did not give way to oncoming traffic when passing an obstruction"
-- clause = "UKHC R163: give way to oncoming vehicles before you pass parked vehicles or other obstructions on your side of the road"
-- hypothesis = "When the ego went into the opposing lane round a standing vehicle, did no oncoming vehicle come close, hit the ego, have to brake, or have to wait?"
-- kind = "execution"
-- derivation = "model"
-- severity = "major"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["clock", "conflict", "ego_state", "forced_braking", "hidden", "impact", "overtake", "pair", "unplaced"]
-- requires = ["map", "registration", "handedness", "ego_size"]
--
-- [params.pet_s]
-- default = 2.0
-- unit = "s"
-- why = "our default: time between the ego leaving the ground and the oncoming vehicle reaching it"
--
-- [params.decel_mps2]
-- default = 2.0
-- unit = "m/s2"
-- why = "our default: more than letting off the accelerator or braking in comfort"
--
-- [params.oncoming_rad]
-- default = 2.6
-- unit = "rad"
-- why = "our default: within 30 degrees of head on"
--
-- [params.close_m]
-- default = 0.5
-- unit = "m"
-- why = "our default: two vehicles closer than this have hardly any room; mirrors take 0.2 m of it on each side"
--
-- [params.closing_mps]
-- default = 8.94
-- unit = "m/s"
-- why = "our default: slower, at 10 mph each, two drivers can squeeze past each other with care"
--
-- [reasons.came_by]
-- says = "{object_id} passed with {room_m:.2f} m between"
--
-- [reasons.ran_into]
-- says = "the ego and {object_id} ran into each other"
--
-- [reasons.braked_and_stood]
-- says = "{braked}, and stood until the ego had left or was about to leave"
--
-- [reasons.object_lacks_unbroken]
-- says = "object {object_id} {lack}"
-- advice = "record it without a break"
--
-- [reasons.pull_out_unseen]
-- says = "the log does not show where the ego pulled out"
-- advice = "record it from before that"
--
-- [reasons.ends_after_return]
-- says = "the log ends within {within_s:g} s after the ego was back in its lane"
-- advice = "record it for longer"

-- @reference
SELECT drive_id, ego_id, t0_ns AS t_ns, t_end_ns, vbp_id AS object_id, occurrence
FROM overtake
WHERE opposing IS DISTINCT FROM false
-- A row of parked vehicles is one obstruction, even if a moving vehicle is overtaken in the same go.
QUALIFY row_number() OVER (
    PARTITION BY drive_id, ego_id, t0_ns ORDER BY coalesce(v_vbp_mps > standing_mps(), false), v_vbp_mps IS NULL, occurrence
) = 1

-- @condition
-- The rule is known to be kept only if the manoeuvre was seen to its end: every vehicle placed, the ego back in its lane, and the log goes
-- on for pet_s after that. An oncoming vehicle that came later and braked hard had to brake for the ego if it would otherwise have come
-- within pet_s (forced_braking). If not, it may have braked for a light or others.
WITH oncoming_braking AS (
    SELECT
        r.ref_id,
        CASE
            WHEN made_to_brake(f.decel_mps2, f.pet_s, f.other_cause, $decel_mps2, $pet_s) THEN true
            -- A vehicle that came to a stand counts, however gently it braked. A bus may stand at its stop.
            WHEN f.waited IS DISTINCT FROM false AND f.pet_s < $pet_s AND is_vehicle(f.actor_class) IS DISTINCT FROM false
                THEN CASE WHEN f.waited AND f.other_cause IS NULL AND f.actor_class <> 'bus' THEN true END
            ELSE made_to_brake(f.decel_mps2, f.pet_s, f.other_cause, $decel_mps2, $pet_s)
        END AS is_violation,
        {'ease_mps2': -f.decel_mps2, 'words': CASE WHEN f.waited THEN why('braked_and_stood', {'braked': braking}) ELSE braking END} AS told
    FROM reference r
    JOIN forced_braking f ON f.drive_id = r.drive_id AND f.ego_id = r.ego_id AND abs(f.angle_rad) >= $oncoming_rad
        AND f.t_ego_in_ns >= r.t_ns AND f.t_ego_in_ns <= r.t_end_ns
    CROSS JOIN LATERAL (SELECT braked_reason(f.object_id, f.pet_s, f.decel_mps2, f.other_cause) AS braking) b
),
-- One vehicle that had to brake is enough.
braking_result AS (
    SELECT ref_id, CASE WHEN bool_or(is_violation) THEN true WHEN count(is_violation) = count(*) THEN false END AS is_violation,
        coalesce(min(told) FILTER (is_violation), min(told) FILTER (is_violation IS NULL)).words AS words
    FROM oncoming_braking
    GROUP BY ref_id
),
-- Oncoming vehicles that came by with hardly any room, or ran into the ego. A vehicle that reached over the line itself leaves the result
-- open.
close_meeting AS (
    SELECT ref_id, CASE WHEN bool_or(is_too_close) THEN true END AS is_violation, min({'passes': NOT is_impact, 'room_m': clearance_m, 'object_id': object_id}) AS least
    FROM (
        SELECT
            r.ref_id, p.object_id, p.clearance_m, i.t_ns IS NOT NULL AS is_impact,
            (i.t_ns IS NOT NULL OR p.speed_mps > standing_mps() AND e.speed_mps + p.speed_mps > $closing_mps) AND is_vehicle(p.actor_class)
                AND CASE WHEN NOT in_lane(p.d_m, p.lat_half_m, p.half_width_m) THEN true END AS is_too_close
        FROM reference r
        JOIN pair p ON p.drive_id = r.drive_id AND p.ego_id = r.ego_id AND p.t_ns >= r.t_ns AND p.t_ns <= r.t_end_ns
        JOIN ego_state e ON e.drive_id = p.drive_id AND e.ego_id = p.ego_id AND e.t_ns = p.t_ns
        LEFT JOIN impact i ON i.drive_id = p.drive_id AND i.ego_id = p.ego_id AND i.object_id = p.object_id AND i.t_ns = p.t_ns
        WHERE (p.clearance_m < $close_m OR i.t_ns IS NOT NULL) AND abs(p.heading_diff_rad) >= $oncoming_rad
    )
    WHERE is_too_close IS DISTINCT FROM false
    GROUP BY ref_id
),
-- A vehicle without a place that may be moving may have come within pet_s of the ego, until pet_s after the end of the overtake.
unplaced_vehicle AS (
    SELECT r.ref_id, min({'object_id': u.object_id, 'lack': u.code}) AS unplaced
    FROM reference r
    JOIN unplaced u ON u.drive_id = r.drive_id AND u.ego_id = r.ego_id AND u.t_ns >= r.t_ns AND u.t_ns <= r.t_end_ns + ($pet_s * 1e9)::BIGINT
        AND u.code NOT IN ('beyond_map', 'lost_behind')
    JOIN hidden h ON h.drive_id = u.drive_id AND h.ego_id = u.ego_id AND h.t_ns = u.t_ns AND h.object_id = u.object_id
    JOIN ego_state e ON e.drive_id = u.drive_id AND e.ego_id = u.ego_id AND e.t_ns = u.t_ns
    LEFT JOIN pair p ON p.drive_id = u.drive_id AND p.ego_id = u.ego_id AND p.t_ns = u.t_ns AND p.object_id = u.object_id
    WHERE h.vehicle AND h.ahead IS DISTINCT FROM false AND h.least_m < $pet_s * coalesce(e.speed_mps, unknown_speed_mps()) AND coalesce(p.speed_mps > standing_mps(), true)
    GROUP BY r.ref_id
)
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id, o.v_vbp_mps <= standing_mps() AS applies,
    CASE
        -- If it is not sure that the ego went round the vehicle, the rule can be kept, but not broken: it may have turned in at a junction.
        WHEN coalesce(bool_or(c.pet_s < $pet_s), false) OR f.is_violation OR m.is_violation THEN CASE WHEN NOT may_be_no_overtake(o.status, o.sure) THEN false END
        WHEN f.ref_id IS NOT NULL AND f.is_violation IS NULL OR m.ref_id IS NOT NULL OR coalesce(bool_or(c.decel_mps2 > $decel_mps2), false) THEN NULL
        WHEN o.begin_seen AND o.n_unplaced = 0 AND v.ref_id IS NULL AND count(c.object_id) = count(c.decel_mps2) AND k.t_end_ns >= o.t3_ns + ($pet_s * 1e9)::BIGINT THEN true
    END AS holds,
    CASE
        WHEN may_be_no_overtake(o.status, o.sure) AND (coalesce(bool_or(c.pet_s < $pet_s), false) OR f.is_violation OR m.is_violation) THEN overtake_doubt(o.vbp_id)
        WHEN coalesce(bool_or(c.pet_s < $pet_s), false)
            -- The object of the rule is the standing vehicle: the reason names the oncoming one.
            THEN min({'pet_s': c.pet_s, 'words': met_reason(c.object_id, c.pet_s, CASE WHEN c.decel_mps2 > $decel_mps2 THEN c.decel_mps2 END)})
                FILTER (c.pet_s < $pet_s).words
        WHEN m.ref_id IS NOT NULL AND f.is_violation IS DISTINCT FROM true 
            THEN CASE WHEN m.least.passes THEN why('came_by', m.least) ELSE why('ran_into', m.least) END
        WHEN f.words IS NOT NULL THEN f.words
        WHEN coalesce(bool_or(c.decel_mps2 > $decel_mps2), false)
            THEN min({'ease_mps2': -c.decel_mps2, 'words': why('braked_and_came_later', {'object_id': c.object_id, 'decel_mps2': c.decel_mps2, 'pet_s': c.pet_s})})
                FILTER (c.decel_mps2 > $decel_mps2).words
        WHEN o.t3_ns IS NULL THEN why('return_unseen')
        WHEN v.ref_id IS NOT NULL THEN why('object_lacks_unbroken', v.unplaced)
        WHEN NOT o.begin_seen THEN why('pull_out_unseen')
        WHEN o.n_unplaced > 0 AND o.unplaced_reason IS NOT NULL THEN why('record_actor_unbroken', {'lack': o.unplaced_reason})
        WHEN k.t_end_ns < o.t3_ns + ($pet_s * 1e9)::BIGINT THEN why('ends_after_return', {'within_s': $pet_s}) END AS reason
FROM reference r
JOIN overtake o USING (drive_id, ego_id, occurrence)
JOIN clock k USING (drive_id, ego_id)
LEFT JOIN braking_result f USING (ref_id)
LEFT JOIN close_meeting m USING (ref_id)
LEFT JOIN unplaced_vehicle v USING (ref_id)
LEFT JOIN (FROM conflict WHERE ego_first AND abs(angle_rad) >= $oncoming_rad) c
    ON c.drive_id = r.drive_id AND c.ego_id = r.ego_id AND c.t_ego_in_ns >= r.t_ns AND c.t_ego_in_ns <= r.t_end_ns
GROUP BY r.drive_id, r.ego_id, r.t_ns, r.ref_id, o.vbp_id, o.status, o.sure, o.v_vbp_mps, o.begin_seen, o.n_unplaced, o.unplaced_reason, o.t3_ns, k.t_end_ns, f.ref_id, f.is_violation, f.words, m.ref_id, m.is_violation, m.least, v.ref_id, v.unplaced
