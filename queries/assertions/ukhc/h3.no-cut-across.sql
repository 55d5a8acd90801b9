-- title = "Do not cut across cyclists and horses"
-- clause = "UKHC H3 and R182: do not cut across cyclists or horses going ahead when you turn"
-- hypothesis = "When the ego turned before a cyclist or horse going ahead, did it leave enough time and make nobody brake?"
-- kind = "execution"
-- derivation = "direct"
-- severity = "critical"
-- legal = "should"
-- status = "stable"
-- sense = "holds"
-- reads = ["junction_passage", "passage_conflict", "road_user"]
-- requires = ["map", "registration", "ego_size"]
--
-- [params.pet_s]
-- default = 2.0
-- unit = "s"
-- why = "our default: the two seconds that are also asked for when following"
--
-- [params.decel_mps2]
-- default = 1.5
-- unit = "m/s2"
-- why = "our default: a cyclist who brakes harder than this has been made to"

-- @reference
SELECT p.drive_id, p.ego_id, p.t_in_ns AS t_ns, p.occurrence, p.turn, c.object_id, c.actor_class, c.decel_mps2, c.reason,
    c.braked_id, c.braked_pet_s, c.braked_mps2, c.braked_cause, made_to_brake(c.braked_mps2, c.braked_pet_s, c.braked_cause, $decel_mps2, $pet_s) AS braked,
    pet_known(c.pet_s, c.reason, $pet_s, true) AS pet_s
FROM junction_passage p
LEFT JOIN passage_conflict c ON c.drive_id = p.drive_id AND c.ego_id = p.ego_id AND c.occurrence = p.occurrence AND c.relation = 'ahead_going'
WHERE p.turn IS DISTINCT FROM 'straight'

-- @condition
-- another vehicle that came sooner may hide a cyclist behind it: then only what is kept is known
SELECT r.drive_id, r.ego_id, r.t_ns, r.ref_id,
    CASE WHEN r.turn IS NULL THEN NULL
        WHEN r.braked AND b.actor_class IN ('bicycle', 'animal') THEN false
        WHEN r.actor_class IN ('bicycle', 'animal') OR (r.pet_s >= $pet_s AND r.decel_mps2 <= $decel_mps2)
        THEN r.pet_s >= $pet_s AND r.decel_mps2 <= $decel_mps2 AND CASE WHEN NOT r.braked THEN true END END AS holds,
    CASE WHEN r.turn IS NULL THEN 'the log does not show which way the ego turned'
        WHEN r.braked IS DISTINCT FROM false THEN braked_words(r.braked_id, r.braked_pet_s, r.braked_mps2, r.braked_cause)
        ELSE coalesce(met_words(r.object_id, r.pet_s, r.decel_mps2), r.reason) END AS reason
FROM reference r
LEFT JOIN road_user b ON b.drive_id = r.drive_id AND b.actor_id = r.braked_id
