-- title = "Dropping back from a vehicle that moved in ahead"
-- clause = "UKHC R168: drop back to keep a two-second gap if someone overtakes and pulls into the gap in front of you"
-- hypothesis = "After another vehicle moved in ahead, was the two-second gap there again in time?"
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

-- @reference
SELECT drive_id, ego_id, t_ns, object_id, coalesce(in_place_ns, t_ns) AS in_place_ns, occurrence FROM cut_in

-- @condition
-- gone again, or behind another that moved in too: nothing is left to restore
SELECT s.drive_id, s.ego_id, s.t_ns, s.ref_id, s.object_id,
    CASE WHEN r.object_id IS NULL THEN NULL
        -- once the two have met there is no gap to restore, and nobody who has gone
        WHEN bool_or(coalesce(p.clearance_m <= 0, false)) OVER (PARTITION BY s.ref_id ORDER BY s.t_ns) THEN NULL
        WHEN l.object_id = r.object_id THEN l.gap_m >= $time_gap_s * stopping_factor(c.weather) * l.ego_speed_mps
        WHEN l.t_ns > r.in_place_ns THEN true WHEN l.t_ns IS NOT NULL THEN false END AS holds
FROM reference_step s
JOIN reference r USING (ref_id)
LEFT JOIN lead l ON l.drive_id = s.drive_id AND l.ego_id = s.ego_id AND l.t_ns = s.t_ns
LEFT JOIN ego_condition c ON c.drive_id = s.drive_id AND c.ego_id = s.ego_id AND c.t_ns = s.t_ns
LEFT JOIN pair p ON p.drive_id = s.drive_id AND p.ego_id = s.ego_id AND p.t_ns = s.t_ns AND p.object_id = r.object_id
