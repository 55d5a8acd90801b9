-- title = "Dropping back from a vehicle that moved in ahead"
-- breach = "Did not drop back from a vehicle that moved in ahead"
-- clause = "UKHC R168: drop back to keep a two-second gap if someone overtakes and pulls into the gap in front of you"
-- hypothesis = "After another vehicle moved in ahead, was the two-second gap restored in time?"
-- kind = "postcondition"
-- subtype = "temporal"
-- window_s = "restore_s"
-- quantifier = "eventually"
-- derivation = "direct"
-- severity = "minor"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["cut_in", "ego_condition", "lead", "pair"]
-- requires = ["map", "registration", "ego_size"]
--
-- [params.restore_s]
-- default = 10.0
-- unit = "s"
-- why = "our default: letting off the accelerator makes the gap in that time"
--
-- [params.time_gap_s]
-- default = 2.0
-- unit = "s"
-- why = "the Code's two seconds, twice that in the wet; the weather counts as dry where it is not known"
-- source = "UKHC R126 and R168"
--
-- [params.gone_s]
-- default = 2.0
-- unit = "s"
-- why = "our default: a vehicle that is between the two for less than this may only be passing through"
--
-- [reasons.boxes_overlap]
-- says = "the boxes of the ego and {object_id} overlap, or did before, so there is no gap to restore"
-- advice = "correct them, or see ukhc.no-collision"

-- @reference
-- A vehicle that may have moved in unseen, but further away than the gap to keep, leaves nothing to restore.
SELECT drive_id, ego_id, t_ns, object_id, coalesce(in_place_ns, t_ns) AS in_place_ns, occurrence
FROM cut_in
LEFT JOIN ego_condition c USING (drive_id, ego_id, t_ns)
WHERE coalesce(free_m < $time_gap_s * stopping_factor(c.weather) * ego_speed_mps, true)

-- @condition
-- If the vehicle has gone again, or is behind another one that moved in, too, there is nothing left to restore. A vehicle that is ahead
-- again later was only hidden by another one.
WITH lead_step AS (
    SELECT s.*, r.in_place_ns, r.object_id AS cutter_id, l.t_ns IS NOT NULL AS lead_is_known, l.object_id AS ahead_id, l.gap_m, l.ego_speed_mps,
        max(s.t_ns) FILTER (l.object_id = r.object_id) OVER (PARTITION BY s.ref_id) AS t_last_ns,
        max(s.t_ns) FILTER (l.t_ns IS NULL OR l.object_id = r.object_id) OVER (PARTITION BY s.ref_id ORDER BY s.t_ns) AS t_not_gone_ns
    FROM reference_step s
    JOIN reference r USING (ref_id)
    LEFT JOIN lead l ON l.drive_id = s.drive_id AND l.ego_id = s.ego_id AND l.t_ns = s.t_ns
)
SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id, s.object_id,
    CASE WHEN s.cutter_id IS NULL OR NOT s.lead_is_known THEN NULL
        -- After the two boxes have touched, it is not known whether the gap was restored or the vehicle has gone.
        WHEN bool_or(coalesce(p.clearance_m <= 0, false)) OVER (PARTITION BY s.ref_id ORDER BY s.t_ns) THEN NULL
        WHEN s.ahead_id = s.cutter_id THEN s.gap_m >= $time_gap_s * stopping_factor(c.weather) * s.ego_speed_mps
        WHEN s.t_ns < s.t_last_ns OR s.t_ns <= s.in_place_ns THEN false
        WHEN s.t_ns - greatest(s.in_place_ns, s.t_not_gone_ns) >= $gone_s * 1e9 THEN true END AS holds,
    CASE WHEN bool_or(coalesce(p.clearance_m <= 0, false)) OVER (PARTITION BY s.ref_id ORDER BY s.t_ns)
        THEN why('boxes_overlap', {'object_id': s.cutter_id}) END AS reason
FROM lead_step s
LEFT JOIN ego_condition c ON c.drive_id = s.drive_id AND c.ego_id = s.ego_id AND c.t_ns = s.t_ns
LEFT JOIN pair p ON p.drive_id = s.drive_id AND p.ego_id = s.ego_id AND p.t_ns = s.t_ns AND p.object_id = s.cutter_id
