-- title = "Safe gap when turning across the oncoming traffic"
-- breach = "Turned across the oncoming traffic in too small a gap"
-- clause = "UKHC R180: before turning right wait for a safe gap between you and any oncoming vehicle"
-- hypothesis = "When the ego turned across the oncoming traffic before somebody, did it leave enough time, also at the speed that the other had before it braked?"
-- kind = "execution"
-- derivation = "model"
-- severity = "critical"
-- legal = "should"
-- status = "stable"
-- sense = ">="
-- unit = "s"
-- observes = "time until the oncoming vehicle came, or would have come had it not had to brake"
-- near_margin = 1.0
-- reads = ["junction_passage", "passage_conflict"]
-- requires = ["map", "registration", "ego_size"]
-- without_time = "the log does not show the ego on its way into the junction: begin recording before it"
--
-- [params.pet_s]
-- default = 2.0
-- unit = "s"
-- why = "our default: the two seconds that are also demanded when following"
--
-- [params.decel_mps2]
-- default = 2.0
-- unit = "m/s2"
-- why = "our default: a vehicle that brakes harder than this was forced to brake"

-- @reference
SELECT p.drive_id, p.ego_id, p.t_in_ns AS t_ns, p.occurrence, p.turn, p.across,
    made_to_brake(c.braked_mps2, c.braked_pet_s, c.braked_cause, $decel_mps2, $pet_s) AS forced,
    CASE WHEN forced THEN c.braked_id ELSE c.object_id END AS object_id,
    CASE WHEN forced IS DISTINCT FROM false THEN braked_reason(c.braked_id, c.braked_pet_s, c.braked_mps2, c.braked_cause) ELSE coalesce(c.reason, class_doubt(c.object_id)) END AS reason,
    pet_forced(pet_known(c.pet_s, c.reason, $pet_s, is_vehicle(c.actor_class)), forced, c.braked_pet_s, $pet_s) AS pet_s
FROM junction_passage p
LEFT JOIN passage_conflict c ON c.drive_id = p.drive_id AND c.ego_id = p.ego_id AND c.occurrence = p.occurrence AND c.relation = 'oncoming'
WHERE p.across IS DISTINCT FROM false

-- @condition
SELECT drive_id, ego_id, t_ns, ref_id, CASE WHEN across THEN pet_s END AS observed, $pet_s AS required,
    CASE WHEN across IS NULL THEN across_doubt(turn)
        WHEN pet_s IS NULL OR forced THEN reason END AS reason
FROM reference
